/** Our figure as plain arrays for a GLB file: its finest level, the colours of the stage painted on its vertices. */
import { DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import type { GlbFigure, GlbPart } from '../core/formats/glb-write';
import { jointIndex } from '../core/skeleton';
import type { FigureAsset } from './figure-asset';
import { PARTS, type PartName } from './figure-file';
import { paletteOf } from './figure-material';
import { LACQUER, mannequin, WALNUT, WOOD } from './mannequin';
import { REST } from './rest';
import { FILE_BONES, SKIN_HELPERS } from './skin-samplers';

const at = (joint: string, axis: number) => REST[jointIndex(joint) * 3 + axis];
const smoothstep = (low: number, high: number, x: number) => {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
};
type Colour = readonly [number, number, number];
type Paint = (x: number, y: number, z: number, part: number) => Colour;
/** Parts that share a material, and how rough it is. */
type Materials = readonly { name: string; parts: readonly number[]; roughness: number }[];
const rgb = ({ r, g, b }: { r: number; g: number; b: number }): Colour => [r, g, b];
const mix = (a: Colour, b: Colour, t: number): Colour => [
  a[0] + (b[0] - a[0]) * t,
  a[1] + (b[1] - a[1]) * t,
  a[2] + (b[2] - a[2]) * t,
];
const ARM = [at('left_shoulder', 0) - 0.03, at('left_wrist', 0) + 0.02] as const;
const LEG = [at('left_ankle', 1), at('left_hip', 1) + 0.03] as const;
const CUFF = at('left_wrist', 0) - 0.058;
const SOCK = at('left_ankle', 1) + 0.06;
const BEECH: Colour = [0.76, 0.5, 0.275];
const NUT: Colour = [0.2, 0.105, 0.05];
const NIGHT: Colour = [0.01, 0.013, 0.022];
const numbersOf = (...names: PartName[]) => names.map((name) => PARTS.indexOf(name));

const BODY_PARTS: Materials = [
  { name: 'body', parts: numbersOf('body', 'head'), roughness: 0.55 },
  { name: 'visor', parts: numbersOf('visor'), roughness: 0.14 },
  { name: 'gloves and shoes', parts: numbersOf('glove', 'shoe'), roughness: 0.42 },
];
const MATERIALS: Readonly<Record<FigureLook['style'], Materials>> = {
  studio: BODY_PARTS,
  neon: BODY_PARTS,
  clay: BODY_PARTS.map((material) => ({ ...material, roughness: 0.92 })),
  mannequin: [
    { name: 'beech', parts: [WOOD], roughness: 0.5 },
    { name: 'lacquer', parts: [LACQUER], roughness: 0.3 },
    { name: 'walnut', parts: [WALNUT], roughness: 0.3 },
  ],
};

/**
 * The colour of a point of the rest pose, linear RGB: the paint of `figure-paint.ts`, whose edges are soft over a pixel there and lie
 * between two vertices here. What only light can do (neon's rim, grain, dents) is left out.
 */
function paintOf(look: Readonly<FigureLook>): Paint {
  const palette = paletteOf(look);
  const [body, left, right, visor] = [palette.body, palette.left, palette.right, palette.visor].map(rgb);
  const sideOf = (x: number) => (x > 0 ? left : right);
  if (look.style === 'mannequin')
    return (x, _y, _z, part) => (part === WOOD ? BEECH : part === WALNUT ? NUT : sideOf(x));
  if (look.style === 'clay') {
    const warm: Colour = [body[0], body[1] * 0.95, body[2] * 0.88];
    return (x, y, z) => {
      const reach = Math.abs(x);
      if (y > at('neck', 1) + 0.03 && reach < 0.13) {
        const [dx, dy] = [reach - 0.031, (y - at('head', 1) - 0.094) * 0.72];
        return z > 0.02 && Math.hypot(dx, dy) < 0.0092 ? visor : warm;
      }
      const arm = reach > at('left_shoulder', 0) - 0.005 && y > at('spine2', 1);
      return arm || y < at('left_hip', 1) + 0.045 + 0.35 * (reach - 0.08) ? sideOf(x) : warm;
    };
  }
  const base = look.style === 'neon' ? NIGHT : body;
  return (x, y, z, part) => {
    const side = sideOf(x);
    const name = PARTS[part];
    if (name === 'visor') return look.style === 'neon' ? body : visor;
    const reach = Math.abs(x);
    if (name === 'head' && reach > 0.0725) return side;
    const limb = Math.max(smoothstep(ARM[0], ARM[1], reach), reach > 0.4 ? 0 : 1 - smoothstep(LEG[0], LEG[1], y));
    const cuff = reach > 0.4 ? reach - CUFF : SOCK + 0.25 * (z + 0.04) - y;
    const covered = name !== 'head' && cuff > 0;
    if (name === 'shoe' && y < 0.017) return base;
    if (covered) return mix([0, 0, 0], side, 0.88);
    return mix(base, side, (look.style === 'neon' ? 0.25 : 0.8) * limb);
  };
}

/** Takes the finest level out of the figure's geometry, or the mannequin's, and paints it. */
export function figureForGlb(body: FigureAsset, look: Readonly<FigureLook> = DEFAULT_LOOK): GlbFigure {
  const { geometry, levels } = look.style === 'mannequin' ? mannequin() : body;
  const materials = MATERIALS[look.style];
  const paint = paintOf(look);
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
  const materialOf = PARTS.map((_, part) => materials.findIndex(({ parts }) => parts.includes(part)));
  const material = new Uint8Array(n);
  for (let v = 0; v < n; v++) {
    const part = Math.round(surface[v * 2 + 1]);
    material[v] = materialOf[part];
    const colour = paint(positions[v * 3], positions[v * 3 + 1], positions[v * 3 + 2], part);
    for (let k = 0; k < 3; k++) colours[v * 4 + k] = Math.round(colour[k] * 255);
    colours[v * 4 + 3] = 255;
    for (let k = v * 4; k < v * 4 + 4; k++) bones[k] = weights[k] > 0 ? FILE_BONES[skin[k]] : 0;
  }
  const corners = materials.map(() => new Uint16Array(count));
  const lengths = materials.map(() => 0);
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
    parts: materials.map(({ name, roughness }, i): GlbPart => {
      return { name, roughness, triangles: corners[i].slice(0, lengths[i]) };
    }),
  };
}
