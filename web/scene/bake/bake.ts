/** Writes ../figure.bin, the figure's mesh: `npx tsx web/scene/bake/bake.ts`. Run it after changing the body, the weights or the skeleton. */
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { encodeLevels, PARTS, type HalfFigure } from '../figure-file';
import { figureParts } from './body';
import type { Shape } from './sdf';
import { surface } from './surface';
import { weightsAt } from './weights';

/** Share of the near surroundings (up to 8 cm) along the normal that is free: dark creases, bright outsides. */
function opennessAt(shapes: Shape[], p: number[], n: number[]): number {
  let blocked = 0;
  for (let step = 1; step <= 5; step++) {
    const distance = 0.016 * step;
    const [x, y, z] = [0, 1, 2].map((i) => p[i] + distance * n[i]);
    const free = Math.min(...shapes.map((shape) => shape(x, y, z)));
    blocked += Math.max(0, distance - free) / distance / 2 ** (step - 1);
  }
  return Math.min(Math.max(1 - 0.6 * blocked, 0), 1);
}

const parts = figureParts();
// Gloves and shoes enclose the limbs' ends, so only the outer shapes cast.
const surroundings = parts.flatMap(({ shape, symmetric }): Shape[] =>
  symmetric ? [shape] : [shape, (x, y, z) => shape(-x, y, z)],
);

/** The half figure at one level of detail. */
function figureAt(level: number): HalfFigure {
  const positions: number[] = [];
  const normals: number[] = [];
  const openness: number[] = [];
  const bones: number[] = [];
  const weights: number[] = [];
  const partOf: number[] = [];
  const triangles: number[] = [];
  for (const part of parts) {
    const mesh = surface(part.shape, part.low, part.high, part.cells[level], part.symmetric);
    const offset = partOf.length;
    for (let v = 0; v < mesh.positions.length; v += 3) {
      const p = mesh.positions.slice(v, v + 3);
      const n = mesh.normals.slice(v, v + 3);
      positions.push(...p);
      normals.push(...n);
      openness.push(opennessAt(surroundings, p, n));
      partOf.push(PARTS.indexOf(part.name));
      const row = weightsAt(part.name, p[0], p[1], p[2]);
      for (let slot = 0; slot < 4; slot++) {
        bones.push(row[slot]?.[0] ?? 0);
        weights.push(row[slot]?.[1] ?? 0);
      }
    }
    for (const index of mesh.triangles) triangles.push(index + offset);
    console.log(
      `level ${level}, ${part.name}: ${mesh.positions.length / 3} vertices, ${mesh.triangles.length / 3} triangles`,
    );
  }
  if (positions.some(Number.isNaN)) throw new Error('The surface has vertices that are not numbers.');
  return {
    positions: new Float32Array(positions),
    normals: new Float32Array(normals),
    bones: new Uint8Array(bones),
    weights: new Float32Array(weights),
    openness: new Float32Array(openness),
    parts: new Uint8Array(partOf),
    triangles: new Uint32Array(triangles),
  };
}

const raw = encodeLevels(parts[0].cells.map((_, level) => figureAt(level)));
const packed = gzipSync(raw, { level: 9 });
writeFileSync(fileURLToPath(new URL('../figure.bin', import.meta.url)), packed);
console.log(`figure.bin: ${packed.length} bytes (${raw.length} unpacked)`);
