/**
 * What the pose editor does to a pose. A pose is 24 x 3 axis-angle, radians, SMPL joint order; joint 0 is the world orientation.
 * Every function gives a new pose; numbers of joints that it does not touch stay exactly as they were.
 */
import { aboutY, headingOf } from './localframe';
import { seededRandom, type Random } from './random';
import {
  angleBetween,
  axisAngleToQuaternion,
  conjugate,
  multiply,
  poseToQuaternions,
  quaternionToAxisAngle,
  rotateVector,
  slerp,
  type Numbers,
} from './rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, JOINTS, MIRROR, PARENTS } from './skeleton';

/** Parts of the body that are copied, mirrored and reset as one. The pelvis turns the whole figure and is in none of them. */
export type Limb = 'left_arm' | 'right_arm' | 'left_leg' | 'right_leg' | 'torso' | 'head';

/** A joint's local rotation (x y z w), brought inside what a person can do. */
export type ClampJoint = (joint: number, q: Numbers) => Numbers;

const joints = (...names: string[]): readonly number[] => names.map(jointIndex);
const arm = (side: string) =>
  joints(...['collar', 'shoulder', 'elbow', 'wrist', 'hand'].map((name) => `${side}_${name}`));
const leg = (side: string) => joints(...['hip', 'knee', 'ankle', 'foot'].map((name) => `${side}_${name}`));

/** Joints of each limb, from the body outwards. */
export const LIMBS: Readonly<Record<Limb, readonly number[]>> = {
  left_arm: arm('left'),
  right_arm: arm('right'),
  left_leg: leg('left'),
  right_leg: leg('right'),
  torso: joints('spine1', 'spine2', 'spine3'),
  head: joints('neck', 'head'),
};

/** The limb on the other side; torso and head are their own. */
export const OTHER_SIDE: Readonly<Record<Limb, Limb>> = {
  left_arm: 'right_arm',
  right_arm: 'left_arm',
  left_leg: 'right_leg',
  right_leg: 'left_leg',
  torso: 'torso',
  head: 'head',
};

/** The limb that a joint belongs to; null for the pelvis. */
export function limbOf(joint: number): Limb | null {
  for (const [limb, members] of Object.entries(LIMBS)) if (members.includes(joint)) return limb as Limb;
  return null;
}

const turnOf = (rotations: Numbers, joint: number): number[] =>
  axisAngleToQuaternion([rotations[joint * 3], rotations[joint * 3 + 1], rotations[joint * 3 + 2]]);

/** A pose with one joint's local rotation (x y z w) replaced. */
export function withTurn(rotations: Numbers, joint: number, q: Numbers): number[] {
  const next = Array.from(rotations);
  setTurn(next, joint, q);
  return next;
}

function setTurn(rotations: number[], joint: number, q: Numbers): void {
  const aa = quaternionToAxisAngle(q);
  for (let axis = 0; axis < 3; axis++) rotations[joint * 3 + axis] = aa[axis];
}

/**
 * Takes a limb from one pose into another.
 * @param onto the same limb, or the one on the other side, which gets it mirrored
 * @throws Error when `onto` is another kind of limb
 */
export function copyLimb(from: Numbers, to: Numbers, limb: Limb, onto: Limb = limb): number[] {
  if (onto !== limb && onto !== OTHER_SIDE[limb]) throw new Error(`A ${limb} does not fit onto a ${onto}.`);
  const next = Array.from(to);
  for (const joint of LIMBS[limb]) {
    if (onto === limb) for (let axis = 0; axis < 3; axis++) next[joint * 3 + axis] = from[joint * 3 + axis];
    else setMirrored(next, MIRROR[joint], from, joint);
  }
  return next;
}

/** Gives the limb on the other side what this one does, mirrored; torso and head are mirrored in place. */
export function mirrorLimb(rotations: Numbers, limb: Limb): number[] {
  const next = Array.from(rotations);
  for (const joint of LIMBS[limb]) setMirrored(next, MIRROR[joint], rotations, joint);
  return next;
}

