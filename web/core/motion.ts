/** A dance as arrays: making, cutting, sampling and converting it. */
import { quaternionToAxisAngle, slerp } from './rotation';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { FramePose, Motion } from './types';

const POSE = JOINT_COUNT * 4;

/** `frames` frames in the T-pose at the origin, at the spec's rate. */
export function emptyMotion(frames: number): Motion {
  const quaternions = new Float32Array(frames * POSE);
  for (let w = 3; w < quaternions.length; w += 4) quaternions[w] = 1;
  return { fps: spec.fps, frames, root: new Float32Array(frames * 3), quaternions };
}

/** A copy of frames [from, to); both are clamped to the dance. */
export function sliceMotion(motion: Motion, from: number, to: number = motion.frames): Motion {
  const start = Math.min(Math.max(0, Math.round(from)), motion.frames);
  const end = Math.min(Math.max(start, Math.round(to)), motion.frames);
  return {
    fps: motion.fps,
    frames: end - start,
    root: motion.root.slice(start * 3, end * 3),
    quaternions: motion.quaternions.slice(start * POSE, end * POSE),
  };
}

/** Copies frames [from, to) of `source` into `target`, starting at frame `at`. */
export function copyFrames(source: Motion, from: number, to: number, target: Motion, at: number): void {
  target.root.set(source.root.subarray(from * 3, to * 3), at * 3);
  target.quaternions.set(source.quaternions.subarray(from * POSE, to * POSE), at * POSE);
}

/** One frame as views into the dance's arrays: cheap, and changes with them. */
export function frameView(motion: Motion, frame: number): { root: Float32Array; quaternions: Float32Array } {
  return {
    root: motion.root.subarray(frame * 3, frame * 3 + 3),
    quaternions: motion.quaternions.subarray(frame * POSE, frame * POSE + POSE),
  };
}

/** A pose that `framePose` can write into. */
export interface MutableFramePose extends FramePose {
  root: Float32Array;
  quaternions: Float32Array;
}

/**
 * The pose at a time between frames: rotations by SLERP, the root linearly. Times outside the dance give its first or last frame.
 * @param seconds from the start of the dance
 * @param out reused when given, so that a player makes no garbage
 * @throws Error when the dance has no frames
 */
export function framePose(motion: Motion, seconds: number, out?: MutableFramePose): MutableFramePose {
  if (motion.frames < 1) throw new Error('The dance has no frames yet: generate it first.');
  const pose = out ?? { root: new Float32Array(3), quaternions: new Float32Array(POSE) };
  const position = Math.min(Math.max(0, (Number.isFinite(seconds) ? seconds : 0) * motion.fps), motion.frames - 1);
  const frame = Math.min(Math.floor(position), Math.max(0, motion.frames - 2));
  const next = Math.min(frame + 1, motion.frames - 1);
  const t = position - frame;
  for (let i = 0; i < 3; i++) pose.root[i] = (1 - t) * motion.root[frame * 3 + i] + t * motion.root[next * 3 + i];
  const { quaternions } = motion;
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const a = frame * POSE + joint * 4;
    const b = next * POSE + joint * 4;
    const target = pose.quaternions.subarray(joint * 4, joint * 4 + 4);
    slerp(quaternions.subarray(a, a + 4), quaternions.subarray(b, b + 4), t, target);
  }
  return pose;
}

/** The dance's rotations as axis-angle radians: frames x 72. */
export function motionToAxisAngle(motion: Motion): Float32Array {
  const rotations = new Float32Array(motion.frames * JOINT_COUNT * 3);
  for (let i = 0; i < motion.frames * JOINT_COUNT; i++) {
    quaternionToAxisAngle(motion.quaternions.subarray(i * 4, i * 4 + 4), rotations.subarray(i * 3, i * 3 + 3));
  }
  return rotations;
}

/** Gives each joint's quaternions the sign nearest to the frame before, so that plain interpolation never goes the long way round. */
export function alignSigns(motion: Motion): Motion {
  const q = motion.quaternions;
  for (let i = POSE; i < q.length; i += 4) {
    const dot =
      q[i] * q[i - POSE] + q[i + 1] * q[i - POSE + 1] + q[i + 2] * q[i - POSE + 2] + q[i + 3] * q[i - POSE + 3];
    if (dot < 0) for (let k = 0; k < 4; k++) q[i + k] = -q[i + k];
  }
  return motion;
}
