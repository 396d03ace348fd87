/** The style `mannequin`: an artist's jointed figure of turned wood, made here from the rest pose; every piece is stiff and has one bone. */
import { BufferAttribute, BufferGeometry } from 'three';
import { jointIndex } from '../core/skeleton';
import type { FigureAsset } from './figure-asset';
import { REST } from './rest';
import { MIRRORED_BONES, skinBone } from './skin-bones';

/** What a piece is painted as: the numbers in the `surface` attribute. */
export const WOOD = 0;
export const LACQUER = 1;
export const WALNUT = 2;

type Vector = readonly [number, number, number];

/** A piece as it comes off the lathe. */
interface Piece {
  bone: number;
  from: Vector;
  to: Vector;
  /** Radii at even distances from end to end, metres. */
  radii: readonly number[];
  /** Share of the radius across: sideways (limbs that lie: up) and to the front. */
  flat: readonly [number, number];
  /** Share of the length over which an end is rounded off. */
  round: number;
  part: number;
}

const at = (joint: string, dx = 0, dy = 0, dz = 0): Vector => {
  const i = jointIndex(joint) * 3;
  return [REST[i] + dx, REST[i + 1] + dy, REST[i + 2] + dz];
};
const between = (a: Vector, b: Vector, t: number): Vector => [
  a[0] + (b[0] - a[0]) * t,
  a[1] + (b[1] - a[1]) * t,
  a[2] + (b[2] - a[2]) * t,
];

function turned(bone: string, from: Vector, to: Vector, radii: readonly number[], rest: Partial<Piece> = {}): Piece {
  return { bone: skinBone(bone), from, to, radii, flat: [1, 1], round: 0.16, part: WOOD, ...rest };
}

function ball(bone: string, [x, y, z]: Vector, radius: number, part: number): Piece {
  const piece = turned(bone, [x, y - radius, z], [x, y + radius, z], [radius]);
  return { ...piece, round: 1, part };
}

/** A limb between two balls, which show a little at both ends. */
function limb(bone: string, a: Vector, b: Vector, [first, last]: readonly [number, number], radii: readonly number[]) {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  return turned(bone, between(a, b, first / length), between(a, b, 1 - last / length), radii);
}

const MIDDLE: readonly Piece[] = [
  turned('pelvis', at('pelvis', 0, -0.135), at('pelvis', 0, 0.075, -0.015), [0.088, 0.148, 0.155, 0.13, 0.085], {
    flat: [1, 0.7],
    round: 0.3,
  }),
  ball('spine1', at('spine1', 0, 0.0, 0.01), 0.078, WALNUT),
  turned('spine2', at('spine1', 0, 0.03, 0.012), at('spine2', 0, 0.035), [0.075, 0.108, 0.112, 0.09], {
    flat: [1, 0.74],
    round: 0.34,
  }),
  turned('spine3', at('spine2', 0, 0.02), at('neck', 0, -0.005, 0.012), [0.085, 0.125, 0.155, 0.165, 0.15, 0.075], {
    flat: [1, 0.64],
    round: 0.2,
  }),
  turned('neck', at('neck', 0, -0.03, 0.005), at('head', 0, 0.03, -0.005), [0.052, 0.044, 0.042, 0.046], {
    part: WALNUT,
  }),
  turned('head', at('head', 0, -0.005, 0.022), at('head', 0, 0.232, 0.008), [0.05, 0.076, 0.092, 0.095, 0.08], {
    flat: [0.86, 1],
    round: 0.42,
  }),
  turned('head', at('head', 0, 0.062, 0.1), at('head', 0, 0.112, 0.098), [0.015, 0.011], {
    flat: [0.7, 1.1],
    round: 0.5,
  }),
];

const shoulder = at('left_shoulder', -0.012, -0.005, 0.012);
const elbow = at('left_elbow');
const wrist = at('left_wrist');
const hand = at('left_hand', 0.005, 0.002);
const hip = at('left_hip', 0.022, -0.012);
const knee = at('left_knee');
const ankle = at('left_ankle', 0, 0.012);
const foot = at('left_foot');

