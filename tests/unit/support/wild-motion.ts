/** Dances for the tests of motion files: every joint through the whole of its turns, the pelvis all over the floor. */
import { emptyMotion } from '../../../web/core/motion';
import { axisAngleToQuaternion, multiply, slerp } from '../../../web/core/rotation';
import { forwardKinematics, JOINT_COUNT } from '../../../web/core/skeleton';
import type { Motion } from '../../../web/core/types';

/** Repeatable numbers in 0..1. */
export function noise(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** A random rotation, any axis and angle. */
export function anyTurn(random: () => number): number[] {
  const [u, v, w] = [random(), random() * 2 * Math.PI, random() * 2 * Math.PI];
  const [a, b] = [Math.sqrt(1 - u), Math.sqrt(u)];
  return [a * Math.sin(v), a * Math.cos(v), b * Math.sin(w), b * Math.cos(w)];
}

/**
 * A dance that is smooth between wild poses half a second apart; in some of them joints stand exactly where Euler angles lose one
 * (a quarter turn about Y).
 */
export function wildMotion(frames: number, seed: number, fps = 30): Motion {
  const random = noise(seed);
  const every = 15;
  const poses = Array.from({ length: Math.ceil(frames / every) + 1 }, () =>
    Array.from({ length: JOINT_COUNT }, () => {
      if (random() < 0.2) {
        const lock = axisAngleToQuaternion([0, random() < 0.5 ? Math.PI / 2 : -Math.PI / 2, 0]);
        return multiply(axisAngleToQuaternion([0, 0, random() * 6 - 3]), lock);
      }
      return anyTurn(random);
    }),
  );
  const places = poses.map(() => [random() * 6 - 3, 0.3 + random(), random() * 6 - 3]);
  const motion = emptyMotion(frames);
  motion.fps = fps;
  for (let t = 0; t < frames; t++) {
    const at = Math.floor(t / every);
    const part = (t % every) / every;
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      motion.quaternions.set(slerp(poses[at][joint], poses[at + 1][joint], part), (t * JOINT_COUNT + joint) * 4);
    }
    for (let k = 0; k < 3; k++) motion.root[t * 3 + k] = (1 - part) * places[at][k] + part * places[at + 1][k];
  }
  return motion;
}

/** Joint positions of a frame, 24 x 3. */
export function jointsOf({ quaternions, root }: Motion, frame: number): Float32Array {
  return forwardKinematics(
    quaternions.subarray(frame * JOINT_COUNT * 4, (frame + 1) * JOINT_COUNT * 4),
    root.subarray(frame * 3, frame * 3 + 3),
  );
}

/** The longest distance between two lists of points. */
export function farthest(a: ArrayLike<number>, b: ArrayLike<number>): number {
  let most = 0;
  for (let i = 0; i < a.length; i += 3) {
    most = Math.max(most, Math.hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  }
  return most;
}
