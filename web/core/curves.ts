/**
 * A dance as Kochanek-Bartels curves (Kochanek and Bartels 1984, "Interpolating splines with local tension, continuity, and bias
 * control"): between every two key poses one curve of four knots a channel (paper B, section 4.2). It is analytic, so it can be sampled
 * at any rate, and few numbers hold it, so people can edit it.
 */
import { hermite } from './interpolate';
import { emptyMotion } from './motion';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { Motion } from './types';

const { innerFractions } = spec.danceformer.curve;

/** Numbers of a pose on the curves: root x y z (metres), then 24 quaternions x y z w. */
export const CHANNELS = 3 + JOINT_COUNT * 4;
/** Knots between two key poses. */
export const INNER_KNOTS = innerFractions.length;
/** Tension, continuity, bias. */
export const SHAPE_SIZE = 3;

/** Where a key knot comes from: the id of a visitor's key pose, or the beat (counted from the song's first) of a pose that fills a gap. */
export type CurveAnchor = string | number;

/** A dance as curves: K key knots, and between each two of them two inner knots and one tension, continuity and bias a channel. */
export interface CurveDance {
  /** Length, seconds; before the first and after the last key knot the figure holds still. */
  duration: number;
  /** [K], seconds, ascending. */
  times: Float64Array;
  /** [K], what each key knot is. */
  anchors: CurveAnchor[];
  /** [K, 99]: the key knots; quaternions are unit ones, with signs that run on from knot to knot. */
  keys: Float32Array;
  /** [K - 1, 2, 99]: the inner knots, unit quaternions too. */
  inner: Float32Array;
  /** [K - 1, 2]: where the inner knots are, as shares of the way from key knot to key knot. */
  shares: Float32Array;
  /** [K - 1, 3, 99]: tension, continuity, bias, each -1..1. */
  shape: Float32Array;
}

/** The first channel of a joint's rotation. */
export function rotationChannel(joint: number): number {
  return 3 + joint * 4;
}

/** Tension, continuity and bias of one side of a knot. */
export interface Shape {
  tension: number;
  continuity: number;
  bias: number;
}

/**
 * Velocity with which a curve leaves a knot (eq. 9 of Kochanek and Bartels 1984), per unit of time. Their correction for uneven
 * spacing (section 5) is in it: with 0, 0, 0 it is the difference of the neighbours over the time between them (Catmull-Rom).
 * @param before value of the knot minus that of the knot before
 * @param after value of the knot after minus that of the knot
 * @param span time from the knot before to the knot after
 */
export function outVelocity(before: number, after: number, span: number, { tension, continuity, bias }: Shape): number {
  const slack = 1 - tension;
  return (slack * ((1 + continuity) * (1 + bias) * before + (1 - continuity) * (1 - bias) * after)) / span;
}

/** Velocity with which a curve comes to a knot (eq. 8 of Kochanek and Bartels 1984); see {@link outVelocity}. */
export function inVelocity(before: number, after: number, span: number, { tension, continuity, bias }: Shape): number {
  const slack = 1 - tension;
  return (slack * ((1 - continuity) * (1 + bias) * before + (1 + continuity) * (1 - bias) * after)) / span;
}

/** One channel as a plain cubic Hermite curve through n knots. */
export interface KnotTrack {
  /** [n], seconds, ascending. */
  times: Float64Array;
  /** [n] */
  values: Float64Array;
  /** [n], per second: with which the curve comes to a knot, and leaves it. */
  arriving: Float64Array;
  leaving: Float64Array;
}

/** Times of all knots, key knots and inner ones, seconds: [3 K - 2]. */
export function knotTimes({ times, shares }: CurveDance): Float64Array {
  const count = times.length;
  const all = new Float64Array(Math.max(0, count + (count - 1) * INNER_KNOTS));
  for (let k = 0; k < count; k++) {
    const at = k * (INNER_KNOTS + 1);
    all[at] = times[k];
    if (k + 1 === count) break;
    for (let n = 0; n < INNER_KNOTS; n++) {
      all[at + 1 + n] = times[k] + shares[k * INNER_KNOTS + n] * (times[k + 1] - times[k]);
    }
  }
  return all;
}

