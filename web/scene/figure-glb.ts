/** Our figure as plain arrays for a GLB file: its finest level, the colours of the stage painted on its vertices. */
import type { GlbFigure, GlbPart } from '../core/formats/glb-write';
import { jointIndex } from '../core/skeleton';
import type { FigureAsset } from './figure-asset';
import { PARTS, type PartName } from './figure-file';
import { PALETTE } from './figure-material';
import { REST } from './rest';
import { FILE_BONES, SKIN_HELPERS } from './skin-samplers';

const at = (joint: string, axis: number) => REST[jointIndex(joint) * 3 + axis];
const smoothstep = (low: number, high: number, x: number) => {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
};
type Colour = readonly [number, number, number];
const rgb = ({ r, g, b }: { r: number; g: number; b: number }): Colour => [r, g, b];
const BODY = rgb(PALETTE.body);
const LEFT = rgb(PALETTE.left);
const RIGHT = rgb(PALETTE.right);
const VISOR = rgb(PALETTE.visor);
const mix = (a: Colour, b: Colour, t: number): Colour => [
  a[0] + (b[0] - a[0]) * t,
  a[1] + (b[1] - a[1]) * t,
  a[2] + (b[2] - a[2]) * t,
];
const ARM = [at('left_shoulder', 0) - 0.03, at('left_wrist', 0) + 0.02] as const;
const LEG = [at('left_ankle', 1), at('left_hip', 1) + 0.03] as const;
const CUFF = at('left_wrist', 0) - 0.058;
const SOCK = at('left_ankle', 1) + 0.06;

/**
 * The colour of a point of the rest pose, linear RGB: the paint of `figure-material.ts`, whose edges are soft over a pixel there and lie
 * between two vertices here.
 */
export function paintAt(x: number, y: number, z: number, part: PartName): Colour {
  const side = x > 0 ? LEFT : RIGHT;
  if (part === 'visor') return VISOR;
  const reach = Math.abs(x);
  if (part === 'head' && reach > 0.0725) return side;
  const limb = Math.max(smoothstep(ARM[0], ARM[1], reach), reach > 0.4 ? 0 : 1 - smoothstep(LEG[0], LEG[1], y));
  const cuff = reach > 0.4 ? reach - CUFF : SOCK + 0.25 * (z + 0.04) - y;
  const covered = part !== 'head' && cuff > 0;
  if (part === 'shoe' && y < 0.017) return BODY;
  return covered ? mix([0, 0, 0], side, 0.88) : mix(BODY, side, 0.8 * limb);
}

/** Parts that share a material, and how rough it is. */
const MATERIALS: readonly { name: string; parts: readonly PartName[]; roughness: number }[] = [
  { name: 'body', parts: ['body', 'head'], roughness: 0.55 },
  { name: 'visor', parts: ['visor'], roughness: 0.14 },
  { name: 'gloves and shoes', parts: ['glove', 'shoe'], roughness: 0.42 },
];

/** Takes the finest level out of the figure's geometry. */
export function figureForGlb({ geometry, levels }: FigureAsset): GlbFigure {
  const [{ start, count }] = levels;
  const index = geometry.index!.array.subarray(start, start + count) as Uint16Array;
  // Plain loops over the 25,000 vertices: this runs on the main thread.
  let n = 0;
  for (let i = 0; i < count; i++) if (index[i] >= n) n = index[i] + 1;
  const values = (name: string, width: number) => geometry.getAttribute(name).array.slice(0, n * width);
  const positions = values('position', 3) as Float32Array;
  const surface = values('surface', 2) as Float32Array;
  const weights = values('skinWeight', 4) as Float32Array;
  const skin = values('skinIndex', 4) as Uint8Array;
  const colours = new Uint8Array(n * 4);
  const bones = new Uint8Array(n * 4);
  const materialOf = PARTS.map((part) => MATERIALS.findIndex(({ parts }) => parts.includes(part)));
  const material = new Uint8Array(n);
  for (let v = 0; v < n; v++) {
    const part = Math.round(surface[v * 2 + 1]);
    material[v] = materialOf[part];
    const colour = paintAt(positions[v * 3], positions[v * 3 + 1], positions[v * 3 + 2], PARTS[part]);
    for (let k = 0; k < 3; k++) colours[v * 4 + k] = Math.round(colour[k] * 255);
    colours[v * 4 + 3] = 255;
    for (let k = v * 4; k < v * 4 + 4; k++) bones[k] = weights[k] > 0 ? FILE_BONES[skin[k]] : 0;
  }
  const corners = MATERIALS.map(() => new Uint16Array(count));
  const lengths = MATERIALS.map(() => 0);
  for (let i = 0; i < count; i += 3) {
    const m = material[index[i]];
    for (let k = i; k < i + 3; k++) corners[m][lengths[m]++] = index[k];
  }
  return {
    positions,
    normals: values('normal', 3) as Float32Array,
    colours,
    bones,
    weights,
    helpers: SKIN_HELPERS,
    parts: MATERIALS.map(({ name, roughness }, i): GlbPart => {
      return { name, roughness, triangles: corners[i].slice(0, lengths[i]) };
    }),
  };
}
