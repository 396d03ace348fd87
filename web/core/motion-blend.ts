/** Turning one dance and going over from one to another. */
import { smoothstep } from './interpolate';
import { aboutY } from './localframe';
import { multiply, rotateVector, slerp } from './rotation';
import { copyFrames } from './motion';
import { JOINT_COUNT } from './skeleton';
import type { Motion } from './types';

const POSE = JOINT_COUNT * 4;
/** Frames at each end of a range made anew over which it goes over into the dance around it. */
const RANGE_BLEND = 12;

/** A dance turned about Y, with the root of one frame brought to x = z = 0. */
export function turned(motion: Motion, angle: number, pivot: number): Motion {
  const turn = aboutY(angle);
  const [x, z] = [motion.root[pivot * 3], motion.root[pivot * 3 + 2]];
  for (let t = 0; t < motion.frames; t++) {
    const pelvis = motion.quaternions.subarray(t * POSE, t * POSE + 4);
    multiply(turn, pelvis, pelvis);
    const root = motion.root.subarray(t * 3, t * 3 + 3);
    rotateVector(turn, [root[0] - x, root[1], root[2] - z], root);
  }
  return motion;
}

/** Goes over from what is in `target` to `source` within `frames` frames. */
export function blendInto(source: Motion, at: number, target: Motion, start: number, frames: number): void {
  for (let i = 0; i < frames; i++) {
    mixFrame(target, start + i, source, at + i, smoothstep((i + 1) / (frames + 1)));
  }
}

/** Moves one frame of `target` by `share` towards a frame of `source`. */
function mixFrame(target: Motion, t: number, source: Motion, s: number, share: number): void {
  for (let k = 0; k < 3; k++) {
    target.root[t * 3 + k] += share * (source.root[s * 3 + k] - target.root[t * 3 + k]);
  }
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const a = (t * JOINT_COUNT + joint) * 4;
    const b = (s * JOINT_COUNT + joint) * 4;
    const q = target.quaternions.subarray(a, a + 4);
    slerp(q, source.quaternions.subarray(b, b + 4), share, q);
  }
}

/**
 * Blends a range into the dance around it; its way over the floor is brought to where the old dance goes on.
 * @param made the new dance, changed in place; only its frames [from, to) are new
 * @param previous the dance before, equally long
 */
export function joinRange(made: Motion, previous: Motion, from: number, to: number): void {
  const blend = Math.min(RANGE_BLEND, Math.floor((to - from) / 3));
  if (to < previous.frames) {
    const missing = [0, 2].map((k) => previous.root[to * 3 + k] - made.root[(to - 1) * 3 + k]);
    const step = [0, 2].map((k) => previous.root[to * 3 + k] - previous.root[(to - 1) * 3 + k]);
    for (let t = from; t < to; t++) {
      const share = smoothstep((t - from + 1) / (to - from));
      made.root[t * 3] += share * (missing[0] - step[0]);
      made.root[t * 3 + 2] += share * (missing[1] - step[1]);
    }
    copyFrames(previous, to, previous.frames, made, to);
  }
  for (let i = 0; i < blend; i++) {
    const share = 1 - smoothstep((i + 1) / (blend + 1));
    if (from > 0) mixFrame(made, from + i, previous, from + i, share);
    if (to < previous.frames) mixFrame(made, to - 1 - i, previous, to - 1 - i, share);
  }
}
