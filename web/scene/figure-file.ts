/** The figure's mesh file: left halves of the rest-pose surface with skin weights, in levels of detail. Written by bake/bake.ts. */
import { MIRRORED_BONES } from './skin-bones';

/** Parts of the figure, in the order of their numbers in the file. */
export const PARTS = ['body', 'head', 'visor', 'glove', 'shoe'] as const;
export type PartName = (typeof PARTS)[number];

/** Parts that the mirror plane cuts: their vertices at x = 0 belong to both halves. */
export const MIDDLE_PARTS: readonly PartName[] = ['body', 'head', 'visor'];

/** The left half, one entry per vertex unless said otherwise. */
export interface HalfFigure {
  /** n x 3, metres, rest pose. */
  positions: Float32Array;
  /** n x 3, unit. */
  normals: Float32Array;
  /** n x 4 skin bones and their weights (each row adds up to 1). */
  bones: Uint8Array;
  weights: Float32Array;
  /** Light that reaches the vertex past its surroundings, 0..1. */
  openness: Float32Array;
  /** Number of the part. */
  parts: Uint8Array;
  /** m x 3 vertex numbers. */
  triangles: Uint32Array;
}

/** The whole figure: arrays as in {@link HalfFigure}. */
export type WholeFigure = HalfFigure;

const MAGIC = 0x47464250; // "PBFG"
const RANGE = 2; // metres that the 16-bit positions span, from -RANGE / 2 in x and z and from 0 in y upwards

/** Several levels of detail, finest first, as bytes (not yet deflated): each with its length before it. */
export function encodeLevels(levels: HalfFigure[]): Uint8Array<ArrayBuffer> {
  const encoded = levels.map(encodeFigure);
  const out = new Uint8Array(encoded.reduce((sum, { length }) => sum + 4 + length, 0));
  let at = 0;
  for (const level of encoded) {
    new DataView(out.buffer).setUint32(at, level.length, true);
    out.set(level, at + 4);
    at += 4 + level.length;
  }
  return out;
}

/**
 * Reads what {@link encodeLevels} wrote.
 * @throws Error when the bytes are something else
 */
export function decodeLevels(bytes: Uint8Array): HalfFigure[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const levels: HalfFigure[] = [];
  for (let at = 0; at < bytes.length;) {
    const length = bytes.length >= at + 4 ? view.getUint32(at, true) : NaN;
    levels.push(decodeFigure(bytes.subarray(at + 4, at + 4 + length)));
    at += 4 + length;
  }
  return levels;
}

/** One half figure as bytes. */
export function encodeFigure(half: HalfFigure): Uint8Array<ArrayBuffer> {
  const n = half.parts.length;
  const m = half.triangles.length;
  const out: number[] = [];
  const u16 = (value: number) => out.push(value & 255, (value >> 8) & 255);
  const u32 = (value: number) => (u16(value & 65535), u16(value >>> 16));
  u32(MAGIC);
  u32(n);
  u32(m);
  // Planes of differences between neighbours deflate to about half of what interleaved values do.
  for (let axis = 0; axis < 3; axis++) {
    let last = 0;
    for (let v = 0; v < n; v++) {
      const value = Math.round(((half.positions[v * 3 + axis] + (axis === 1 ? 0 : RANGE / 2)) / RANGE) * 65535);
      u16(zigzag(wrap(value - last)));
      last = value;
    }
  }
  for (let axis = 0; axis < 2; axis++) {
    let last = 0;
    for (let v = 0; v < n; v++) {
      const value = Math.round((octahedral(half.normals, v)[axis] + 1) * 2047);
      u16(zigzag(wrap(value - last)));
      last = value;
    }
  }
  for (let v = 0; v < n; v++) out.push(Math.round(half.openness[v] * 255));
  for (let v = 0; v < n; v++) out.push(half.parts[v]);
  for (let slot = 0; slot < 4; slot++) for (let v = 0; v < n; v++) out.push(half.bones[v * 4 + slot]);
  for (let slot = 0; slot < 4; slot++)
    for (let v = 0; v < n; v++) out.push(Math.round(half.weights[v * 4 + slot] * 255));
  let last = 0;
  for (let i = 0; i < m; i++) {
    u32(zigzag(half.triangles[i] - last));
    last = half.triangles[i];
  }
  return new Uint8Array(out);
}

/**
 * Reads what {@link encodeFigure} wrote.
 * @throws Error when the bytes are something else
 */