/** Values of one channel at all knots, in the order of {@link knotTimes}. */
export function knotValues(curves: CurveDance, channel: number): Float64Array {
  const count = curves.times.length;
  const values = new Float64Array(Math.max(0, count + (count - 1) * INNER_KNOTS));
  for (let k = 0; k < count; k++) {
    const at = k * (INNER_KNOTS + 1);
    values[at] = curves.keys[k * CHANNELS + channel];
    if (k + 1 === count) break;
    for (let n = 0; n < INNER_KNOTS; n++) {
      values[at + 1 + n] = curves.inner[(k * INNER_KNOTS + n) * CHANNELS + channel];
    }
  }
  return values;
}

/** Tension, continuity and bias of a channel between key knots `interval` and `interval + 1`. */
export function shapeAt({ shape }: CurveDance, interval: number, channel: number): Shape {
  const at = interval * SHAPE_SIZE * CHANNELS + channel;
  return { tension: shape[at], continuity: shape[at + CHANNELS], bias: shape[at + 2 * CHANNELS] };
}

/**
 * The knots of one channel with their velocities. An interval's tension, continuity and bias rule its inner knots; at a key pose between
 * two intervals it is the mean of both, so that without a break of continuity the velocity runs on through it. At the two ends of a
 * dance the velocity is that of the straight line, slackened by tension.
 */
export function knotTrack(curves: CurveDance, channel: number, times: Float64Array = knotTimes(curves)): KnotTrack {
  const values = knotValues(curves, channel);
  const count = values.length;
  const arriving = new Float64Array(count);
  const leaving = new Float64Array(count);
  for (let i = 0; i < count && count > 1; i++) {
    const shape = shapeOfKnot(curves, i, channel);
    const before = i > 0 ? values[i] - values[i - 1] : 0;
    const after = i + 1 < count ? values[i + 1] - values[i] : 0;
    if (i === 0) leaving[i] = ((1 - shape.tension) * after) / (times[1] - times[0]);
    else if (i + 1 === count) arriving[i] = ((1 - shape.tension) * before) / (times[i] - times[i - 1]);
    else {
      const span = times[i + 1] - times[i - 1];
      arriving[i] = inVelocity(before, after, span, shape);
      leaving[i] = outVelocity(before, after, span, shape);
    }
  }
  return { times, values, arriving, leaving };
}

/** Tension, continuity and bias at a knot, counted as in {@link knotTimes}. */
export function shapeOfKnot(curves: CurveDance, knot: number, channel: number): Shape {
  const stride = INNER_KNOTS + 1;
  const last = curves.times.length - 2;
  const interval = Math.floor(knot / stride);
  if (knot % stride > 0 || interval === 0) return shapeAt(curves, interval, channel);
  if (interval > last) return shapeAt(curves, last, channel);
  const [a, b] = [shapeAt(curves, interval - 1, channel), shapeAt(curves, interval, channel)];
  return {
    tension: (a.tension + b.tension) / 2,
    continuity: (a.continuity + b.continuity) / 2,
    bias: (a.bias + b.bias) / 2,
  };
}

/** The largest knot at or before a time, but never the last one; -1 before the first. */
export function knotBefore(times: Float64Array, time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return Math.min(low - 1, times.length - 2);
}

/**
 * Value of a channel at a time; before the first and after the last knot that knot's.
 * @param hint the knot before the time, where that is known
 */
export function evaluateTrack(track: KnotTrack, time: number, hint = knotBefore(track.times, time)): number {
  const { times, values, arriving, leaving } = track;
  if (values.length === 0) return 0;
  if (time <= times[0] || values.length === 1) return values[0];
  const last = values.length - 1;
  if (time >= times[last]) return values[last];
  const span = times[hint + 1] - times[hint];
  const t = (time - times[hint]) / span;
  return hermite(values[hint], leaving[hint] * span, values[hint + 1], arriving[hint + 1] * span, t);
}

/**
 * The dance that curves describe.
 * @param fps frames per second, any
 * @param frames length; by default as many as begin within the duration
 * @throws Error when there is no key knot
 */
