/** One track of a dance of curves as three curves that people can read: angles about the joint's axes in degrees, or a way in centimetres. */
import { CHANNELS, evaluateTrack, INNER_KNOTS, knotBefore, knotTimes, knotTrack, unit } from './curves';
import type { CurveDance, CurveTrack } from './curves';
import { channelsOf, type CurveEdit, type Triple } from './curves-edit';
import { axisAngleToQuaternion, conjugate, multiply, quaternionToAxisAngle } from './rotation';

const DEGREES = 180 / Math.PI;
const CENTIMETRES = 100;
/** Samples a second of a curve that is only looked at. */
const RATE = 60;
/** A curve is never stretched to less than this from bottom to top, degrees or centimetres. */
const LEAST_SPAN = 20;

/** A track to be drawn. */
export interface TrackPicture {
  /** Samples a second; sample i is at i / rate. */
  rate: number;
  /** [samples, 3] */
  values: Float32Array;
  /** [3 K - 2], seconds. */
  knots: Float64Array;
  /** [3 K - 2, 3] */
  knotValues: Float32Array;
  /** Of all values, with some room. */
  lowest: number;
  highest: number;
}

/** A rotation vector of the same rotation that is nearest to another, so that a curve of angles never jumps by a turn. */
function nearestTurn(vector: ArrayLike<number>, near: ArrayLike<number>): Triple {
  const [x, y, z] = [vector[0], vector[1], vector[2]];
  const angle = Math.hypot(x, y, z);
  if (angle < 1e-6) {
    // No turn at all has no axis of its own: it lies on the other's.
    const length = Math.hypot(near[0], near[1], near[2]);
    const whole = Math.round(length / (2 * Math.PI)) * 2 * Math.PI;
    return whole === 0 ? [x, y, z] : ([near[0], near[1], near[2]].map((value) => (value * whole) / length) as Triple);
  }
  const along = (x * near[0] + y * near[1] + z * near[2]) / angle;
  const turns = Math.round((along - angle) / (2 * Math.PI));
  const scale = (angle + turns * 2 * Math.PI) / angle;
  return [x * scale, y * scale, z * scale];
}

/** The track through the whole dance. */
export function trackPicture(curves: CurveDance, track: CurveTrack): TrackPicture {
  const { first, count } = channelsOf(track);
  const knots = knotTimes(curves);
  const channels = Array.from({ length: count }, (_, c) => knotTrack(curves, first + c, knots));
  const samples = Math.max(1, Math.ceil(curves.duration * RATE) + 1);
  const values = new Float32Array(samples * 3);
  let near: Triple = [0, 0, 0];
  const read = (time: number, knot: number): Triple => {
    const raw = channels.map((each) => evaluateTrack(each, time, knot));
    if (track === 'root') return raw.map((value) => value * CENTIMETRES) as Triple;
    return nearestTurn(quaternionToAxisAngle(unit(raw[0], raw[1], raw[2], raw[3])), near);
  };
  const scale = track === 'root' ? 1 : DEGREES;
  let knot = 0;
  for (let i = 0; i < samples; i++) {
    const time = i / RATE;
    while (knot < knots.length - 2 && knots[knot + 1] <= time) knot += 1;
    near = read(time, knot);
    values.set(
      near.map((value) => value * scale),
      i * 3,
    );
  }
  const knotValues = new Float32Array(knots.length * 3);
  knots.forEach((time, i) => {
    const at = Math.min(samples - 1, Math.round(time * RATE)) * 3;
    near = [values[at] / scale, values[at + 1] / scale, values[at + 2] / scale];
    const value = read(time, Math.max(0, knotBefore(knots, time)));
    knotValues.set(
      value.map((each) => each * scale),
      i * 3,
    );
  });
  let [lowest, highest] = [Infinity, -Infinity];
  for (const value of values) {
    lowest = Math.min(lowest, value);
    highest = Math.max(highest, value);
  }
  const room = Math.max(LEAST_SPAN - (highest - lowest), 0.1 * (highest - lowest)) / 2;
  return { rate: RATE, values, knots, knotValues, lowest: lowest - room, highest: highest + room };
}

/**
 * The inner knots of an edit that brings one of them to a value.
 * @param base the curves as generated
 * @param shown what is seen of the track now
 * @param n which inner knot of the interval, 0 or 1
 * @param axis 0..2
 * @param value degrees or centimetres
 */
export function knotsMovedTo(
  base: CurveDance,
  shown: TrackPicture,
  edit: CurveEdit | undefined,
  place: { interval: number; n: number; track: CurveTrack },
  axis: number,
  value: number,
): [Triple, Triple] {
  const { interval, n, track } = place;
  const at = (interval * (INNER_KNOTS + 1) + 1 + n) * 3;
  const wanted: Triple = [shown.knotValues[at], shown.knotValues[at + 1], shown.knotValues[at + 2]];
  wanted[axis] = value;
  const { first, count } = channelsOf(track);
  const row = (interval * INNER_KNOTS + n) * CHANNELS + first;
  const generated = base.inner.subarray(row, row + count);
  let change: Triple;
  if (track === 'root') {
    change = wanted.map((each, c) => each / CENTIMETRES - generated[c]) as Triple;
  } else {
    const [x, y, z, w] = generated;
    const q = axisAngleToQuaternion(wanted.map((each) => each / DEGREES));
    change = quaternionToAxisAngle(multiply(conjugate(unit(x, y, z, w)), q)) as Triple;
  }
  const knots: [Triple, Triple] = edit?.knots
    ? [...edit.knots]
    : [
        [0, 0, 0],
        [0, 0, 0],
      ];
  knots[n] = change.map((each) => Math.round(each * 1e6) / 1e6 + 0) as Triple;
  return knots;
}

/** Tension, continuity and bias of a track in an interval: the mean of its channels. */
export function meanShape(curves: CurveDance, interval: number, track: CurveTrack, which: 0 | 1 | 2): number {
  const { first, count } = channelsOf(track);
  const at = (interval * 3 + which) * CHANNELS + first;
  let sum = 0;
  for (let c = 0; c < count; c++) sum += curves.shape[at + c];
  return sum / count;
}