export function decodeFigure(bytes: Uint8Array): HalfFigure {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 12 || view.getUint32(0, true) !== MAGIC) throw new Error('This is not a figure file.');
  const n = view.getUint32(4, true);
  const m = view.getUint32(8, true);
  if (bytes.length !== 12 + n * 20 + m * 4) throw new Error('The figure file is cut off.');
  let at = 12;
  const half: HalfFigure = {
    positions: new Float32Array(n * 3),
    normals: new Float32Array(n * 3),
    bones: new Uint8Array(n * 4),
    weights: new Float32Array(n * 4),
    openness: new Float32Array(n),
    parts: new Uint8Array(n),
    triangles: new Uint32Array(m),
  };
  const plane = (write: (v: number, value: number) => void) => {
    let value = 0;
    for (let v = 0; v < n; v++, at += 2) write(v, (value = (value + unzigzag(view.getUint16(at, true))) & 65535));
  };
  for (let axis = 0; axis < 3; axis++)
    plane((v, value) => (half.positions[v * 3 + axis] = (value / 65535) * RANGE - (axis === 1 ? 0 : RANGE / 2)));
  plane((v, value) => (half.normals[v * 3] = value / 2047 - 1));
  plane((v, value) => (half.normals[v * 3 + 1] = value / 2047 - 1));
  for (let v = 0; v < n; v++) fromOctahedral(half.normals, v);
  for (let v = 0; v < n; v++) half.openness[v] = bytes[at++] / 255;
  half.parts.set(bytes.subarray(at, (at += n)));
  for (let slot = 0; slot < 4; slot++) for (let v = 0; v < n; v++) half.bones[v * 4 + slot] = bytes[at++];
  for (let slot = 0; slot < 4; slot++) for (let v = 0; v < n; v++) half.weights[v * 4 + slot] = bytes[at++];
  for (let v = 0; v < n; v++) {
    const row = v * 4;
    const { weights } = half;
    const sum = weights[row] + weights[row + 1] + weights[row + 2] + weights[row + 3];
    for (let slot = 0; slot < 4; slot++) weights[row + slot] /= sum;
  }
  let index = 0;
  for (let i = 0; i < m; i++, at += 4) half.triangles[i] = index += unzigzag(view.getUint32(at, true));
  return half;
}

/** Adds the mirror image of the half figure; the vertices of the mirror plane are shared. */
export function mirrorFigure(half: HalfFigure): WholeFigure {
  const n = half.parts.length;
  const middle = (v: number) => MIDDLE_PARTS.includes(PARTS[half.parts[v]]) && half.positions[v * 3] < 1e-4;
  const imageOf = new Uint32Array(n);
  const sources: number[] = [];
  for (let v = 0; v < n; v++) {
    imageOf[v] = middle(v) ? v : n + sources.length;
    if (!middle(v)) sources.push(v);
  }
  const total = n + sources.length;
  const extend = <T extends Float32Array | Uint8Array>(
    from: T,
    width: number,
    copy: (to: T, at: number, v: number) => void,
  ) => {
    const to = new (from.constructor as new (length: number) => T)(total * width);
    to.set(from);
    sources.forEach((v, i) => copy(to, (n + i) * width, v));
    return to;
  };
  const vector = (from: Float32Array) =>
    extend(from, 3, (to, at, v) => {
      to[at] = -from[v * 3];
      to[at + 1] = from[v * 3 + 1];
      to[at + 2] = from[v * 3 + 2];
    });
  const row = <T extends Float32Array | Uint8Array>(from: T, width: number, change = (value: number) => value) =>
    extend(from, width, (to, at, v) => {
      for (let i = 0; i < width; i++) to[at + i] = change(from[v * width + i]);
    });
  const triangles = new Uint32Array(half.triangles.length * 2);
  triangles.set(half.triangles);
  for (let t = 0; t < half.triangles.length; t += 3)
    for (let corner = 0; corner < 3; corner++)
      // A mirror image turns round the other way.
      triangles[half.triangles.length + t + corner] = imageOf[half.triangles[t + 2 - corner]];
  return {
    positions: vector(half.positions),
    normals: vector(half.normals),
    bones: row(half.bones, 4, (bone) => MIRRORED_BONES[bone]),
    weights: row(half.weights, 4),
    openness: row(half.openness, 1),
    parts: row(half.parts, 1),
    triangles,
  };
}

/** Differences are taken modulo 2^16, so that a jump across the whole range still fits. */
const wrap = (value: number) => (value << 16) >> 16;
const zigzag = (value: number) => (value << 1) ^ (value >> 31);
const unzigzag = (value: number) => (value >>> 1) ^ -(value & 1);

/** Octahedral map of a unit vector to [-1, 1] x [-1, 1] (Meyer et al. 2010). */
function octahedral(normals: Float32Array, v: number): [number, number] {
  const [x, y, z] = normals.subarray(v * 3, v * 3 + 3);
  const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
  const [a, b] = [x / sum, y / sum];
  if (z >= 0) return [a, b];
  return [(1 - Math.abs(b)) * (a < 0 ? -1 : 1), (1 - Math.abs(a)) * (b < 0 ? -1 : 1)];
}

function fromOctahedral(normals: Float32Array, v: number): void {
  const at = v * 3;
  let x = normals[at];
  let y = normals[at + 1];
  const z = 1 - Math.abs(x) - Math.abs(y);
  if (z < 0) {
    const folded = (1 - Math.abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - Math.abs(x)) * (y < 0 ? -1 : 1);
    x = folded;
  }
  const length = Math.sqrt(x * x + y * y + z * z);
  normals[at] = x / length;
  normals[at + 1] = y / length;
  normals[at + 2] = z / length;
}
