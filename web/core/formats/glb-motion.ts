/** A dance as animation samplers for a GLB file. */
import { alignSigns } from '../motion';
import { JOINT_COUNT } from '../skeleton';
import type { Motion } from '../types';
import type { GlbSampler } from './glb-write';

/** Rotations that never leave the first by more than this are one key. */
const STILL = 1e-6;

/** Frame times in seconds, counted from the dance's first frame. */
export function frameTimes({ frames, fps }: Pick<Motion, 'frames' | 'fps'>): Float32Array {
  return Float32Array.from({ length: frames }, (_, frame) => frame / fps);
}

/**
 * One key per frame, LINEAR (for rotations that is SLERP): the pelvis's place, and every joint's rotation; a joint that keeps still has
 * one key. Neighbouring quaternions have the same sign, so that readers that interpolate them number by number do well too.
 * @throws Error when the dance has no frames
 */
export function motionSamplers(motion: Motion, times: Float32Array = frameTimes(motion)): GlbSampler[] {
  if (motion.frames < 1) throw new Error('The dance has no frames yet: generate it first.');
  const { quaternions } = alignSigns({ ...motion, quaternions: motion.quaternions.slice() });
  const samplers: GlbSampler[] = [
    { joint: 0, path: 'translation', times, values: motion.root.slice(), interpolation: 'LINEAR' },
  ];
  const once = new Float32Array(1);
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const values = column(quaternions, motion.frames, joint);
    const still = isStill(values);
    samplers.push({
      joint,
      path: 'rotation',
      times: still ? once : times,
      values: still ? values.slice(0, 4) : values,
      interpolation: 'LINEAR',
    });
  }
  return samplers;
}

/** One joint's unit quaternions out of all. */
function column(quaternions: Float32Array, frames: number, joint: number): Float32Array {
  const out = new Float32Array(frames * 4);
  for (let frame = 0; frame < frames; frame++) {
    const from = (frame * JOINT_COUNT + joint) * 4;
    const q = quaternions.subarray(from, from + 4);
    const length = Math.hypot(q[0], q[1], q[2], q[3]) || 1;
    for (let k = 0; k < 4; k++) out[frame * 4 + k] = q[k] / length;
  }
  return out;
}

/** True when every key is the first one. */
export function isStill(values: ArrayLike<number>): boolean {
  for (let i = 4; i < values.length; i++) if (Math.abs(values[i] - values[i % 4]) > STILL) return false;
  return true;
}