/** Lets the joint on the other side follow an edit of `joint`, mirrored; a joint of the middle has none and is left alone. */
export function mirrorJointEdit(rotations: Numbers, joint: number): number[] {
  const next = Array.from(rotations);
  if (MIRROR[joint] !== joint) setMirrored(next, MIRROR[joint], rotations, joint);
  return next;
}

/** Mirrored in the left-right plane: turns about Y and Z are reversed. */
function setMirrored(to: number[], joint: number, from: Numbers, source: number): void {
  // 0 - x: a rest joint must not become minus zero.
  const mirrored = [from[source * 3], 0 - from[source * 3 + 1], 0 - from[source * 3 + 2]];
  for (let axis = 0; axis < 3; axis++) to[joint * 3 + axis] = mirrored[axis];
}

/** Puts joints back to rest. The pelvis keeps its heading: the figure goes on looking where it looked. */
export function resetJoints(rotations: Numbers, members: Iterable<number>): number[] {
  let next = Array.from(rotations);
  for (const joint of members) {
    if (joint === 0) next = standUpright(next);
    else next.fill(0, joint * 3, joint * 3 + 3);
  }
  return next;
}

/**
 * A pose on the way from `a` to `b`: SLERP of each joint's local rotation.
 * @param amount 0 gives `a`, 1 gives `b`, exactly; clamped to 0..1
 */
export function blendPoses(a: Numbers, b: Numbers, amount: number): number[] {
  if (!(amount > 0)) return Array.from(a);
  if (amount >= 1) return Array.from(b);
  const next = Array.from(a);
  for (let joint = 0; joint < JOINT_COUNT; joint++)
    setTurn(next, joint, slerp(turnOf(a, joint), turnOf(b, joint), amount));
  return next;
}

/** Turns the whole figure about the vertical, to its left for positive angles. */
export function turnPose(rotations: Numbers, radians: number): number[] {
  return withTurn(rotations, 0, multiply(aboutY(radians), turnOf(rotations, 0)));
}

/** Where the figure looks, radians about the vertical, 0 = +Z. */
export function headingOfPose(rotations: Numbers): number {
  return headingOf(turnOf(rotations, 0));
}

/** Takes the tilt out of the pelvis; the heading stays. */
export function standUpright(rotations: Numbers): number[] {
  return withTurn(rotations, 0, aboutY(headingOfPose(rotations)));
}

/** World rotation of one joint, x y z w. */
export function worldTurn(rotations: Numbers, joint: number): number[] {
  const turn = turnOf(rotations, joint);
  return PARENTS[joint] < 0 ? turn : multiply(worldTurn(rotations, PARENTS[joint]), turn);
}

/** A pose whose joint has the given world rotation (x y z w). */
export function withWorldTurn(rotations: Numbers, joint: number, q: Numbers): number[] {
  const parent = PARENTS[joint];
  return withTurn(rotations, joint, parent < 0 ? q : multiply(conjugate(worldTurn(rotations, parent)), q));
}

const SIDES = [
  { ankle: jointIndex('left_ankle'), toes: jointIndex('left_foot') },
  { ankle: jointIndex('right_ankle'), toes: jointIndex('right_foot') },
] as const;
/** An ankle this much above the lower one belongs to a raised foot, metres. */
const RAISED = 0.12;

/** Shortest turn that takes a unit vector to straight up. */
function toVertical([x, y, z]: readonly number[]): number[] {
  const q = [0 - z, 0, x, 1 + y];
  const length = Math.hypot(...q);
  // Upside down: every way is as short, so it goes over the side.
  return length < 1e-6 ? [0, 0, 1, 0] : q.map((value) => value / length);
}

/** Turns one ankle so that the sole is level; where the foot points stays, and the toes lie straight. */
function levelFoot(rotations: number[], { ankle, toes }: (typeof SIDES)[number], clamp: ClampJoint): number[] {
  const turn = worldTurn(rotations, ankle);
  const level = withWorldTurn(rotations, ankle, multiply(toVertical(rotateVector<number[]>(turn, [0, 1, 0])), turn));
  level.fill(0, toes * 3, toes * 3 + 3);
  return withTurn(level, ankle, clamp(ankle, turnOf(level, ankle)));
}

