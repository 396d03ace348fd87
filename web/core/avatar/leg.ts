/** Two-bone inverse kinematics of an avatar's leg, without garbage: the knee stays in its plane, the foot keeps its direction. */
import { multiply, rotateVector } from '../rotation';

/** World places and rotations of hip, knee and ankle; changed in place. */
export interface PlacedLeg {
  hip: Float64Array;
  knee: Float64Array;
  ankle: Float64Array;
  hipTurn: Float64Array;
  kneeTurn: Float64Array;
  /** Lengths of thigh and shin. */
  thigh: number;
  shin: number;
}

/** A leg is never stretched further than this share of its length: a straight knee snaps. */
export const LONGEST = 0.9995;
/** Below this sine of its bend a knee counts as straight and bends about the knee's own axis. */
const STRAIGHT = 0.15;
/** The axis is not quite across both bones where the knee's own has a say: a second round takes away what the first one left. */
const ROUNDS = 3;

const up = new Float64Array(3);
const down = new Float64Array(3);
const axis = new Float64Array(3);
const goal = new Float64Array(3);
const turn = new Float64Array(4);

function between(from: Float64Array, to: Float64Array, out: Float64Array): void {
  for (let k = 0; k < 3; k++) out[k] = to[k] - from[k];
}
const length = (v: Float64Array) => Math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
const dot = (a: Float64Array, b: Float64Array) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Angle inside the knee, by the law of cosines, radians. */
function kneeAngle(thigh: number, shin: number, span: number): number {
  const cosine = (thigh * thigh + shin * shin - span * span) / (2 * thigh * shin);
  return Math.acos(Math.min(1, Math.max(-1, cosine)));
}

/**
 * Puts the ankle at a point, as far as the leg reaches.
 * @param across the knee's own axis in the world, to the left of the body, unit
 */
export function reachWithLeg(leg: PlacedLeg, target: Float64Array, across: Float64Array): void {
  const { hip, knee, ankle, hipTurn, kneeTurn, thigh, shin } = leg;
  between(hip, target, goal);
  for (let round = 0; round < ROUNDS; round++) {
    between(knee, hip, up);
    between(knee, ankle, down);
    const now = Math.hypot(ankle[0] - hip[0], ankle[1] - hip[1], ankle[2] - hip[2]);
    const reach = length(goal);
    // A leg that is straighter than the limit already keeps its length.
    const most = Math.max((thigh + shin) * LONGEST, Math.min(now, reach));
    const wanted = Math.max(Math.abs(thigh - shin) * 1.001, Math.min(reach, most));
    bendAxis(thigh, shin, across);
    aboutAxis(kneeAngle(thigh, shin, wanted) - kneeAngle(thigh, shin, now));
    rotateVector(turn, down, down);
    multiply(turn, kneeTurn, kneeTurn);
    for (let k = 0; k < 3; k++) ankle[k] = knee[k] + down[k];
    // With the knee bent anew the ankle lies elsewhere; turning the hip brings it in line with the goal.
    between(hip, ankle, down);
    arcTo(down, goal);
    multiply(turn, hipTurn, hipTurn);
    multiply(turn, kneeTurn, kneeTurn);
    swing(hip, knee);
    swing(hip, ankle);
    if (Math.abs(Math.hypot(ankle[0] - hip[0], ankle[1] - hip[1], ankle[2] - hip[2]) - wanted) < 1e-6 * thigh) return;
  }
}

/** Axis about which a positive turn of the shin straightens the leg: across the plane of the leg, near straight the knee's own. */
function bendAxis(thigh: number, shin: number, across: Float64Array): void {
  axis[0] = up[1] * down[2] - up[2] * down[1];
  axis[1] = up[2] * down[0] - up[0] * down[2];
  axis[2] = up[0] * down[1] - up[1] * down[0];
  const sine = length(axis) / (thigh * shin || 1);
  const sure = Math.min(1, sine / STRAIGHT);
  const size = length(axis);
  for (let k = 0; k < 3; k++) axis[k] = (size > 0 ? (sure * axis[k]) / size : 0) - (1 - sure) * across[k];
  // Straight across the shin, so that the whole turn bends.
  const along = dot(axis, down) / (dot(down, down) || 1);
  for (let k = 0; k < 3; k++) axis[k] -= along * down[k];
}

function aboutAxis(angle: number): void {
  const scale = Math.sin(angle / 2) / (length(axis) || 1);
  for (let k = 0; k < 3; k++) turn[k] = axis[k] * scale;
  turn[3] = Math.cos(angle / 2);
}

/** Shortest rotation from one direction to another. */
function arcTo(a: Float64Array, b: Float64Array): void {
  turn[0] = a[1] * b[2] - a[2] * b[1];
  turn[1] = a[2] * b[0] - a[0] * b[2];
  turn[2] = a[0] * b[1] - a[1] * b[0];
  turn[3] = length(a) * length(b) + dot(a, b);
  const size = Math.sqrt(dot(turn, turn) + turn[3] * turn[3]);
  if (size > 1e-12) for (let k = 0; k < 4; k++) turn[k] /= size;
  else turn.set(NONE);
}
const NONE = [0, 0, 0, 1];

/** Turns a point about the hip. */
function swing(hip: Float64Array, point: Float64Array): void {
  between(hip, point, up);
  rotateVector(turn, up, up);
  for (let k = 0; k < 3; k++) point[k] = hip[k] + up[k];
}
