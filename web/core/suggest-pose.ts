/** Poses as the key pose model has them (24 x 6D, then the root), and as key poses have them. */
import { clampPose } from './joint-limits';
import { poseToQuaternions, quaternionsToPose, quaternionsToSixD, sixDToQuaternion } from './rotation';
import { forwardKinematics, JOINT_COUNT } from './skeleton';
import { spec } from './spec';

/** Numbers of a pose with its root. */
export const ROW_SIZE = spec.model.motionSize;
const ROTATION_SIZE = spec.model.rotationSize;

/** Steps in a radian that suggested poses are rounded to, 0.006 degrees: a song of them stays a small file. */
const STEPS = 10_000;

/** A key pose as the model's 144 rotation numbers; the root is left at 0. */
export function rowOfPose(rotations: readonly number[]): Float32Array {
  const row = new Float32Array(ROW_SIZE);
  row.set(quaternionsToSixD(poseToQuaternions(rotations)));
  return row;
}

/** A key pose (24 x 3 axis-angle, radians) from the model's numbers, every joint inside its limits. */
export function poseOfRow(row: ArrayLike<number>): number[] {
  const quaternions = new Float32Array(JOINT_COUNT * 4);
  const sixD = [0, 0, 0, 0, 0, 0];
  const q = [0, 0, 0, 1];
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    for (let i = 0; i < 6; i++) sixD[i] = row[joint * 6 + i];
    quaternions.set(sixDToQuaternion(sixD, q), joint * 4);
  }
  // + 0: no minus zero.
  return quaternionsToPose(clampPose(quaternions)).map((value) => Math.round(value * STEPS) / STEPS + 0);
}

/** Farthest way over the floor from beat to beat, and heights of a pelvis, metres: a root that runs away would carry the poses along. */
const LONGEST_STEP = 2;
const HEIGHTS = [0.1, 1.6] as const;

/**
 * Puts the rotations of one row, and the root of another, into `out`; the root stays within a dancer's reach of the pose before.
 * @param before the pose one beat before, if there is one
 */
export function joinRow(
  rotations: ArrayLike<number>,
  root: ArrayLike<number>,
  before: ArrayLike<number> | undefined,
  out: Float32Array,
): void {
  for (let i = 0; i < ROTATION_SIZE; i++) out[i] = rotations[i];
  const [x, y, z] = [ROTATION_SIZE, ROTATION_SIZE + 1, ROTATION_SIZE + 2];
  const [fromX, fromZ] = before ? [before[x], before[z]] : [0, 0];
  const [dx, dz] = [root[x] - fromX, root[z] - fromZ];
  const share = Math.min(1, LONGEST_STEP / Math.max(1e-9, Math.hypot(dx, dz)));
  out[x] = fromX + dx * share;
  out[y] = Math.min(Math.max(root[y], HEIGHTS[0]), HEIGHTS[1]);
  out[z] = fromZ + dz * share;
}

/** Mean distance of the joints of two poses with the pelvis in one place, metres. */
export function poseDistance(a: readonly number[], b: readonly number[]): number {
  const [first, second] = [a, b].map((pose) => forwardKinematics(poseToQuaternions(pose), [0, 0, 0]));
  let sum = 0;
  for (let i = 0; i < first.length; i += 3)
    sum += Math.hypot(first[i] - second[i], first[i + 1] - second[i + 1], first[i + 2] - second[i + 2]);
  return sum / JOINT_COUNT;
}