export function sampleCurves(curves: CurveDance, fps: number, frames = Math.ceil(curves.duration * fps)): Motion {
  if (curves.times.length === 0) throw new Error('The curves have no key pose: generate the dance again.');
  const motion = { ...emptyMotion(frames), fps };
  sampleChannels(curves, motion, allTracks(), 0, frames);
  return motion;
}

/** What is sampled together: the place of the root, or a joint's rotation. */
export type CurveTrack = 'root' | number;

/** The root and every joint. */
export function allTracks(): CurveTrack[] {
  return ['root', ...Array.from({ length: JOINT_COUNT }, (_, joint) => joint)];
}

/** Samples some tracks of the curves into frames [from, to) of a dance. */
export function sampleChannels(
  curves: CurveDance,
  motion: Motion,
  tracks: readonly CurveTrack[],
  from: number,
  to: number,
): void {
  const times = knotTimes(curves);
  for (const track of tracks) {
    const [first, size] = track === 'root' ? [0, 3] : [rotationChannel(track), 4];
    const channels = Array.from({ length: size }, (_, c) => knotTrack(curves, first + c, times));
    let knot = knotBefore(times, from / motion.fps);
    for (let t = from; t < to; t++) {
      const time = t / motion.fps;
      while (knot < times.length - 2 && times[knot + 1] <= time) knot += 1;
      if (track === 'root') {
        for (let c = 0; c < 3; c++) motion.root[t * 3 + c] = evaluateTrack(channels[c], time, knot);
      } else {
        const [x, y, z, w] = channels.map((each) => evaluateTrack(each, time, knot));
        motion.quaternions.set(unit(x, y, z, w), (t * JOINT_COUNT + track) * 4);
      }
    }
  }
}

/** A quaternion of length 1; where the curve runs through zero there is no rotation to read: the identity. */
export function unit(x: number, y: number, z: number, w: number): [number, number, number, number] {
  const length = Math.hypot(x, y, z, w);
  return length > 1e-6 ? [x / length, y / length, z / length, w / length] : [0, 0, 0, 1];
}

/** Gives every quaternion knot the sign nearest to the knot before, in place, so that no curve goes the long way round. */
export function alignKnots(curves: CurveDance): CurveDance {
  const { keys, inner, times } = curves;
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const channel = rotationChannel(joint);
    let before: Float32Array | null = null;
    const align = (list: Float32Array, row: number) => {
      const q = list.subarray(row * CHANNELS + channel, row * CHANNELS + channel + 4);
      if (before && q[0] * before[0] + q[1] * before[1] + q[2] * before[2] + q[3] * before[3] < 0) {
        for (let c = 0; c < 4; c++) q[c] = -q[c];
      }
      before = q;
    };
    for (let k = 0; k < times.length; k++) {
      align(keys, k);
      if (k + 1 < times.length) for (let n = 0; n < INNER_KNOTS; n++) align(inner, k * INNER_KNOTS + n);
    }
  }
  return curves;
}

/** Curves without anything in them yet: inner knots at thirds, no tension, continuity or bias. */
export function emptyCurves(
  times: ArrayLike<number>,
  duration: number,
  anchors: readonly CurveAnchor[] = Array.from(times),
): CurveDance {
  const count = times.length;
  const intervals = Math.max(0, count - 1);
  const keys = new Float32Array(count * CHANNELS);
  const inner = new Float32Array(intervals * INNER_KNOTS * CHANNELS);
  for (const list of [keys, inner]) {
    for (let i = 6; i < list.length; i += i % CHANNELS === CHANNELS - 1 ? 7 : 4) list[i] = 1;
  }
  const shares = Float32Array.from({ length: intervals * INNER_KNOTS }, (_, i) => innerFractions[i % INNER_KNOTS]);
  const shape = new Float32Array(intervals * SHAPE_SIZE * CHANNELS);
  return { duration, times: Float64Array.from(times), anchors: [...anchors], keys, inner, shares, shape };
}

/** A copy that shares no memory with the original. */
export function copyCurves(curves: CurveDance): CurveDance {
  const { duration, times, anchors, keys, inner, shares, shape } = curves;
  return {
    duration,
    times: times.slice(),
    anchors: [...anchors],
    keys: keys.slice(),
    inner: inner.slice(),
    shares: shares.slice(),
    shape: shape.slice(),
  };
}
