/**
 * Curves that follow a dance: knots by least squares, tension, continuity and bias as they are. With those fixed a curve is linear in
 * its knots, and a frame depends on four of them, so a channel is one banded system.
 */
import { CHANNELS, INNER_KNOTS, knotBefore, knotTimes, knotValues, rotationChannel, shapeOfKnot, unit } from './curves';
import type { CurveDance } from './curves';
import { JOINT_COUNT } from './skeleton';
import type { Motion } from './types';

/** A frame depends on the two knots before it and the two after it. */
const SUPPORT = 4;
/** Pull of a knot to where it was, against the frames' 1: only for knots that no frame speaks of. */
const STAY = 1e-4;
/** Channels that are nowhere farther off than this are left alone. */
const CLOSE = 1e-5;

/** Four weights a frame: how the curve at it depends on knots `first[t]` .. `first[t] + 3`. */
interface Basis {
  first: Int32Array;
  /** [frames, 4] */
  weights: Float64Array;
}

/** How a channel depends on its knots at frame times. */
function basisOf(
  curves: CurveDance,
  channel: number,
  times: Float64Array,
  from: number,
  to: number,
  fps: number,
): Basis {
  const knots = times.length;
  const first = new Int32Array(to - from);
  const weights = new Float64Array((to - from) * SUPPORT);
  /** Shares of the way before and after a knot in the velocity there: coming, then leaving. */
  const shares = (i: number): [number, number, number, number] => {
    const { tension, continuity, bias } = shapeOfKnot(curves, i, channel);
    const slack = 1 - tension;
    if (i === 0) return [0, 0, 0, slack / (times[1] - times[0])];
    if (i === knots - 1) return [slack / (times[i] - times[i - 1]), 0, 0, 0];
    const scale = slack / (times[i + 1] - times[i - 1]);
    const [more, less] = [1 + continuity, 1 - continuity];
    return [scale * less * (1 + bias), scale * more * (1 - bias), scale * more * (1 + bias), scale * less * (1 - bias)];
  };
  for (let t = from; t < to; t++) {
    const time = Math.min(Math.max(t / fps, times[0]), times[knots - 1]);
    const i = Math.max(0, knotBefore(times, time));
    const span = times[i + 1] - times[i];
    const s = (time - times[i]) / span;
    const [s2, s3] = [s * s, s * s * s];
    const leave = (s3 - 2 * s2 + s) * span;
    const come = (s3 - s2) * span;
    const [, , a, b] = shares(i);
    const [c, d] = shares(i + 1);
    const at = (t - from) * SUPPORT;
    first[t - from] = i - 1;
    weights[at] = -leave * a;
    weights[at + 1] = 2 * s3 - 3 * s2 + 1 + leave * (a - b) - come * c;
    weights[at + 2] = 3 * s2 - 2 * s3 + leave * b + come * (c - d);
    weights[at + 3] = come * d;
  }
  return { first, weights };
}

/**
 * Least squares for the knots of one channel.
 * @param rest what is missing at each frame
 * @param fixed knots that stay
 * @returns what to add to each knot
 */
function solveKnots({ first, weights }: Basis, rest: Float64Array, fixed: readonly boolean[]): Float64Array {
  const n = fixed.length;
  // Lower band of the symmetric normal equations: row i holds (i, i - 3) .. (i, i).
  const band = new Float64Array(n * SUPPORT);
  const right = new Float64Array(n);
  for (let t = 0; t < rest.length; t++) {
    for (let p = 0; p < SUPPORT; p++) {
      const i = first[t] + p;
      const w = weights[t * SUPPORT + p];
      if (w === 0 || fixed[i]) continue;
      right[i] += w * rest[t];
      for (let q = 0; q <= p; q++) {
        const j = first[t] + q;
        if (j >= 0 && !fixed[j]) band[i * SUPPORT + 3 - (p - q)] += w * weights[t * SUPPORT + q];
      }
    }
  }
  for (let i = 0; i < n; i++) band[i * SUPPORT + 3] += fixed[i] ? 1 : STAY;
  // Cholesky, in place.
  for (let i = 0; i < n; i++) {
    for (let j = Math.max(0, i - 3); j <= i; j++) {
      let sum = band[i * SUPPORT + 3 - (i - j)];
      for (let k = Math.max(0, i - 3, j - 3); k < j; k++) {
        sum -= band[i * SUPPORT + 3 - (i - k)] * band[j * SUPPORT + 3 - (j - k)];
      }
      band[i * SUPPORT + 3 - (i - j)] = i === j ? Math.sqrt(Math.max(sum, 1e-12)) : sum / band[j * SUPPORT + 3];
    }
  }
  for (let i = 0; i < n; i++) {
    for (let k = Math.max(0, i - 3); k < i; k++) right[i] -= band[i * SUPPORT + 3 - (i - k)] * right[k];
    right[i] /= band[i * SUPPORT + 3];
  }
  for (let i = n - 1; i >= 0; i--) {
    for (let k = i + 1; k <= Math.min(n - 1, i + 3); k++) right[i] -= band[k * SUPPORT + 3 - (k - i)] * right[k];
    right[i] /= band[i * SUPPORT + 3];
  }
  return right;
}