const LEFT: readonly Piece[] = [
  ball('left_shoulder1', shoulder, 0.058, LACQUER),
  limb('left_upper2', shoulder, elbow, [0.04, 0.026], [0.036, 0.05, 0.047, 0.041, 0.036, 0.03]),
  ball('left_elbow1', elbow, 0.034, LACQUER),
  limb('left_lower2', elbow, wrist, [0.026, 0.018], [0.031, 0.041, 0.039, 0.034, 0.028, 0.023]),
  ball('left_wrist', wrist, 0.024, LACQUER),
  turned('left_palm', at('left_wrist', 0.014), at('left_hand', 0.022, 0.002), [0.024, 0.04, 0.045, 0.042], {
    flat: [0.42, 1],
    round: 0.24,
  }),
  turned(
    'left_palm',
    at('left_wrist', 0.032, -0.004, 0.022),
    at('left_hand', 0.0, -0.006, 0.066),
    [0.014, 0.0145, 0.011],
    {
      round: 0.3,
    },
  ),
  turned('left_fingers', hand, at('left_hand', 0.098, -0.012), [0.041, 0.04, 0.034, 0.022], {
    flat: [0.34, 1],
    round: 0.3,
    part: LACQUER,
  }),
  ball('left_hip1', hip, 0.078, LACQUER),
  limb('left_thigh1', hip, knee, [0.042, 0.03], [0.062, 0.08, 0.075, 0.066, 0.056, 0.046]),
  ball('left_knee1', knee, 0.05, LACQUER),
  limb('left_shin1', knee, ankle, [0.034, 0.024], [0.044, 0.06, 0.057, 0.047, 0.037, 0.031]),
  ball('left_ankle', ankle, 0.035, LACQUER),
  turned(
    'left_sole',
    at('left_ankle', -0.004, -0.046, -0.05),
    [foot[0] + 0.002, 0.036, foot[2] + 0.004],
    [0.036, 0.042, 0.041, 0.041],
    {
      flat: [1, 0.82],
      round: 0.3,
    },
  ),
  turned(
    'left_toes',
    [foot[0], 0.031, foot[2] - 0.014],
    [foot[0] + 0.018, 0.022, foot[2] + 0.088],
    [0.043, 0.046, 0.036],
    {
      flat: [1, 0.56],
      round: 0.4,
      part: LACQUER,
    },
  ),
];

const mirrored = (piece: Piece): Piece => ({
  ...piece,
  bone: MIRRORED_BONES[piece.bone],
  from: [-piece.from[0], piece.from[1], piece.from[2]],
  to: [-piece.to[0], piece.to[1], piece.to[2]],
});

const PIECES: readonly Piece[] = [...MIDDLE, ...LEFT, ...LEFT.map(mirrored)];

/** Corners round a piece and rings along it, per level of detail. */
const LEVELS = [
  { sides: 22, rings: 18 },
  { sides: 14, rings: 10 },
  { sides: 10, rings: 8 },
] as const;

let made: FigureAsset | undefined;

/** The mannequin's triangles, made once; laid out as those of the baked figure. */
export function mannequin(): FigureAsset {
  return (made ??= build());
}

function build(): FigureAsset {
  const positions: number[] = [];
  const normals: number[] = [];
  const surface: number[] = [];
  const bones: number[] = [];
  const index: number[] = [];
  const levels: FigureAsset['levels'] = [];
  for (const level of LEVELS) {
    const start = index.length;
    for (const piece of PIECES) lathe(piece, level, { positions, normals, surface, bones, index });
    levels.push({ start, count: index.length - start });
  }
  const count = bones.length;
  const skinIndex = new Uint8Array(count * 4);
  const skinWeight = new Float32Array(count * 4);
  bones.forEach((bone, v) => {
    skinIndex[v * 4] = bone;
    skinWeight[v * 4] = 1;
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(positions), 3));
  geometry.setAttribute('normal', new BufferAttribute(Float32Array.from(normals), 3));
  geometry.setAttribute('skinIndex', new BufferAttribute(skinIndex, 4));
  geometry.setAttribute('skinWeight', new BufferAttribute(skinWeight, 4));
  geometry.setAttribute('surface', new BufferAttribute(Float32Array.from(surface), 2));
  geometry.setIndex(new BufferAttribute(Uint16Array.from(index), 1));
  return { geometry, levels };
}

