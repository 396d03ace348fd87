/** The skeleton of spec.json: 24 SMPL joints, T-pose rest, metres, Y up, facing +Z, left = +X. */
import type { Numbers } from './rotation';
import { spec } from './spec';

/** Names of the 24 joints, in SMPL order. */
export const JOINTS: readonly string[] = spec.skeleton.joints;
/** Parent of each joint; -1 for the pelvis. A parent always comes before its children. */
export const PARENTS: readonly number[] = spec.skeleton.parents;
/** Rest offset of each joint from its parent, metres. */
export const OFFSETS: readonly (readonly [number, number, number])[] = spec.skeleton.offsets;
/** How many they are. */
export const JOINT_COUNT: number = JOINTS.length;

/**
 * Index of a joint.
 * @throws Error when the skeleton has no joint of that name
 */
export function jointIndex(name: string): number {
  const index = JOINTS.indexOf(name);
  if (index < 0) throw new Error(`No joint is called "${name}". Joints: ${JOINTS.join(', ')}.`);
  return index;
}

/** For each joint the one on the other side; a joint of the middle is its own. */
export const MIRROR: readonly number[] = JOINTS.map((name) => {
  if (name.startsWith('left_')) return jointIndex(name.replace('left_', 'right_'));
  if (name.startsWith('right_')) return jointIndex(name.replace('right_', 'left_'));
  return jointIndex(name);
});

/**
 * World rotation of every joint.
 * @param quaternions 24 x 4 local rotations
 * @returns 24 x 4
 */
export function worldRotations(
  quaternions: Numbers,
  out: Float32Array = new Float32Array(JOINT_COUNT * 4),
): Float32Array {
  // Written out without small arrays: this runs for every frame of a dance, several times.
  for (let joint = 0, i = 0; joint < JOINT_COUNT; joint++, i += 4) {
    const x = quaternions[i];
    const y = quaternions[i + 1];
    const z = quaternions[i + 2];
    const w = quaternions[i + 3];
    const p = PARENTS[joint] * 4;
    if (p < 0) {
      out[i] = x;
      out[i + 1] = y;
      out[i + 2] = z;
      out[i + 3] = w;
      continue;
    }
    const [px, py, pz, pw] = [out[p], out[p + 1], out[p + 2], out[p + 3]];
    out[i] = pw * x + px * w + py * z - pz * y;
    out[i + 1] = pw * y - px * z + py * w + pz * x;
    out[i + 2] = pw * z + px * y - py * x + pz * w;
    out[i + 3] = pw * w - px * x - py * y - pz * z;
  }
  return out;
}

const scratch = new Float32Array(JOINT_COUNT * 4);

/**
 * Forward kinematics.
 * @param quaternions 24 x 4 local rotations; joint 0 is the world orientation
 * @param root pelvis position, metres
 * @param turns receives the world rotations, 24 x 4, where they are wanted too
 * @returns 24 x 3 world joint positions, metres
 */
export function forwardKinematics(
  quaternions: Numbers,
  root: Numbers,
  out: Float32Array = new Float32Array(JOINT_COUNT * 3),
  turns: Float32Array = scratch,
): Float32Array {
  worldRotations(quaternions, turns);
  for (let i = 0; i < 3; i++) out[i] = root[i];
  for (let joint = 1; joint < JOINT_COUNT; joint++) {
    const q = PARENTS[joint] * 4;
    const [x, y, z, w] = [turns[q], turns[q + 1], turns[q + 2], turns[q + 3]];
    const [vx, vy, vz] = OFFSETS[joint];
    const tx = 2 * (y * vz - z * vy);
    const ty = 2 * (z * vx - x * vz);
    const tz = 2 * (x * vy - y * vx);
    const from = PARENTS[joint] * 3;
    const to = joint * 3;
    out[to] = out[from] + vx + w * tx + y * tz - z * ty;
    out[to + 1] = out[from + 1] + vy + w * ty + z * tx - x * tz;
    out[to + 2] = out[from + 2] + vz + w * tz + x * ty - y * tx;
  }
  return out;
}

/**
 * The pose seen in a mirror that stands in the figure's own left-right plane: sides swapped, turns about Y and Z reversed.
 * @param rotations 24 x 3 axis-angle
 * @returns 24 x 3 axis-angle
 */
export function mirrorPose(rotations: Numbers): number[] {
  const mirrored: number[] = [];
  for (const source of MIRROR) {
    mirrored.push(rotations[source * 3], 0 - rotations[source * 3 + 1], 0 - rotations[source * 3 + 2]);
  }
  return mirrored;
}
