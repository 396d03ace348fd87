/** Joints turn no faster than joints of dancers do: where the network's 6D numbers pass near zero, a rotation can flip between two frames. */
import { smoothstep } from './interpolate';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import { angleBetween, slerp } from './rotation';
import type { Motion } from './types';

/** Radians a frame. No joint of the AIST++ clips trained on turns by 30 degrees in a frame, and one in 30,000 by more than 25. */
export const FASTEST = ((25 / 180) * Math.PI * 30) / spec.fps;
/** A jump is spread at least this wide, standard deviation in frames. */
const LEAST_SPREAD = 1.5;
/** Standard deviations to each side of a jump that it is spread over, and the part of them that is wholly smoothed. */
const REACH = 3;
const WHOLE = 1.5;
/** Jumps that are spread in one joint at most, times the frames that could have one. */
const MOST_JUMPS = 0.5;

/**
 * Spreads turns that no joint makes over the frames around them, in place: there the joint follows the Gaussian mean of its rotations
 * instead. Joints without such a turn, and frames that are far from one, stay as they are.
 * @param fastest radians a frame
 */
export function limitTurns(motion: Motion, fastest = FASTEST): void {
  for (let joint = 0; joint < JOINT_COUNT; joint++) limitJoint(motion, joint, fastest);
}

function limitJoint({ quaternions, frames }: Motion, joint: number, fastest: number): void {
  const at = (frame: number) =>
    quaternions.subarray((frame * JOINT_COUNT + joint) * 4, (frame * JOINT_COUNT + joint) * 4 + 4);
  const steps = new Float64Array(frames);
  const measure = (from: number, to: number) => {
    for (let t = Math.max(1, from); t <= Math.min(frames - 1, to); t++) steps[t] = angleBetween(at(t), at(t - 1));
  };
  measure(1, frames - 1);
  for (let left = Math.ceil(frames * MOST_JUMPS); left > 0; left--) {
    let jump = 0;
    for (let t = 1; t < frames; t++) if (steps[t] > steps[jump]) jump = t;
    if (steps[jump] <= fastest) return;
    const spread = Math.max(LEAST_SPREAD, steps[jump] / fastest);
    const [from, to] = smoothAround(at, frames, jump - 0.5, spread);
    measure(from, to + 1);
  }
}

/** Smooths a joint around a moment between two frames. Returns the first and the last frame that changed. */
function smoothAround(
  at: (frame: number) => Float32Array,
  frames: number,
  centre: number,
  spread: number,
): [number, number] {
  const reach = REACH * spread;
  const from = Math.max(0, Math.ceil(centre - reach));
  const to = Math.min(frames - 1, Math.floor(centre + reach));
  const radius = Math.ceil(2 * spread);
  const smooth: number[][] = [];
  for (let t = from; t <= to; t++) smooth.push(meanAround(at, frames, t, radius, spread));
  for (let t = from; t <= to; t++) {
    const off = Math.abs(t - centre) / spread;
    const weight = 1 - smoothstep((off - WHOLE) / (REACH - WHOLE));
    slerp(at(t), smooth[t - from], weight, at(t));
  }
  return [from, to];
}

/** Mean of a joint's rotations around a frame, [x y z w]; past the ends of the dance the first and the last one go on. */
function meanAround(
  at: (frame: number) => Float32Array,
  frames: number,
  t: number,
  radius: number,
  spread: number,
): number[] {
  const sum = [0, 0, 0, 0];
  for (const direction of [-1, 1]) {
    // Each is told from its neighbour, so that the mean goes the way that the joint went.
    let before = Array.from(at(t));
    for (let i = direction < 0 ? 1 : 0; i <= radius; i++) {
      const q = at(Math.min(frames - 1, Math.max(0, t + direction * i)));
      const sign = before[0] * q[0] + before[1] * q[1] + before[2] * q[2] + before[3] * q[3] < 0 ? -1 : 1;
      before = Array.from(q, (value) => value * sign);
      const weight = Math.exp((-i * i) / (2 * spread * spread));
      for (let c = 0; c < 4; c++) sum[c] += weight * before[c];
    }
  }
  const length = Math.hypot(...sum);
  // Rotations all around have no mean: there is nothing better than what was.
  return length > 1e-6 ? sum.map((value) => value / length) : Array.from(at(t));
}
