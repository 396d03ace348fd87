/** Arms and legs in closed form: two bones reach a point exactly, the elbow or knee staying on its side. */
import type { IkBody } from './ik-body';
import { clampRotation } from './joint-limits';
import { axisAngleToQuaternion, conjugate, multiply, rotateVector, type Numbers } from './rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, PARENTS } from './skeleton';
import { cross, dot, minus, norm, pointOf, type Vector } from './vector';

/** Two bones and the joints at their ends. */
export interface Limb {
  upper: number;
  middle: number;
  end: number;
  /** Axis of the elbow or knee in its own frame; turning about it bends the limb. */
  hinge: readonly [number, number, number];
}

const limb = (upper: string, middle: string, end: string, hinge: [number, number, number]): Limb => ({
  upper: jointIndex(upper),
  middle: jointIndex(middle),
  end: jointIndex(end),
  hinge,
});

/** Left arm, right arm, left leg, right leg. */
export const LIMBS: readonly Limb[] = [
  limb('left_shoulder', 'left_elbow', 'left_wrist', [0, -1, 0]),
  limb('right_shoulder', 'right_elbow', 'right_wrist', [0, 1, 0]),
  limb('left_hip', 'left_knee', 'left_ankle', [1, 0, 0]),
  limb('right_hip', 'right_knee', 'right_ankle', [1, 0, 0]),
];

/** The limb that ends in a joint, if any. */
export const limbEndingIn = (joint: number): Limb | undefined => LIMBS.find(({ end }) => end === joint);
/** The limb whose elbow or knee a joint is, if any. */
export const limbBentAt = (joint: number): Limb | undefined => LIMBS.find(({ middle }) => middle === joint);

/** A body with its world positions and rotations at hand. */
export interface PlacedBody extends IkBody {
  /** 24 x 3. */
  joints: Float32Array;
  /** 24 x 4 world rotations. */
  turns: Float32Array;
  /** Degrees that each joint may be beyond its range, or null for no limits. */
  slack: Float32Array | null;
}

/** Works out where everything is. */
export function place(body: PlacedBody): void {
  forwardKinematics(body.quaternions, body.root, body.joints, body.turns);
}

/** Makes room for a body. */
export function createPlacedBody(): PlacedBody {
  return {
    root: new Float32Array(3),
    quaternions: new Float32Array(JOINT_COUNT * 4),
    joints: new Float32Array(JOINT_COUNT * 3),
    turns: new Float32Array(JOINT_COUNT * 4),
    slack: null,
  };
}

/** Turns a joint in the world (x y z w) and everything that hangs on it, in place; the turn comes after the joint's present one. */
export function turnInWorld(body: PlacedBody, joint: number, turn: Numbers): void {
  setWorldTurn(body, joint, multiply(turn, body.turns.subarray(joint * 4, joint * 4 + 4)));
}

/** Gives a joint a world rotation (x y z w), as far as its limits let it, in place. */
export function setWorldTurn(body: PlacedBody, joint: number, turn: Numbers): void {
  const parent = PARENTS[joint];
  const local =
    parent < 0 ? Array.from(turn) : multiply(conjugate(body.turns.subarray(parent * 4, parent * 4 + 4)), turn);
  const length = Math.hypot(local[0], local[1], local[2], local[3]);
  const q = body.quaternions.subarray(joint * 4, joint * 4 + 4);
  for (let i = 0; i < 4; i++) q[i] = local[i] / length;
  limitJoint(body, joint);
  place(body);
}

/** Puts one joint back into its range; true when it was outside. */
export function limitJoint({ quaternions, slack }: PlacedBody, joint: number): boolean {
  if (!slack) return false;
  const q = quaternions.subarray(joint * 4, joint * 4 + 4);
  const before = [q[0], q[1], q[2], q[3]];
  clampRotation(joint, q, q, slack[joint]);
  return before.some((value, i) => value !== q[i]);
}

/** Shortest turn from one direction to another (neither needs unit length), of `most` radians at most. */
function turnBetween(from: Numbers, to: Numbers, most = Math.PI): number[] {
  const scale = 1 / (norm(from) * norm(to) || 1);
  const c = cross(from, to);
  const sine = norm(c) * scale;
  const cosine = dot(from, to) * scale;
  if (sine < 1e-9) return [0, 0, 0, 1]; // along it already, or straight against it, where no axis is better than another
  const angle = Math.min(Math.atan2(sine, cosine), most) * (scale / sine);
  return axisAngleToQuaternion(c.map((x) => x * angle));
}

