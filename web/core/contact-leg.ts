/** Two-bone inverse kinematics of a leg: the foot is moved, its direction in the world is kept. */
import { conjugate, multiply, rotateVector, type Numbers } from './rotation';
import { forwardKinematics, JOINT_COUNT, PARENTS } from './skeleton';
import { spec } from './spec';
import { cross, distance, dot, minus, norm, pointOf } from './vector';

const LEGS = [spec.skeleton.feet.left, spec.skeleton.feet.right].map(({ ankle }) => ({
  ankle,
  knee: PARENTS[ankle],
  hip: PARENTS[PARENTS[ankle]],
}));
/** A leg is never stretched further than this share of its length: a straight knee snaps. */
const LONGEST = 0.998;

const joints = new Float32Array(JOINT_COUNT * 3);
const turns = new Float32Array(JOINT_COUNT * 4);

/**
 * Moves one foot of a pose, in place.
 * @param quaternions 24 x 4 local rotations
 * @param foot 0 = left, 1 = right
 * @param offset where the foot goes from where it is, metres, world axes; what the leg cannot reach is left out
 */
export function moveFoot(quaternions: Float32Array, foot: 0 | 1, offset: Numbers): void {
  const { hip, knee, ankle } = LEGS[foot];
  forwardKinematics(quaternions, [0, 0, 0], joints, turns);
  const turn = (joint: number) => turns.slice(joint * 4, joint * 4 + 4);
  const [hipAt, kneeAt, ankleAt] = [hip, knee, ankle].map((joint) => pointOf(joints, joint));
  const thigh = distance(hipAt, kneeAt);
  const shin = distance(kneeAt, ankleAt);
  const goal = ankleAt.map((value, k) => value + offset[k] - hipAt[k]);
  const longest = (thigh + shin) * LONGEST;
  const reach = norm(goal);
  // A leg that is straighter than the limit already keeps its length: shortening it would bend it out of nothing.
  const now = distance(hipAt, ankleAt);
  const wanted = Math.min(reach, Math.max(longest, Math.min(now, reach)));

  const bend = kneeAngle(thigh, shin, wanted) - kneeAngle(thigh, shin, now);
  const axis = bendAxis(hipAt, kneeAt, ankleAt, turn(knee));
  const kneeTurn = about(axis, bend);
  // With the knee bent anew the ankle lies elsewhere; turning the hip brings it in line with the goal.
  const lower = rotateVector(
    kneeTurn,
    ankleAt.map((value, k) => value - kneeAt[k]),
  );
  const reached = Array.from(lower, (value, k) => value + kneeAt[k] - hipAt[k]);
  const hipTurn = between(reached, goal);

  const newHip = multiply(hipTurn, turn(hip));
  const newKnee = multiply(hipTurn, multiply(kneeTurn, turn(knee)));
  const pelvis = turn(PARENTS[hip]);
  quaternions.set(multiply(conjugate(pelvis), newHip), hip * 4);
  quaternions.set(multiply(conjugate(newHip), newKnee), knee * 4);
  quaternions.set(multiply(conjugate(newKnee), turn(ankle)), ankle * 4);
}

/** Angle inside the knee, by the law of cosines, radians. */
function kneeAngle(thigh: number, shin: number, span: number): number {
  const cosine = (thigh * thigh + shin * shin - span * span) / (2 * thigh * shin);
  return Math.acos(Math.min(1, Math.max(-1, cosine)));
}

/** Axis about which a positive turn of the shin straightens the leg. */
function bendAxis(hip: number[], knee: number[], ankle: number[], kneeTurn: Float32Array): number[] {
  const normal = cross(minus(hip, knee), minus(ankle, knee));
  const length = norm(normal);
  // Near a straight leg the plane is noise: fade over to the knee's own axis, about which a human knee bends.
  const sure = Math.min(1, length / 0.02);
  const own = rotateVector(kneeTurn, [1, 0, 0]);
  return normal.map((value, k) => (length > 0 ? (sure * value) / length : 0) - (1 - sure) * own[k]);
}

function about(axis: number[], angle: number): number[] {
  const length = norm(axis) || 1;
  const scale = Math.sin(angle / 2) / length;
  return [axis[0] * scale, axis[1] * scale, axis[2] * scale, Math.cos(angle / 2)];
}

/** Shortest rotation from one direction to another. */
function between(a: number[], b: number[]): number[] {
  const q = [...cross(a, b), norm(a) * norm(b) + dot(a, b)];
  const length = Math.hypot(q[0], q[1], q[2], q[3]);
  return length > 1e-9 ? q.map((value) => value / length) : [0, 0, 0, 1];
}
