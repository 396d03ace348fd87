/** How the body stands on its pins: within reach of them, feet flat, weight over them. */
import { centreOfMass } from './balance';
import type { IkGoal } from './ik';
import { limbEndingIn, place, swivelLimb, turnInWorld, type PlacedBody } from './ik-limb';
import { axisAngleToQuaternion, conjugate, multiply, quaternionToAxisAngle, type Numbers } from './rotation';
import { spec } from './spec';

/** Share of a limb's length that pins leave it. */
const EASY_REACH = 0.9955;

/** What ties the pelvis to a pinned hand or foot. */
export interface Tether {
  upper: number;
  position: Numbers;
  /** Metres. */
  length: number;
}

/** Shoulder or hip may be as far from the pin as the limb reaches easily, or as it was. */
export function tether({ joints }: PlacedBody, { joint, position }: IkGoal): Tether[] {
  const limb = limbEndingIn(joint);
  if (!limb) return [];
  const { upper, middle, end } = limb;
  const point = (at: number) => joints.slice(at * 3, at * 3 + 3);
  const bones = distanceTo(joints, upper, point(middle)) + distanceTo(joints, end, point(middle));
  return [{ upper, position, length: Math.max(bones * EASY_REACH, distanceTo(joints, upper, point(end))) }];
}

/** Pins come first: the pelvis stays within reach of every pinned hand and foot. */
export function followPins(body: PlacedBody, tethers: readonly Tether[]): void {
  for (let round = 0; round < 4; round++) {
    for (const { upper, position, length } of tethers) {
      const way = [0, 1, 2].map((i) => position[i] - body.joints[upper * 3 + i]);
      const far = Math.hypot(...way);
      if (far <= length) continue;
      for (let i = 0; i < 3; i++) body.root[i] += (way[i] / far) * (far - length);
      place(body);
    }
  }
}

/** Distance of a joint from a place, metres. */
export function distanceTo(joints: Numbers, joint: number, position: Numbers): number {
  return Math.hypot(
    joints[joint * 3] - position[0],
    joints[joint * 3 + 1] - position[1],
    joints[joint * 3 + 2] - position[2],
  );
}

const FEET = [spec.skeleton.feet.left, spec.skeleton.feet.right];
/** How far the pelvis gives way for each radian that an ankle lacks, metres. */
const GIVING_WAY = 0.25;
/** How far the weight may be in front of or behind its spot before the trunk leans against it, metres. */
const SWAY = 0.05;
/** Lean for each metre that the weight is off, radians, a little at a time. */
const COUNTERWEIGHT = 1.2;
/** Ankles that lack less than this are well, radians. */
const WELL = 0.03;

/** A pinned foot and where it points on the floor. */
export interface Stance {
  ankle: number;
  rotation: Numbers;
  facing: readonly [number, number, number];
}

/** The feet that pins hold, with their rotation. */
export function stanceOf({ joints }: PlacedBody, pins: readonly IkGoal[]): Stance[] {
  return pins.flatMap(({ joint, rotation }) => {
    const foot = FEET.find(({ ankle }) => ankle === joint);
    if (!foot || !rotation) return [];
    const [x, z] = [0, 2].map((i) => joints[foot.toe * 3 + i] - joints[foot.ankle * 3 + i]);
    const length = Math.hypot(x, z) || 1;
    return [{ ankle: joint, rotation, facing: [x / length, 0, z / length] as const }];
  });
}

/**
 * Lets the pelvis give way where ankles do not bend far enough to keep the feet flat, as in a squat the seat goes back, and, where the
 * pelvis itself is dragged, leans the trunk against the weight that this moves.
 * @param body changed in place
 * @param weight where the centre of mass was, metres, or null where the trunk has goals of its own
 * @returns true when all is well
 */
export function giveWay(body: PlacedBody, feet: readonly Stance[], weight: Numbers | null): boolean {
  let well = true;
  for (const { ankle, rotation, facing } of feet) {
    const lacking = multiply(rotation, conjugate(body.turns.subarray(ankle * 4, ankle * 4 + 4)));
    const lateral = [facing[2], 0, -facing[0]];
    const turn = quaternionToAxisAngle(lacking);
    const pitch = turn[0] * lateral[0] + turn[2] * lateral[2];
    if (Math.abs(pitch) < WELL) continue;
    well = false;
    const way = (Math.min(Math.max(pitch, -0.5), 0.5) * GIVING_WAY) / feet.length;
    for (let i = 0; i < 3; i++) body.root[i] += facing[i] * way;
  }
  place(body);
  if (!weight || feet.length === 0) return well;
  const [x, , z] = centreOfMass(body.joints);
  const facing = feet.reduce((sum, foot) => [sum[0] + foot.facing[0], 0, sum[2] + foot.facing[2]], [0, 0, 0]);
  const length = Math.hypot(facing[0], facing[2]) || 1;
  const off = ((x - weight[0]) * facing[0] + (z - weight[2]) * facing[2]) / length;
  const beyond = off > SWAY ? off - SWAY : off < -SWAY ? off + SWAY : 0;
  if (Math.abs(beyond) < 0.004) return well;
  const lateral = [facing[2] / length, 0, -facing[0] / length];
  turnInWorld(body, 0, axisAngleToQuaternion(lateral.map((c) => -c * beyond * COUNTERWEIGHT)));
  return false;
}

/** A knee that bends this much more than before begins to follow its toes, radians. */
const SQUATTING = 0.3;

/**
 * Lets the knees of a squat go out over the toes, a little in each solve.
 * @param before local rotations before the drag, 24 x 4
 */
export function kneesOverToes(body: PlacedBody, feet: readonly Stance[], before: Numbers): void {
  for (const { ankle, facing } of feet) {
    const limb = limbEndingIn(ankle)!;
    const bend = (q: Numbers) => 2 * Math.acos(Math.min(Math.abs(q[limb.middle * 4 + 3]), 1));
    if (bend(body.quaternions) < bend(before) + SQUATTING) continue;
    const toes = facing.map((c, i) => body.joints[ankle * 3 + i] + c);
    swivelLimb(body, limb, toes, 0.15);
  }
}
