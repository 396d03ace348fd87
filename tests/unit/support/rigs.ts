/** Skeletons that are not ours, and files of them, made by the tests themselves. */
import { axisAngleToQuaternion, multiply, rotateVector } from '../../../web/core/rotation';
import { JOINTS, OFFSETS, PARENTS } from '../../../web/core/skeleton';

type Vector = readonly [number, number, number];

/** A joint: name, index of its parent, offset from it in the rest pose. */
export interface RigJoint {
  name: string;
  parent: number;
  offset: Vector;
}

/** Our own skeleton under its own names. */
export const OWN_RIG: RigJoint[] = JOINTS.map((name, i) => ({ name, parent: PARENTS[i], offset: OFFSETS[i] }));

/** Names of the parts as Mixamo, CMU and Unreal give them; legs longer, arms hanging at 45 degrees, a back of two or three joints. */
const NAMES = {
  mixamo: (part: string, side?: 'Left' | 'Right') => `mixamorig:${side ?? ''}${part}`,
  cmu: (part: string, side?: 'Left' | 'Right') => `${side ?? ''}${part}`,
  unreal: (part: string, side?: 'Left' | 'Right') => {
    const unreal: Record<string, string> = {
      Hips: 'pelvis',
      Spine: 'spine_01',
      Spine1: 'spine_02',
      Spine2: 'spine_03',
      Neck: 'neck_01',
      Head: 'head',
      Shoulder: 'clavicle',
      Arm: 'upperarm',
      ForeArm: 'lowerarm',
      Hand: 'hand',
      UpLeg: 'thigh',
      Leg: 'calf',
      Foot: 'foot',
      ToeBase: 'ball',
    };
    return unreal[part] + (side ? `_${side[0].toLowerCase()}` : '');
  },
};

/** A taller skeleton in an A-pose, in centimetres. */
export function strangerRig(naming: keyof typeof NAMES): RigJoint[] {
  const name = NAMES[naming];
  const joints: RigJoint[] = [{ name: name('Hips'), parent: -1, offset: [0, 104, 0] }];
  const add = (parent: number, label: string, offset: Vector) => joints.push({ name: label, parent, offset }) - 1;
  const s0 = add(0, name('Spine'), [0, 9, -1]);
  const s1 = add(s0, name('Spine1'), [0, 14, 0]);
  const chest = add(s1, name('Spine2'), [0, 13, 1]);
  const neck = add(chest, name('Neck'), [0, 15, -1]);
  add(neck, name('Head'), [0, 11, 2]);
  for (const side of ['Left', 'Right'] as const) {
    const x = side === 'Left' ? 1 : -1;
    const collar = add(chest, name('Shoulder', side), [6 * x, 11, 0]);
    const arm = add(collar, name('Arm', side), [12 * x, 1, -1]);
    const elbow = add(arm, name('ForeArm', side), [20 * x, -20, -1]);
    add(elbow, name('Hand', side), [17 * x, -18, 4]);
    const hip = add(0, name('UpLeg', side), [9 * x, -5, 0]);
    const knee = add(hip, name('Leg', side), [1 * x, -46, 1]);
    const ankle = add(knee, name('Foot', side), [0, -45, -3]);
    add(ankle, name('ToeBase', side), [1 * x, -7, 14]);
  }
  return joints;
}

/** A whole skeleton turned in its rest pose: another axis up, or another way to face. */
export const turnedRig = (rig: readonly RigJoint[], turn: readonly number[]): RigJoint[] =>
  rig.map((joint) => ({ ...joint, offset: rotateVector(turn, joint.offset) as unknown as Vector }));

/** World rotations and positions of a skeleton whose rest rotations are all zero. */
export function rigWorld(rig: readonly RigJoint[], local: readonly (readonly number[])[]) {
  const rotations: number[][] = [];
  const positions: number[][] = [];
  rig.forEach(({ parent, offset }, i) => {
    const above = parent < 0 ? [0, 0, 0, 1] : rotations[parent];
    rotations.push(multiply(above, local[i]));
    const from = parent < 0 ? [0, 0, 0] : positions[parent];
    const way = parent < 0 ? [...offset] : rotateVector(above, offset);
    positions.push(from.map((value, k) => value + way[k]));
  });
  return { rotations, positions };
}

