/** Measures of a dance: paper A's eq. 13 and 16, its beat hit rate, and what they leave out (jerk, foot skate). */
import { keysOnFrames } from './correction';
import { quaternionsToSixD } from './rotation';
import { forwardKinematics, JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { KeyPose, Motion } from './types';

const POSE = JOINT_COUNT * 4;

/** World joint positions of every frame: frames x 24 x 3, metres. With `rootRemoved` the pelvis stays at the origin. */
export function jointPositions(motion: Motion, rootRemoved = false): Float32Array {
  const positions = new Float32Array(motion.frames * JOINT_COUNT * 3);
  for (let t = 0; t < motion.frames; t++) {
    const root = rootRemoved ? [0, 0, 0] : motion.root.subarray(t * 3, t * 3 + 3);
    const out = positions.subarray(t * JOINT_COUNT * 3, (t + 1) * JOINT_COUNT * 3);
    forwardKinematics(motion.quaternions.subarray(t * POSE, t * POSE + POSE), root, out);
  }
  return positions;
}

/** A dance as the network's numbers: frames x 147 (24 x 6D, then root x y z). */
function motionRows(motion: Motion): Float32Array {
  const { motionSize, rotationSize } = spec.model;
  const rows = new Float32Array(motion.frames * motionSize);
  for (let t = 0; t < motion.frames; t++) {
    quaternionsToSixD(
      motion.quaternions.subarray(t * POSE, t * POSE + POSE),
      rows.subarray(t * motionSize, t * motionSize + rotationSize),
    );
    rows.set(motion.root.subarray(t * 3, t * 3 + 3), t * motionSize + rotationSize);
  }
  return rows;
}

/**
 * Consistency error (paper A, eq. 13): squared distance over the 144 rotation numbers at each key's frame, mean over the keys.
 * @returns 0 = every key is hit; NaN without keys inside the dance
 */
export function consistencyError(motion: Motion, keyPoses: readonly KeyPose[]): number {
  const keys = keysOnFrames(keyPoses, motion.fps, motion.frames);
  let sum = 0;
  for (const key of keys) {
    const now = quaternionsToSixD(motion.quaternions.subarray(key.frame * POSE, key.frame * POSE + POSE));
    const wanted = quaternionsToSixD(key.quaternions);
    for (let i = 0; i < now.length; i++) sum += (now[i] - wanted[i]) ** 2;
  }
  return keys.length ? sum / keys.length : NaN;
}

/**
 * Smoothness (paper A, eq. 16): standard deviation over |mean| of the frame-to-frame differences of all 147 numbers.
 * The mean is near zero, so the value swings widely: read `meanJerk` beside it.
 */
export function smoothness(motion: Motion): number {
  const rows = motionRows(motion);
  const size = spec.model.motionSize;
  const count = rows.length - size;
  if (count <= 0) return NaN;
  let sum = 0;
  for (let i = size; i < rows.length; i++) sum += rows[i] - rows[i - size];
  const mean = sum / count;
  let square = 0;
  for (let i = size; i < rows.length; i++) square += (rows[i] - rows[i - size] - mean) ** 2;
  return Math.sqrt(square / count) / Math.abs(mean);
}

/**
 * Length of the third difference of each joint's position, mean over the joints: one value for each frame but the first three, m/s^3.
 * @param world with the pelvis's own way included; else root-aligned
 */
export function jerkPerFrame(motion: Motion, world = false): Float32Array {
  const p = jointPositions(motion, !world);
  const size = JOINT_COUNT * 3;
  const jerk = new Float32Array(Math.max(0, motion.frames - 3));
  for (let t = 0; t < jerk.length; t++) {
    for (let joint = 0; joint < size; joint += 3) {
      let square = 0;
      for (let k = joint; k < joint + 3; k++) {
        const i = t * size + k;
        square += (p[i + 3 * size] - 3 * p[i + 2 * size] + 3 * p[i + size] - p[i]) ** 2;
      }
      jerk[t] += (Math.sqrt(square) * motion.fps ** 3) / JOINT_COUNT;
    }
  }
  return jerk;
}

/** Mean root-aligned jerk over frames and joints, m/s^3 (read it relative to real dance); NaN for fewer than four frames. */
export function meanJerk(motion: Motion): number {
  const jerk = jerkPerFrame(motion);
  return jerk.length ? jerk.reduce((sum, value) => sum + value, 0) / jerk.length : NaN;
}

/** Mean joint speed between each frame and the next with the pelvis held still, m/s: frames - 1 values. */
export function jointSpeed(motion: Motion): Float32Array {
  const p = jointPositions(motion, true);
  const size = JOINT_COUNT * 3;
  const speed = new Float32Array(Math.max(0, motion.frames - 1));
  for (let t = 0; t < speed.length; t++) {
    for (let i = t * size; i < (t + 1) * size; i += 3) {
      speed[t] += Math.hypot(p[i + size] - p[i], p[i + size + 1] - p[i + 1], p[i + size + 2] - p[i + 2]);
    }
    speed[t] *= motion.fps / JOINT_COUNT;
  }
  return speed;
}

/**
 * Motion beats: seconds of the local minima of the mean joint speed.
 * @param extrema with the maxima too: paper A says "local extrema" (section 4.2.4), paper B minima
 */
export function motionBeats(motion: Motion, extrema = false): number[] {
  const speed = jointSpeed(motion);
  const beats: number[] = [];
  for (let i = 1; i + 1 < speed.length; i++) {
    const low = speed[i] < speed[i - 1] && speed[i] <= speed[i + 1];
    const high = speed[i] > speed[i - 1] && speed[i] >= speed[i + 1];
    // speed[i] is the speed between frames i and i + 1, so the turning point lies halfway between them.
    if (low || (extrema && high)) beats.push((i + 0.5) / motion.fps);
  }
  return beats;
}

/**
 * Share of the musical beats that have a motion beat within +- delta frames (paper A, section 4.2.1).
 * @param beats seconds; those outside the dance do not count
 * @returns 0..1; NaN without beats
 */
export function beatHitRate(motion: Motion, beats: readonly number[], delta: number): number {
  const moves = motionBeats(motion);
  const tolerance = delta / motion.fps + 1e-6;
  const inside = beats.filter((beat) => beat >= 0 && beat * motion.fps < motion.frames);
  const hits = inside.filter((beat) => moves.some((move) => Math.abs(move - beat) <= tolerance)).length;
  return inside.length ? hits / inside.length : NaN;
}

/** Toes lower than this above their rest height count as on the floor, metres. */
const NEAR_FLOOR = 0.03;

/** Foot skate: mean horizontal speed of the toe joints while they are within 3 cm of their rest height, m/s; NaN if they never are. */
export function footSkate(motion: Motion): number {
  const p = jointPositions(motion);
  const { feet, toeHeight } = spec.skeleton;
  let sum = 0;
  let count = 0;
  for (const { toe } of [feet.left, feet.right]) {
    for (let t = 1; t < motion.frames; t++) {
      const now = (t * JOINT_COUNT + toe) * 3;
      const before = now - JOINT_COUNT * 3;
      if (p[now + 1] >= toeHeight + NEAR_FLOOR) continue;
      sum += Math.hypot(p[now] - p[before], p[now + 2] - p[before + 2]) * motion.fps;
      count++;
    }
  }
  return count ? sum / count : NaN;
}
