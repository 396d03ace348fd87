/** The skeleton of spec.json: 24 SMPL joints, T-pose rest, metres, Y up, facing +Z, left = +X. */
import { multiply, rotateVector, type Numbers } from './rotation';
import { spec } from './spec';

export const JOINTS: readonly string[] = spec.skeleton.joints;
/** Parent of each joint; -1 for the pelvis. A parent always comes before its children. */
export const PARENTS: readonly number[] = spec.skeleton.parents;
/** Rest offset of each joint from its parent, metres. */
export const OFFSETS: readonly (readonly [number, number, number])[] = spec.skeleton.offsets;
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
  const parent = [0, 0, 0, 1];
  const local = [0, 0, 0, 1];
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    for (let i = 0; i < 4; i++) local[i] = quaternions[joint * 4 + i];
    if (PARENTS[joint] >= 0) {
      for (let i = 0; i < 4; i++) parent[i] = out[PARENTS[joint] * 4 + i];
      multiply(parent, local, local);
    }
    for (let i = 0; i < 4; i++) out[joint * 4 + i] = local[i];
  }
  return out;
}

const scratch = new Float32Array(JOINT_COUNT * 4);

/**
 * Forward kinematics.
 * @param quaternions 24 x 4 local rotations; joint 0 is the world orientation
 * @param root pelvis position, metres
 * @returns 24 x 3 world joint positions, metres
 */
export function forwardKinematics(
  quaternions: Numbers,
  root: Numbers,
  out: Float32Array = new Float32Array(JOINT_COUNT * 3),
): Float32Array {
  worldRotations(quaternions, scratch);
  for (let i = 0; i < 3; i++) out[i] = root[i];
  const q = [0, 0, 0, 1];
  const offset = [0, 0, 0];
  for (let joint = 1; joint < JOINT_COUNT; joint++) {
    const parent = PARENTS[joint];
    for (let i = 0; i < 4; i++) q[i] = scratch[parent * 4 + i];
    rotateVector(q, OFFSETS[joint], offset);
    for (let i = 0; i < 3; i++) out[joint * 3 + i] = out[parent * 3 + i] + offset[i];
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
