/** From a signed distance shape to a triangle mesh: naive surface nets (Gibson 1998) on a grid, then relaxed and put on the surface. */
import type { Shape, Vector } from './sdf';

/** One half of a mirror-symmetric mesh (x >= 0); vertices at x = 0 are shared by both halves. */
export interface Mesh {
  /** n x 3, metres. */
  positions: number[];
  /** n x 3, unit. */
  normals: number[];
  /** m x 3 vertex numbers, counter-clockwise from outside. */
  triangles: number[];
}

/** Gradient of the shape by central differences, unit length. */
function normalAt(shape: Shape, x: number, y: number, z: number): Vector {
  const e = 4e-4;
  const g = [
    shape(x + e, y, z) - shape(x - e, y, z),
    shape(x, y + e, z) - shape(x, y - e, z),
    shape(x, y, z + e) - shape(x, y, z - e),
  ];
  const length = Math.hypot(g[0], g[1], g[2]) || 1;
  return [g[0] / length, g[1] / length, g[2] / length];
}

/**
 * Mesh of the shape's surface.
 * @param low, high box around it, metres; with `symmetric` the box starts at the mirror plane whatever low[0] says
 * @param cell size of a grid cell, metres
 */
export function surface(shape: Shape, low: Vector, high: Vector, cell: number, symmetric: boolean): Mesh {
  // The mirror plane runs through the middle of the first column of cells, whose vertices are then set to x = 0.
  const origin = [symmetric ? -cell / 2 : low[0], low[1], low[2]];
  const size = [0, 1, 2].map((i) => Math.ceil((high[i] - origin[i]) / cell) + 1);
  const values = new Float32Array(size[0] * size[1] * size[2]);
  const node = (i: number, j: number, k: number) => (i * size[1] + j) * size[2] + k;
  for (let i = 0; i < size[0]; i++)
    for (let j = 0; j < size[1]; j++)
      for (let k = 0; k < size[2]; k++)
        values[node(i, j, k)] = shape(origin[0] + i * cell, origin[1] + j * cell, origin[2] + k * cell);

  const vertexOf = new Int32Array(values.length).fill(-1);
  const positions: number[] = [];
  for (let i = 0; i < size[0] - 1; i++)
    for (let j = 0; j < size[1] - 1; j++)
      for (let k = 0; k < size[2] - 1; k++) {
        const centre = crossing(values, node, i, j, k);
        if (!centre) continue;
        vertexOf[node(i, j, k)] = positions.length / 3;
        const x = symmetric && i === 0 ? 0 : origin[0] + centre[0] * cell;
        positions.push(x, origin[1] + centre[1] * cell, origin[2] + centre[2] * cell);
      }

  const triangles: number[] = [];
  const quad = (a: number, b: number, c: number, d: number, flip: boolean) => {
    if (Math.min(a, b, c, d) < 0) return;
    const corners = flip ? [a, d, c, b] : [a, b, c, d];
    const span = (p: number, q: number) =>
      [0, 1, 2].reduce((sum, i) => sum + (positions[corners[p] * 3 + i] - positions[corners[q] * 3 + i]) ** 2, 0);
    const order = span(0, 2) < span(1, 3) ? [0, 1, 2, 0, 2, 3] : [1, 2, 3, 1, 3, 0];
    for (const corner of order) triangles.push(corners[corner]);
  };
  for (let i = 1; i < size[0] - 1; i++)
    for (let j = 1; j < size[1] - 1; j++)
      for (let k = 1; k < size[2] - 1; k++) {
        const inside = values[node(i, j, k)] < 0;
        const cellAt = (di: number, dj: number, dk: number) => vertexOf[node(i - di, j - dj, k - dk)];
        if (inside !== values[node(i + 1, j, k)] < 0)
          quad(cellAt(0, 1, 1), cellAt(0, 0, 1), cellAt(0, 0, 0), cellAt(0, 1, 0), !inside);
        if (inside !== values[node(i, j + 1, k)] < 0)
          quad(cellAt(1, 0, 1), cellAt(1, 0, 0), cellAt(0, 0, 0), cellAt(0, 0, 1), !inside);
        if (inside !== values[node(i, j, k + 1)] < 0)
          quad(cellAt(1, 1, 0), cellAt(0, 1, 0), cellAt(0, 0, 0), cellAt(1, 0, 0), !inside);
      }
  dropUnused(positions, triangles);
  relax(shape, positions, triangles, symmetric ? 1e-9 : -Infinity, cell);
  const normals: number[] = [];
  for (let v = 0; v < positions.length; v += 3)
    normals.push(...normalAt(shape, positions[v], positions[v + 1], positions[v + 2]));
  return { positions, normals, triangles };
}