/** Below this sine of its bend a limb counts as straight and bends about its anatomical hinge. */
const STRAIGHT = 0.2;
/** Longest reach, as a share of both bones: the knee's bones are not quite in line even when it is stretched. */
const STRETCH = 0.9985;
/** Rounds of bending and swinging in one fit. */
const FIT_ROUNDS = 6;
/** Largest swing in one round, radians: so a limb that its limits stop does not hop over to their other side. */
const SWING = 0.35;

/**
 * Puts the end of a limb at a point by bending the middle and swinging the upper joint; where the point is too far the limb stretches
 * towards it.
 * @returns distance that is left, metres
 */
export function fitLimb(body: PlacedBody, { upper, middle, end, hinge }: Limb, target: Numbers): number {
  // The hinge is not exactly across both bones, so that further rounds take away what the first one left.
  for (let round = 0; round < FIT_ROUNDS; round++) {
    const { joints, turns } = body;
    const a = pointOf(joints, upper);
    const u = minus(pointOf(joints, middle), a);
    const v = minus(pointOf(joints, end), pointOf(joints, middle));
    const way = minus(target, a);
    const [l1, l2] = [norm(u), norm(v)];
    const distance = Math.min(Math.max(norm(way), Math.abs(l1 - l2) + 1e-3), (l1 + l2) * STRETCH);
    const wanted = Math.acos(clampUnit((distance * distance - l1 * l1 - l2 * l2) / (2 * l1 * l2)));

    const own = rotateVector(turns.subarray(middle * 4, middle * 4 + 4), hinge);
    const along = dot(own, u) / (l1 * l1);
    const natural = own.map((c, i) => c - along * u[i]);
    const bent = cross(u, v).map((c) => c / (l1 * l2));
    const sine = norm(bent);
    // The plane it is bent in, as long as that can be told; near straight the hinge decides, so the elbow never turns over.
    const share = Math.max(0, 1 - sine / STRAIGHT);
    const axis = bent.map((c, i) => c + natural[i] * share);
    const size = norm(axis) || 1;
    const unit = axis.map((c) => c / size);
    const present = Math.atan2(dot(bent, unit), dot(u, v) / (l1 * l2));
    turnInWorld(body, middle, axisAngleToQuaternion(unit.map((c) => c * (wanted - present))));

    turnInWorld(body, upper, turnBetween(minus(pointOf(body.joints, end), a), way, SWING));
    const left = norm(minus(target, pointOf(body.joints, end)));
    if (left < 1e-5) return left;
  }
  return norm(minus(target, pointOf(body.joints, end)));
}

/**
 * Swings the elbow or knee about the line from shoulder to wrist (hip to ankle) towards a point, as far as the limits let it; the
 * end of the limb stays where it is and keeps its rotation. In place.
 * @param target world position, metres
 * @param part how much of the way, 0..1
 */
export function swivelLimb(body: PlacedBody, { upper, middle, end }: Limb, target: Numbers, part = 1): void {
  const a = pointOf(body.joints, upper);
  const line = minus(pointOf(body.joints, end), a);
  const length2 = dot(line, line);
  if (length2 < 1e-6) return;
  const across = (p: Vector): Vector => {
    const t = dot(minus(p, a), line) / length2;
    return minus(
      minus(p, a),
      line.map((c) => c * t),
    );
  };
  const from = across(pointOf(body.joints, middle));
  const to = across([target[0], target[1], target[2]]);
  if (norm(from) < 1e-4 || norm(to) < 1e-4) return;
  const length = Math.sqrt(length2);
  const angle = part * Math.atan2(dot(cross(from, to), line) / length, dot(from, to));
  const axis = line.map((c) => c / length);

  const start = body.quaternions.slice();
  const goal = pointOf(body.joints, end);
  const held = Array.from(body.turns.subarray(end * 4, end * 4 + 4));
  const attempt = (share: number): boolean => {
    body.quaternions.set(start);
    place(body);
    turnInWorld(body, upper, axisAngleToQuaternion(axis.map((c) => c * angle * share)));
    setWorldTurn(body, end, held);
    return norm(minus(goal, pointOf(body.joints, end))) < 5e-4;
  };
  if (attempt(1)) return;
  // The limits stop it on the way: as far as it goes.
  let [low, high] = [0, 1];
  for (let i = 0; i < 10; i++) {
    const middle = (low + high) / 2;
    if (attempt(middle)) low = middle;
    else high = middle;
  }
  attempt(low);
}

function clampUnit(value: number): number {
  return Math.min(Math.max(value, -1), 1);
}