const DEGREES = 180 / Math.PI;

/** Euler angles Z, X, Y (R = Rz Rx Ry), degrees. */
export function zxy(q: readonly number[]): [number, number, number] {
  const [x, y, z] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ].map((axis) => rotateVector(q, axis));
  // Columns x, y, z: m[row][column].
  const rx = Math.asin(Math.min(1, Math.max(-1, y[2])));
  return [Math.atan2(-y[0], y[1]) * DEGREES, rx * DEGREES, Math.atan2(-x[2], z[2]) * DEGREES];
}

/** A BVH file; each frame holds a local quaternion per joint. */
export function bvhText(
  rig: readonly RigJoint[],
  frames: readonly (readonly (readonly number[])[])[],
  seconds = 1 / 60,
): string {
  const order: number[] = [];
  const write = (joint: number, indent: string): string => {
    order.push(joint);
    const { name, parent, offset } = rig[joint];
    const children = [...rig.keys()].filter((each) => rig[each].parent === joint);
    const channels =
      parent < 0
        ? 'CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation'
        : 'CHANNELS 3 Zrotation Xrotation Yrotation';
    const inside = children.length
      ? children.map((child) => write(child, `${indent}\t`)).join('')
      : `${indent}\tEnd Site\n${indent}\t{\n${indent}\t\tOFFSET 0 1 0\n${indent}\t}\n`;
    return `${indent}${parent < 0 ? 'ROOT' : 'JOINT'} ${name}\n${indent}{\n${indent}\tOFFSET ${offset.join(' ')}\n${indent}\t${channels}\n${inside}${indent}}\n`;
  };
  const hierarchy = write(0, '');
  const lines = frames.map((frame) =>
    order.map((joint) => [...(joint === 0 ? [0, 0, 0] : []), ...zxy(frame[joint])].join(' ')).join(' '),
  );
  return `HIERARCHY\n${hierarchy}MOTION\nFrames: ${frames.length}\nFrame Time: ${seconds}\n${lines.join('\n')}\n`;
}

/** Turns of all joints that look like dancing, the same for the same seed. */
export function wildPose(rig: readonly RigJoint[], seed: number): number[][] {
  let state = seed * 7919 + 1;
  const random = () => {
    state = (state * 16807) % 2147483647;
    return (state / 2147483647) * 2 - 1;
  };
  return rig.map(() => axisAngleToQuaternion([random() * 0.7, random() * 0.7, random() * 0.7]));
}

/** The bytes of a .npy file. */
export function npy(
  values: readonly number[],
  shape: readonly number[],
  { type = '<f8', fortran = false }: { type?: '<f4' | '<f8' | '>f4' | '<i8'; fortran?: boolean } = {},
): Uint8Array {
  const tuple = `(${shape.join(', ')}${shape.length === 1 ? ',' : ''})`;
  let header = `{'descr': '${type}', 'fortran_order': ${fortran ? 'True' : 'False'}, 'shape': ${tuple}, }`;
  header += `${' '.repeat(63 - ((10 + header.length) % 64))}\n`;
  const width = type.endsWith('4') ? 4 : 8;
  const bytes = new Uint8Array(10 + header.length + values.length * width);
  const view = new DataView(bytes.buffer);
  bytes.set([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0]);
  view.setUint16(8, header.length, true);
  bytes.set(new TextEncoder().encode(header), 10);
  values.forEach((value, i) => {
    const at = 10 + header.length + i * width;
    if (type === '<i8') view.setBigInt64(at, BigInt(value), true);
    else if (width === 4) view.setFloat32(at, value, type[0] === '<');
    else view.setFloat64(at, value, true);
  });
  return bytes;
}