/**
 * Puts the soles of the standing feet flat: those whose ankle is no more than 12 cm above the lower one. A raised foot keeps its point.
 * @param clamp keeps the ankles within their limits; by default they turn as far as it takes
 */
export function levelFeet(rotations: Numbers, clamp: ClampJoint = (_, q) => q): number[] {
  const at = forwardKinematics(poseToQuaternions(rotations), [0, 0, 0]);
  const lowest = Math.min(...SIDES.map(({ ankle }) => at[ankle * 3 + 1]));
  let next = Array.from(rotations);
  for (const side of SIDES) if (at[side.ankle * 3 + 1] <= lowest + RAISED) next = levelFoot(next, side, clamp);
  return next;
}

/**
 * How far a random variation turns each kind of joint, standard deviation in radians about its own x, y, z at amount 1. Arms have the
 * most to say and the spine the least, as in dance; elbows turn about their hinge (y) and knees about theirs (x).
 */
const SPREAD: Readonly<Record<string, readonly [number, number, number]>> = {
  pelvis: [0.06, 0, 0.05],
  spine1: [0.07, 0.1, 0.07],
  spine2: [0.07, 0.1, 0.07],
  spine3: [0.07, 0.1, 0.07],
  neck: [0.08, 0.12, 0.07],
  head: [0.1, 0.2, 0.1],
  collar: [0.04, 0.08, 0.08],
  shoulder: [0.35, 0.5, 0.6],
  elbow: [0.1, 0.6, 0.08],
  wrist: [0.3, 0.2, 0.25],
  hand: [0.05, 0.05, 0.15],
  hip: [0.3, 0.2, 0.15],
  knee: [0.35, 0, 0],
  ankle: [0.08, 0.08, 0.05],
  foot: [0.1, 0, 0],
};
/** Draws further out than this many deviations are drawn again: no limb flies off. */
const OUTERMOST = 2;
/** A sole within this angle of level stays level in a variation, radians. */
const NEARLY_LEVEL = 0.35;

function normal(random: Random): number {
  for (;;) {
    // Box and Muller (1958).
    const value = Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
    if (Math.abs(value) <= OUTERMOST) return value;
  }
}

/**
 * A random variation of a pose: arms far, spine little, heading not at all; feet that stood flat go on standing flat.
 * @param amount 0 changes nothing, 1 is wild
 * @param seed the same seed gives the same variation
 * @param clamp keeps every changed joint within its limits
 */
export function randomPose(rotations: Numbers, amount: number, seed: number, clamp: ClampJoint): number[] {
  let next = Array.from(rotations);
  if (!(amount > 0)) return next;
  const random = seededRandom(seed);
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const spread = SPREAD[JOINTS[joint].replace(/^(left|right)_/, '')];
    const turn = axisAngleToQuaternion(spread.map((deviation) => normal(random) * deviation * amount));
    const varied = multiply(turnOf(rotations, joint), turn);
    // The pelvis stands free; its heading is the visitor's.
    setTurn(next, joint, joint === 0 ? varied : clamp(joint, varied));
  }
  next = turnPose(next, headingOfPose(rotations) - headingOfPose(next));
  for (const side of SIDES) {
    const up = rotateVector(worldTurn(rotations, side.ankle), [0, 1, 0]);
    if (Math.acos(Math.min(up[1], 1)) < NEARLY_LEVEL) next = levelFoot(next, side, clamp);
  }
  return next;
}

/**
 * Brings joints inside their limits.
 * @param members the joints to look at, by default all but the pelvis, which is free
 * @returns the pose, and the joints that had to give way
 */
export function limitPose(
  rotations: Numbers,
  clamp: ClampJoint,
  members: Iterable<number> = JOINTS.keys(),
): { rotations: number[]; limited: number[] } {
  const next = Array.from(rotations);
  const limited: number[] = [];
  for (const joint of members) {
    if (joint === 0) continue;
    const turn = turnOf(rotations, joint);
    const inside = clamp(joint, turn);
    // A hundredth of a degree is rounding, not a limit.
    if (angleBetween(turn, inside) < 2e-4) continue;
    setTurn(next, joint, inside);
    limited.push(joint);
  }
  return { rotations: next, limited };
}
