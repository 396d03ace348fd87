/**
 * Whether a pose could stand: where the body's weight is and what carries it.
 * Segment masses and their centres: de Leva (1996), "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters",
 * J Biomech 29:1223, table 4, mean of women and men.
 */
import type { Numbers } from './rotation';
import { JOINT_COUNT, jointIndex, OFFSETS, PARENTS } from './skeleton';
import { spec } from './spec';

interface Segment {
  from: number;
  to: number;
  /** Share of the body's mass. */
  mass: number;
  /** Where its centre is on the way from one joint to the other; beyond 1 for the head, which ends above its joint. */
  centre: number;
}

const between = (from: string, to: string, mass: number, centre: number): Segment => ({
  from: jointIndex(from),
  to: jointIndex(to),
  mass,
  centre,
});

const SEGMENTS: readonly Segment[] = [
  between('neck', 'head', 0.0681, 1.5),
  between('spine3', 'neck', 0.157, 0.4),
  between('spine1', 'spine3', 0.1549, 0.45),
  between('pelvis', 'spine1', 0.1182, 0.2),
  ...(['left', 'right'] as const).flatMap((side) => [
    between(`${side}_shoulder`, `${side}_elbow`, 0.0263, 0.576),
    between(`${side}_elbow`, `${side}_wrist`, 0.015, 0.457),
    between(`${side}_wrist`, `${side}_hand`, 0.0059, 0.77),
    between(`${side}_hip`, `${side}_knee`, 0.1447, 0.385),
    between(`${side}_knee`, `${side}_ankle`, 0.0457, 0.444),
    between(`${side}_ankle`, `${side}_foot`, 0.0133, 0.45),
  ]),
];
const MASS = SEGMENTS.reduce((sum, { mass }) => sum + mass, 0);

/**
 * Centre of mass of a pose.
 * @param joints 24 x 3 world positions, metres
 * @returns x, y, z in metres
 */
export function centreOfMass(joints: Numbers): [number, number, number] {
  const centre: [number, number, number] = [0, 0, 0];
  for (const { from, to, mass, centre: along } of SEGMENTS) {
    for (let i = 0; i < 3; i++) {
      const [a, b] = [joints[from * 3 + i], joints[to * 3 + i]];
      centre[i] += ((a + (b - a) * along) * mass) / MASS;
    }
  }
  return centre;
}

/** Height of each joint of the standing rest pose over the floor, metres. */
const STANDING = (() => {
  const heights: number[] = [];
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    heights.push((PARENTS[joint] < 0 ? 0 : heights[PARENTS[joint]]) + OFFSETS[joint][1]);
  }
  const floor = Math.min(...heights) - spec.skeleton.toeHeight;
  return heights.map((height) => height - floor);
})();

/** How high a joint is over what it lies on, metres: half the limb's thickness; feet as they stand. */
const THICKNESS: readonly (readonly [string, number])[] = [
  ['pelvis', 0.11],
  ['spine3', 0.13],
  ['head', 0.1],
  ...(['left', 'right'] as const).flatMap((side): [string, number][] => [
    [`${side}_ankle`, STANDING[jointIndex(`${side}_ankle`)]],
    [`${side}_foot`, STANDING[jointIndex(`${side}_foot`)]],
    [`${side}_knee`, 0.06],
    [`${side}_elbow`, 0.045],
    [`${side}_wrist`, 0.035],
    [`${side}_hand`, 0.035],
    [`${side}_shoulder`, 0.07],
  ]),
];
const SUPPORTING = THICKNESS.map(([name, height]) => ({ joint: jointIndex(name), height }));
/** Height of a joint that lies or stands on the floor, metres. */
export function restingHeight(joint: number): number {
  return SUPPORTING.find((support) => support.joint === joint)?.height ?? 0.05;
}

/** A joint this much higher still counts as on the floor, metres. */
const NEAR = 0.025;

/**
 * Joints that are on the floor (y = 0).
 * @param joints 24 x 3 world positions, metres
 */
export function contacts(joints: Numbers): number[] {
  return SUPPORTING.filter(({ joint, height }) => joints[joint * 3 + 1] < height + NEAR).map(({ joint }) => joint);
}

const FEET = [spec.skeleton.feet.left, spec.skeleton.feet.right];
/** The sole beyond ankle and ball of the foot, and to either side, metres. */
const SOLE = { heel: 0.06, toes: 0.07, half: 0.04 };

/**
 * Outline on the floor of everything that the body stands on.
 * @param joints 24 x 3 world positions, metres
 * @returns corners x, z counter-clockwise seen from below (x to the right, z up); empty in the air
 */
export function supportPolygon(joints: Numbers): [number, number][] {
  const points: [number, number][] = [];
  for (const joint of contacts(joints)) {
    const foot = FEET.find(({ ankle, toe }) => joint === ankle || joint === toe);
    const [x, z] = [joints[joint * 3], joints[joint * 3 + 2]];
    if (!foot) {
      for (const [dx, dz] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) points.push([x + dx * SOLE.half, z + dz * SOLE.half]); // prettier-ignore
      continue;
    }
    const dx = joints[foot.toe * 3] - joints[foot.ankle * 3];
    const dz = joints[foot.toe * 3 + 2] - joints[foot.ankle * 3 + 2];
    const length = Math.hypot(dx, dz) || 1;
    const [ux, uz] = [dx / length, dz / length];
    const beyond = joint === foot.toe ? SOLE.toes : -SOLE.heel;
    for (const side of [-SOLE.half, SOLE.half])
      points.push([x + ux * beyond - uz * side, z + uz * beyond + ux * side], [x - uz * side, z + ux * side]);
  }
  return convexHull(points);
}

/** Convex hull (Andrew's monotone chain, 1979). */
function convexHull(points: [number, number][]): [number, number][] {
  const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list: [number, number][]) => {
    const chain: [number, number][] = [];
    for (const p of list) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], p) <= 0) chain.pop();
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return sorted.length < 3 ? sorted : [...half(sorted), ...half(sorted.reverse())];
}

function turn(a: Numbers, b: Numbers, c: Numbers): number {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/**
 * Whether the centre of mass is over what the body stands on, so that it could stay like this.
 * @param joints 24 x 3 world positions, metres
 */
export function isBalanced(joints: Numbers): boolean {
  const [x, , z] = centreOfMass(joints);
  const outline = supportPolygon(joints);
  return (
    outline.length > 2 && outline.every((corner, i) => turn(corner, outline[(i + 1) % outline.length], [x, z]) >= 0)
  );
}