/** Removes vertices that no triangle uses (the surface grazed a cell without passing between its corners' columns). */
function dropUnused(positions: number[], triangles: number[]): void {
  const renumbered = new Map<number, number>();
  for (const v of [...new Set(triangles)].sort((a, b) => a - b)) renumbered.set(v, renumbered.size);
  for (const [from, to] of renumbered) for (let i = 0; i < 3; i++) positions[to * 3 + i] = positions[from * 3 + i];
  positions.length = renumbered.size * 3;
  triangles.forEach((v, i) => (triangles[i] = renumbered.get(v)!));
}

/** Mean of the points where the surface cuts the edges of a cell, in grid units; undefined when it does not pass. */
function crossing(
  values: Float32Array,
  node: (i: number, j: number, k: number) => number,
  i: number,
  j: number,
  k: number,
): Vector | undefined {
  const sum = [0, 0, 0];
  let count = 0;
  for (let corner = 0; corner < 8; corner++)
    for (let axis = 0; axis < 3; axis++) {
      if (corner & (1 << axis)) continue;
      const a = [i + (corner & 1), j + ((corner >> 1) & 1), k + ((corner >> 2) & 1)];
      const b = [...a];
      b[axis]++;
      const [va, vb] = [values[node(a[0], a[1], a[2])], values[node(b[0], b[1], b[2])]];
      if (va < 0 === vb < 0) continue;
      const t = va / (va - vb);
      for (let d = 0; d < 3; d++) sum[d] += a[d] + t * (b[d] - a[d]);
      count++;
    }
  return count ? [sum[0] / count, sum[1] / count, sum[2] / count] : undefined;
}

/** Evens the triangles out along the surface and puts each vertex exactly on it. */
function relax(shape: Shape, positions: number[], triangles: number[], pinnedBelow: number, cell: number): void {
  const n = positions.length / 3;
  const neighbours = Array.from({ length: n }, () => new Set<number>());
  for (let t = 0; t < triangles.length; t += 3)
    for (let e = 0; e < 3; e++) {
      neighbours[triangles[t + e]].add(triangles[t + ((e + 1) % 3)]);
      neighbours[triangles[t + ((e + 1) % 3)]].add(triangles[t + e]);
    }
  for (let round = 0; round < 6; round++) {
    const before = positions.slice();
    for (let v = 0; v < n; v++) {
      const p = before.slice(v * 3, v * 3 + 3);
      const pinned = p[0] < pinnedBelow;
      const mean = [0, 0, 0];
      let count = 0;
      for (const other of neighbours[v]) {
        for (let i = 0; i < 3; i++) mean[i] += before[other * 3 + i];
        count++;
      }
      if (count) for (let i = 0; i < 3; i++) p[i] += 0.6 * (mean[i] / count - p[i]);
      for (let step = 0; step < 3; step++) {
        const g = normalAt(shape, p[0], p[1], p[2]);
        const d = Math.min(Math.max(shape(p[0], p[1], p[2]), -cell), cell);
        for (let i = 0; i < 3; i++) p[i] -= d * g[i];
      }
      if (pinned) p[0] = 0;
      for (let i = 0; i < 3; i++) positions[v * 3 + i] = p[i];
    }
  }
}
