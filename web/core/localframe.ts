/** The frame a window is generated in: x, z of the root at the origin and heading +Z at the last seed frame; height is kept. */
import { emptyMotion } from './motion';
import { multiply, quaternionToSixD, rotateVector, sixDToQuaternion, type Numbers } from './rotation';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { Motion } from './types';

const { motionSize, rotationSize } = spec.model;

/** Where a window stands in the world. */
export interface LocalFrame {
  x: number;
  z: number;
  /** Angle about Y from local to world, radians. */
  heading: number;
}

/**
 * Direction that a pelvis faces on the floor: atan2(f.x, f.z) for f = R (0, 0, 1). Where f is nearly vertical (lying, or bent double)
 * the pelvis's up axis says it: f = -R (0, 1, 0) sign(f.y).
 * @param pelvis world rotation, x y z w
 * @returns radians; 0 faces +Z, positive turns to the left
 */
export function headingOf(pelvis: Numbers): number {
  let f = rotateVector(pelvis, [0, 0, 1]);
  if (Math.hypot(f[0], f[2]) < 0.1) {
    const sign = f[1] < 0 ? -1 : 1;
    f = Array.from(rotateVector(pelvis, [0, 1, 0]), (v) => -v * sign);
  }
  return Math.atan2(f[0], f[2]);
}

/** Rotation by an angle about Y as a quaternion. */
export function aboutY(angle: number): [number, number, number, number] {
  return [0, Math.sin(angle / 2), 0, Math.cos(angle / 2)];
}

/** The local frame that belongs to one frame of a dance. */
export function localFrameAt(motion: Motion, frame: number): LocalFrame {
  const q = motion.quaternions.subarray(frame * JOINT_COUNT * 4, frame * JOINT_COUNT * 4 + 4);
  return { x: motion.root[frame * 3], z: motion.root[frame * 3 + 2], heading: headingOf(q) };
}

/** A world pelvis rotation as seen in the local frame. */
export function pelvisToLocal(pelvis: Numbers, frame: LocalFrame): Numbers {
  return multiply(aboutY(-frame.heading), pelvis);
}

/** Frames [from, to) of a dance as network rows in the local frame: (to - from) x 147. */
export function toLocalRows(motion: Motion, from: number, to: number, frame: LocalFrame): Float32Array {
  const rows = new Float32Array((to - from) * motionSize);
  const back = aboutY(-frame.heading);
  const sixD = [0, 0, 0, 0, 0, 0];
  for (let t = from; t < to; t++) {
    const row = (t - from) * motionSize;
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const i = (t * JOINT_COUNT + joint) * 4;
      const q = motion.quaternions.subarray(i, i + 4);
      quaternionToSixD(joint === 0 ? multiply(back, q) : q, sixD);
      rows.set(sixD, row + joint * 6);
    }
    const root = [motion.root[t * 3] - frame.x, motion.root[t * 3 + 1], motion.root[t * 3 + 2] - frame.z];
    rows.set(Array.from(rotateVector(back, root)), row + rotationSize);
  }
  return rows;
}

/** Network rows (frames x 147, local frame) as a dance in the world. Rows that are not finite keep the frame before. */
export function fromLocalRows(rows: Float32Array, frame: LocalFrame): Motion {
  const motion = emptyMotion(Math.floor(rows.length / motionSize));
  const turn = aboutY(frame.heading);
  const q = [0, 0, 0, 1];
  for (let t = 0; t < motion.frames; t++) {
    const row = t * motionSize;
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      sixDToQuaternion(rows.subarray(row + joint * 6, row + joint * 6 + 6), q);
      if (joint === 0) multiply(turn, q, q);
      motion.quaternions.set(q, (t * JOINT_COUNT + joint) * 4);
    }
    const root = rotateVector(turn, rows.subarray(row + rotationSize, row + motionSize));
    const world = [root[0] + frame.x, root[1], root[2] + frame.z];
    motion.root.set(
      world.every(Number.isFinite) ? world : motion.root.subarray(Math.max(0, t - 1) * 3, Math.max(0, t - 1) * 3 + 3),
      t * 3,
    );
  }
  return motion;
}