/** The radius at a share of the length: the drawn profile, rounded off at the ends. */
function radiusAt({ radii, round }: Piece, t: number): number {
  const place = t * (radii.length - 1);
  const i = Math.min(Math.floor(place), Math.max(0, radii.length - 2));
  const u = place - i;
  // A cubic through the neighbours keeps the profile from having corners (Catmull and Rom 1974).
  const r = (k: number) => radii[Math.min(Math.max(i + k, 0), radii.length - 1)];
  const [a, b, c, d] = [r(-1), r(0), r(1), r(2)];
  const profile = b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
  const end = Math.max(0, (Math.abs(2 * t - 1) - (1 - round)) / round);
  return profile * Math.sqrt(Math.max(0, 1 - end * end));
}

interface Mesh {
  positions: number[];
  normals: number[];
  surface: number[];
  bones: number[];
  index: number[];
}

function lathe(piece: Piece, { sides, rings }: { sides: number; rings: number }, mesh: Mesh): void {
  const { from, to, flat, part, bone } = piece;
  const way: Vector = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  const length = Math.hypot(...way);
  const axis: Vector = [way[0] / length, way[1] / length, way[2] / length];
  const lies = Math.abs(axis[0]) > 0.7;
  // Sideways: up for what lies along X, else X; made square to the axis.
  const rough: Vector = lies ? [0, 1, 0] : [1, 0, 0];
  const along = rough[0] * axis[0] + rough[1] * axis[1] + rough[2] * axis[2];
  const square: Vector = [rough[0] - along * axis[0], rough[1] - along * axis[1], rough[2] - along * axis[2]];
  const size = Math.hypot(...square);
  const u: Vector = [square[0] / size, square[1] / size, square[2] / size];
  const v: Vector = [axis[1] * u[2] - axis[2] * u[1], axis[2] * u[0] - axis[0] * u[2], axis[0] * u[1] - axis[1] * u[0]];
  const first = mesh.bones.length;
  for (let ring = 0; ring <= rings; ring++) {
    // Rings lie close where an end is rounded.
    const t = 0.5 - 0.5 * Math.cos((Math.PI * ring) / rings);
    const radius = radiusAt(piece, t);
    const step = 1e-3;
    const slope =
      (radiusAt(piece, Math.min(1, t + step)) - radiusAt(piece, Math.max(0, t - step))) /
      ((Math.min(1, t + step) - Math.max(0, t - step)) * length);
    const near = Math.min(t, 1 - t) * length;
    const open = part === WOOD ? 0.5 + 0.5 * Math.min(1, near / 0.035) : 0.8;
    for (let side = 0; side <= sides; side++) {
      const angle = (2 * Math.PI * side) / sides;
      const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
      const normal = [0, 1, 2].map((k) => (u[k] * cos) / flat[0] + (v[k] * sin) / flat[1] - axis[k] * slope);
      const norm = Math.hypot(...normal) || 1;
      for (let k = 0; k < 3; k++) {
        mesh.positions.push(from[k] + way[k] * t + radius * (u[k] * cos * flat[0] + v[k] * sin * flat[1]));
        mesh.normals.push(normal[k] / norm);
      }
      mesh.surface.push(open, part);
      mesh.bones.push(bone);
    }
  }
  const row = sides + 1;
  for (let ring = 0; ring < rings; ring++)
    for (let side = 0; side < sides; side++) {
      const a = first + ring * row + side;
      if (ring > 0) mesh.index.push(a, a + 1, a + row);
      if (ring < rings - 1) mesh.index.push(a + 1, a + row + 1, a + row);
    }
}
