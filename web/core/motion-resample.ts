/** A dance at another frame rate. */
import { emptyMotion, framePose } from './motion';
import type { Motion } from './types';

/**
 * The same dance at another frame rate: rotations by SLERP, the root linearly. The first frame stays the first; the last one stays the
 * last where the new rate has a frame at its time (30 to 60 or 120), else the dance ends less than a frame earlier.
 * @param fps frames per second, above 0
 * @throws Error when the rate is none or the dance has no frames
 */
export function resampleMotion(motion: Motion, fps: number): Motion {
  if (!(fps > 0 && fps <= 1000)) throw new Error('The frame rate must be a number from above 0 to 1000.');
  if (motion.frames < 1) throw new Error('The dance has no frames yet: generate it first.');
  if (fps === motion.fps) return motion;
  // Rounding must not cost the last frame.
  const frames = Math.floor(((motion.frames - 1) / motion.fps) * fps + 1e-6) + 1;
  const out = { ...emptyMotion(frames), fps };
  const pose = { root: new Float32Array(3), quaternions: new Float32Array(96) };
  for (let frame = 0; frame < frames; frame++) {
    framePose(motion, frame / fps, pose);
    out.root.set(pose.root, frame * 3);
    out.quaternions.set(pose.quaternions, frame * 96);
  }
  return out;
}