/**
 * Moves the knots so that the curves follow a dance as closely as they can, in place.
 * @param target its frames count from time 0
 * @param exact for each key knot whether its rotations stay as they are; the root is free everywhere
 */
export function followMotion(curves: CurveDance, target: Motion, exact: readonly boolean[]): void {
  const count = curves.times.length;
  if (count < 2) {
    if (count === 1) holdOne(curves, target);
    return;
  }
  const { fps } = target;
  const times = knotTimes(curves);
  const from = Math.max(0, Math.ceil(times[0] * fps - 1e-6));
  const to = Math.min(target.frames, Math.floor(times[times.length - 1] * fps + 1e-6) + 1);
  const stride = INNER_KNOTS + 1;
  const none = Array.from(times, () => false);
  const keys = Array.from(times, (_, i) => i % stride === 0 && exact[i / stride]);
  const values = (channel: number, basis: Basis) => {
    const knots = knotValues(curves, channel);
    return Float64Array.from({ length: to - from }, (_, t) => {
      let sum = 0;
      for (let p = 0; p < SUPPORT; p++) {
        const weight = basis.weights[t * SUPPORT + p];
        if (weight !== 0) sum += weight * knots[basis.first[t] + p];
      }
      return sum;
    });
  };
  const add = (channel: number, change: Float64Array) => {
    for (let i = 0; i < change.length; i++) {
      const k = Math.floor(i / stride);
      if (i % stride === 0) curves.keys[k * CHANNELS + channel] += change[i];
      else curves.inner[(k * INNER_KNOTS + (i % stride) - 1) * CHANNELS + channel] += change[i];
    }
  };
  for (let channel = 0; channel < 3; channel++) {
    const basis = basisOf(curves, channel, times, from, to, fps);
    const now = values(channel, basis);
    const rest = now.map((value, t) => target.root[(from + t) * 3 + channel] - value);
    add(channel, solveKnots(basis, rest, none));
  }
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const channel = rotationChannel(joint);
    const bases = [0, 1, 2, 3].map((c) => basisOf(curves, channel + c, times, from, to, fps));
    const now = bases.map((basis, c) => values(channel + c, basis));
    const rests = now.map((each) => new Float64Array(each.length));
    let largest = 0;
    for (let t = 0; t < to - from; t++) {
      const q = target.quaternions.subarray(((from + t) * JOINT_COUNT + joint) * 4);
      const length = Math.hypot(now[0][t], now[1][t], now[2][t], now[3][t]);
      // The curve's own length is kept: only the direction counts.
      const sign = now[0][t] * q[0] + now[1][t] * q[1] + now[2][t] * q[2] + now[3][t] * q[3] < 0 ? -length : length;
      for (let c = 0; c < 4; c++) {
        rests[c][t] = sign * q[c] - now[c][t];
        largest = Math.max(largest, Math.abs(rests[c][t]));
      }
    }
    if (largest < CLOSE) continue;
    bases.forEach((basis, c) => add(channel + c, solveKnots(basis, rests[c], keys)));
    for (let k = 0; k < count; k++) if (!exact[k]) normalise(curves.keys, k, channel);
    for (let row = 0; row < (count - 1) * INNER_KNOTS; row++) normalise(curves.inner, row, channel);
  }
}

/** Files want unit quaternions at their keys. */
function normalise(knots: Float32Array, row: number, channel: number): void {
  const q = knots.subarray(row * CHANNELS + channel, row * CHANNELS + channel + 4);
  q.set(unit(q[0], q[1], q[2], q[3]));
}

/** A single key knot has no curve: it only takes the place of the root. */
function holdOne(curves: CurveDance, target: Motion): void {
  const frame = Math.min(target.frames - 1, Math.round(curves.times[0] * target.fps));
  curves.keys.set(target.root.subarray(frame * 3, frame * 3 + 3), 0);
}
