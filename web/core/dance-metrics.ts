/**
 * Measures that compare dances: paper B's NPSS, PFD, VFD, PVar and BC (section 5.2), and the longest freeze. The same definitions stand
 * in export/dance_metrics.py, where what paper B leaves open is settled the same way.
 */
import { aboutY, headingOf } from './localframe';
import { jointPositions, jointSpeed, motionBeats } from './metrics';
import { rotateVector } from './rotation';
import { JOINT_COUNT } from './skeleton';
import { eigenSymmetric, product, squareRoot } from './symmetric';
import type { Motion } from './types';

const POSE = JOINT_COUNT * 4;
/** Numbers of a pose without the pelvis, which is always at the origin. */
const LIMBS = (JOINT_COUNT - 1) * 3;
/** Width of the Gaussian of BC, seconds: 3 frames at 60 a second, as in the Beat Alignment Score that it starts from. */
const BEAT_SIGMA = 0.05;
/** A body whose joints move slower than this on average stands still to the eye, m/s. */
const FREEZE_SPEED = 0.05;

/**
 * Longest stretch over which the mean joint speed (pelvis held still) stays below a threshold.
 * @param threshold m/s
 * @returns seconds
 */
export function longestFreeze(motion: Motion, threshold = FREEZE_SPEED): number {
  let longest = 0;
  let run = 0;
  for (const speed of jointSpeed(motion)) {
    run = speed < threshold ? run + 1 : 0;
    longest = Math.max(longest, run);
  }
  return longest / motion.fps;
}

/**
 * Beat consistency score BC (paper B, eq. 1): mean over the musical beats of exp(-d^2 / 2 sigma^2), d to the nearest motion beat.
 * @param beats seconds; those outside the dance do not count
 * @returns 0..1; NaN without beats
 */
export function beatConsistency(motion: Motion, beats: readonly number[]): number {
  const inside = beats.filter((beat) => beat >= 0 && beat * motion.fps < motion.frames);
  if (!inside.length) return NaN;
  const moves = motionBeats(motion);
  const score = (beat: number) => {
    const distance = Math.min(...moves.map((move) => Math.abs(move - beat)));
    return Math.exp(-(distance ** 2) / (2 * BEAT_SIGMA ** 2));
  };
  return inside.reduce((sum, beat) => sum + score(beat), 0) / inside.length;
}

/** Vectors as the body itself sees them: each frame's joints turned back by its heading, pelvis left out; frames x 69. */
function seenByBody(vectors: Float32Array, motion: Motion, frames: number): Float64Array {
  const seen = new Float64Array(frames * LIMBS);
  for (let t = 0; t < frames; t++) {
    const back = aboutY(-headingOf(motion.quaternions.subarray(t * POSE, t * POSE + 4)));
    for (let joint = 1; joint < JOINT_COUNT; joint++) {
      const at = (t * JOINT_COUNT + joint) * 3;
      seen.set(rotateVector(back, vectors.subarray(at, at + 3)), t * LIMBS + (joint - 1) * 3);
    }
  }
  return seen;
}

/**
 * PFD: Frechet distance between the poses of two dances (joint positions as seen by the body), m^2.
 * @returns 0 = the same poses equally often
 */
export function poseFrechet(a: Motion, b: Motion): number {
  const [x, y] = [a, b].map((motion) => seenByBody(jointPositions(motion, true), motion, motion.frames));
  return frechetDistance(x, y, LIMBS);
}

/** VFD: Frechet distance between the joint velocities of two dances (relative to the pelvis, as seen by the body), (m/s)^2. */
export function velocityFrechet(a: Motion, b: Motion): number {
  const [x, y] = [a, b].map((motion) => {
    const positions = jointPositions(motion, true);
    const row = JOINT_COUNT * 3;
    const velocities = positions.subarray(row).map((value, i) => (value - positions[i]) * motion.fps);
    return seenByBody(velocities, motion, motion.frames - 1);
  });
  return frechetDistance(x, y, LIMBS);
}

/**
 * Frechet distance of two sets of vectors, each taken as a Gaussian (population covariance):
 * |mean_a - mean_b|^2 + tr(A + B - 2 (A^1/2 B A^1/2)^1/2).
 * @param a rows of `size` numbers
 */
export function frechetDistance(a: Float64Array, b: Float64Array, size: number): number {
  const [p, q] = [gaussian(a, size), gaussian(b, size)];
  const root = squareRoot(p.covariance, size);
  const { values } = eigenSymmetric(product(product(root, q.covariance, size), root, size), size);
  let distance = 0;
  for (let i = 0; i < size; i++) {
    distance += (p.mean[i] - q.mean[i]) ** 2 + p.covariance[i * size + i] + q.covariance[i * size + i];
    distance -= 2 * Math.sqrt(Math.max(0, values[i]));
  }
  return Math.max(0, distance);
}

