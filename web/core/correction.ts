/**
 * Exact key poses: what the network misses at a key is spread over the key's neighbourhood by a smooth bump in rotation space, scaled
 * by the key strength. A key belongs to the frame round(time x fps).
 */
import { bump } from './interpolate';
import { axisAngleToQuaternion, conjugate, multiply, poseToQuaternions, quaternionToAxisAngle } from './rotation';
import { JOINT_COUNT } from './skeleton';
import type { KeyPose, Motion } from './types';

/** A key pose on its frame. */
export interface FrameKey {
  frame: number;
  /** 24 x 4 local rotations. */
  quaternions: Float32Array;
  /** 0..1, times the dance's key strength; missing = 1. */
  strength?: number;
}

/** How firmly a key is hit, 0..1: the dial's key strength times the key's own. */
function effectiveStrength(dial: number, own: number | undefined): number {
  return Math.min(1, Math.max(0, dial * (own ?? 1)));
}

/** Seconds on each side of a key that its correction reaches at most; a large residual is given more room than a small one. */
const REACH = { small: 0.4, large: 0.7, largeAngle: Math.PI / 3 };

/**
 * Key poses on their frames, ascending. Keys outside the dance are dropped; of several on one frame the last counts.
 * @param frames length of the dance
 */
export function keysOnFrames(keyPoses: readonly KeyPose[], fps: number, frames: number): FrameKey[] {
  const byFrame = new Map<number, FrameKey>();
  for (const key of keyPoses) {
    const frame = Math.round(key.time * fps);
    // A key on the very last instant rounds to the frame after the last: it belongs to the last.
    const inside = frame === frames ? frames - 1 : frame;
    if (inside < 0 || inside >= frames) continue;
    const { strength } = key;
    const quaternions = poseToQuaternions(key.rotations);
    byFrame.set(inside, { frame: inside, quaternions, ...(strength === undefined ? {} : { strength }) });
  }
  return [...byFrame.values()].sort((a, b) => a.frame - b.frame);
}

/**
 * Moves a dance through its keys, in place. At strength 1 each key is hit exactly; the influence of a key is zero at its neighbours,
 * however weak they are.
 * @param keys ascending, one a frame
 * @param strength 0 = unchanged .. 1 = exact; times each key's own strength
 * @param within nothing outside these frames is touched, and the influence of keys fades out towards them
 */
export function correctToKeys(
  motion: Motion,
  keys: readonly FrameKey[],
  strength: number,
  within?: { from: number; to: number },
): void {
  if (strength <= 0) return;
  const first = within ? within.from - 1 : -Infinity;
  const last = within ? within.to : Infinity;
  // Residuals are taken before anything moves: since bumps vanish at the neighbours, the order then does not matter at a key.
  const residuals = keys.map((key) => residual(motion, key));
  keys.forEach((key, i) => {
    const reach = Math.max(2, Math.round(motion.fps * reachOf(residuals[i])));
    const before = Math.min(reach, i > 0 ? key.frame - keys[i - 1].frame : reach, key.frame - first);
    const after = Math.min(reach, i + 1 < keys.length ? keys[i + 1].frame - key.frame : reach, last - key.frame);
    spread(motion, key.frame, residuals[i], before, after, effectiveStrength(strength, key.strength));
  });
}

/** Rotation vectors, 24 x 3, that take the dance's pose at a key's frame to the key (in each joint's parent frame). */
function residual(motion: Motion, key: FrameKey): Float64Array {
  const vectors = new Float64Array(JOINT_COUNT * 3);
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const i = (key.frame * JOINT_COUNT + joint) * 4;
    const now = motion.quaternions.subarray(i, i + 4);
    const wanted = key.quaternions.subarray(joint * 4, joint * 4 + 4);
    const turn = multiply(wanted, conjugate(now));
    quaternionToAxisAngle(turn, vectors.subarray(joint * 3, joint * 3 + 3) as Float64Array);
  }
  return vectors;
}

function reachOf(vectors: Float64Array): number {
  let largest = 0;
  for (let i = 0; i < vectors.length; i += 3) {
    largest = Math.max(largest, Math.hypot(vectors[i], vectors[i + 1], vectors[i + 2]));
  }
  return REACH.small + (REACH.large - REACH.small) * Math.min(1, largest / REACH.largeAngle);
}

function spread(
  motion: Motion,
  frame: number,
  vectors: Float64Array,
  before: number,
  after: number,
  amount: number,
): void {
  if (amount === 0) return;
  const from = Math.max(0, frame - before);
  const to = Math.min(motion.frames - 1, frame + after);
  const turn = [0, 0, 0, 1];
  for (let t = from; t <= to; t++) {
    const weight = amount * bump(t < frame ? (frame - t) / before : t > frame ? (t - frame) / after : 0);
    if (weight === 0) continue;
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const i = (t * JOINT_COUNT + joint) * 4;
      const q = motion.quaternions.subarray(i, i + 4);
      const v = joint * 3;
      axisAngleToQuaternion([vectors[v] * weight, vectors[v + 1] * weight, vectors[v + 2] * weight], turn);
      multiply(turn, q, q);
    }
  }
}