function gaussian(rows: Float64Array, size: number): { mean: Float64Array; covariance: Float64Array } {
  const count = rows.length / size;
  const mean = new Float64Array(size);
  for (let i = 0; i < rows.length; i++) mean[i % size] += rows[i] / count;
  const covariance = new Float64Array(size * size);
  const centred = new Float64Array(size);
  for (let t = 0; t < count; t++) {
    for (let i = 0; i < size; i++) centred[i] = rows[t * size + i] - mean[i];
    for (let i = 0; i < size; i++) {
      for (let j = 0; j <= i; j++) covariance[i * size + j] += (centred[i] * centred[j]) / count;
    }
  }
  for (let i = 0; i < size; i++) for (let j = 0; j < i; j++) covariance[j * size + i] = covariance[i * size + j];
  return { mean, covariance };
}

/**
 * PVar: variance over dances of each joint's root-aligned position (x, y, z added; population variance), mean over frames and joints.
 * @param dances of one length (longer ones count up to the shortest)
 * @returns m^2; NaN for fewer than two dances
 */
export function positionVariance(dances: readonly Motion[]): number {
  if (dances.length < 2) return NaN;
  const frames = Math.min(...dances.map((dance) => dance.frames));
  const positions = dances.map((dance) => jointPositions(dance, true));
  const numbers = frames * JOINT_COUNT * 3;
  let sum = 0;
  for (let i = 0; i < numbers; i++) {
    const mean = positions.reduce((total, values) => total + values[i], 0) / dances.length;
    sum += positions.reduce((total, values) => total + (values[i] - mean) ** 2, 0) / dances.length;
  }
  return sum / (frames * JOINT_COUNT);
}

/**
 * NPSS (Gopalakrishnan et al. 2019) of two dances of one length: how differently their power is spread over frequencies, over 24
 * quaternions and 24 root-aligned positions, weighted by the real power. The time it takes grows with the square of the length: compare windows.
 * @returns 0 = the same spectrum
 * @throws Error when the lengths differ
 */
export function npss(real: Motion, made: Motion): number {
  if (real.frames !== made.frames) {
    throw new Error(`NPSS compares dances of one length, but these have ${real.frames} and ${made.frames} frames.`);
  }
  return spectralDistance(powerValues(real), powerValues(made), POSE + JOINT_COUNT * 3);
}

/**
 * NPSS of two sequences of numbers.
 * @param real rows of `size` numbers
 * @param made as many rows
 */
export function spectralDistance(real: Float64Array, made: Float64Array, size: number): number {
  const frames = real.length / size;
  let weighted = 0;
  let total = 0;
  for (let column = 0; column < size; column++) {
    const [a, b] = [real, made].map((values) => powerSpectrum(values, column, size, frames));
    const power = a.reduce((sum, value) => sum + value, 0);
    weighted += spectrumDistance(a, b) * power;
    total += power;
  }
  return weighted / Math.max(total, 1e-12);
}

/** What NPSS is taken over: quaternions (signs continuous, first w >= 0), then root-aligned positions; frames x 168. */
function powerValues(motion: Motion): Float64Array {
  const size = POSE + JOINT_COUNT * 3;
  const values = new Float64Array(motion.frames * size);
  const positions = jointPositions(motion, true);
  for (let t = 0; t < motion.frames; t++) {
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const at = t * size + joint * 4;
      const q = motion.quaternions.subarray(t * POSE + joint * 4, t * POSE + joint * 4 + 4);
      const before = t > 0 ? values.subarray(at - size, at - size + 4) : [0, 0, 0, 1];
      const sign = q[0] * before[0] + q[1] * before[1] + q[2] * before[2] + q[3] * before[3] < 0 ? -1 : 1;
      for (let k = 0; k < 4; k++) values[at + k] = sign * q[k];
    }
    const row = JOINT_COUNT * 3;
    values.set(positions.subarray(t * row, (t + 1) * row), t * size + POSE);
  }
  return values;
}

/** Power of all n bins of one column's Fourier transform; songs' windows are no powers of two, so it is summed plainly. */
function powerSpectrum(values: Float64Array, column: number, size: number, n: number): Float64Array {
  const power = new Float64Array(n);
  const cosine = Float64Array.from({ length: n }, (_, i) => Math.cos((2 * Math.PI * i) / n));
  const sine = Float64Array.from({ length: n }, (_, i) => Math.sin((2 * Math.PI * i) / n));
  // Real values: bins k and n - k have the same power.
  for (let k = 0; k <= n / 2; k++) {
    let [re, im] = [0, 0];
    for (let t = 0; t < n; t++) {
      const value = values[t * size + column];
      re += value * cosine[(k * t) % n];
      im -= value * sine[(k * t) % n];
    }
    power[k] = re * re + im * im;
    if (k > 0) power[n - k] = power[k];
  }
  return power;
}

/** Earth mover's distance, in bins, between two spectra that are normalised to 1. */
function spectrumDistance(a: Float64Array, b: Float64Array): number {
  const [sumA, sumB] = [a, b].map((power) =>
    Math.max(
      power.reduce((sum, v) => sum + v, 0),
      1e-12,
    ),
  );
  let distance = 0;
  let ahead = 0;
  for (let k = 0; k < a.length; k++) {
    ahead += a[k] / sumA - b[k] / sumB;
    distance += Math.abs(ahead);
  }
  return distance;
}
