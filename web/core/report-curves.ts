/** Curves of the report: pure helpers on top of metrics.ts. */
import { dancedPart } from './excerpt';
import { finishDance, partOf, type UncorrectedDance } from './finish';
import { consistencyError, meanJerk } from './metrics';
import type { KeyPose, Motion } from './types';

/** How far the dance is from one key pose. */
export interface KeyError {
  /** Id of the key pose. */
  id: string;
  /** Seconds. */
  time: number;
  /** Squared distance over the 144 rotation numbers (one summand of paper A, eq. 13); 0 = hit exactly. */
  error: number;
}

/** Consistency error of every key pose inside the dance, in the order of the key poses (paper A, eq. 13 before its mean). */
export function consistencyPerKey(motion: Motion, keyPoses: readonly KeyPose[]): KeyError[] {
  return keyPoses
    .map((key) => ({ id: key.id, time: key.time, error: consistencyError(motion, [key]) }))
    .filter(({ error }) => !Number.isNaN(error));
}

/** What one key strength gives. */
export interface TradeOffPoint {
  /** 0..1 */
  strength: number;
  /** Consistency error E_c (paper A, eq. 13), mean over the key poses. */
  error: number;
  /** Mean jerk, m/s^3. */
  jerk: number;
}

/** One point of consistency against smoothness: the dance finished at a key strength 0..1, without the network. */
export function tradeOffPoint(dance: UncorrectedDance, keyPoses: readonly KeyPose[], strength: number): TradeOffPoint {
  const danced = dancedPart(finishDance(dance, keyPoses, strength), keyPoses, partOf(dance));
  return { strength, error: consistencyError(danced.motion, danced.keyPoses), jerk: meanJerk(danced.motion) };
}

/**
 * Strengths at which the trade-off is worked out, coarse to fine so that its shape is there early: both ends, the middle, quarters ...
 * @param halvings 0 = the ends, 1 = 3 points, 2 = 5, 3 = 9
 */
export function tradeOffStrengths(halvings: number): number[] {
  const strengths = [1, 0];
  for (let step = 0.5, i = 0; i < halvings; i++, step /= 2)
    for (let strength = step; strength < 1; strength += 2 * step) strengths.push(strength);
  return strengths;
}

/** The trade-off at a strength between the points, which are ascending in strength; null without any. */
export function tradeOffAt(points: readonly TradeOffPoint[], strength: number): TradeOffPoint | null {
  if (points.length === 0) return null;
  const next = points.findIndex((point) => point.strength >= strength);
  if (next <= 0) return { ...points[next < 0 ? points.length - 1 : 0], strength };
  const [a, b] = [points[next - 1], points[next]];
  const t = (strength - a.strength) / (b.strength - a.strength);
  return { strength, error: a.error + t * (b.error - a.error), jerk: a.jerk + t * (b.jerk - a.jerk) };
}

/**
 * For every motion beat: is a musical beat within the tolerance?
 * @param moves seconds, any order
 * @param beats seconds, ascending
 * @param tolerance seconds
 */
export function movesOnBeats(moves: readonly number[], beats: readonly number[], tolerance: number): boolean[] {
  let i = 0;
  let last = -Infinity;
  return moves.map((move) => {
    if (move < last) i = 0;
    last = move;
    while (i + 1 < beats.length && Math.abs(beats[i + 1] - move) <= Math.abs(beats[i] - move)) i++;
    return beats.length > 0 && Math.abs(beats[i] - move) <= tolerance + 1e-6;
  });
}

/** Lowest and highest value of each pixel column of a curve. */
export interface Envelope {
  low: Float32Array;
  high: Float32Array;
}

/**
 * A curve cut down to what pixels can show: for each column the range of the curve in it, both ends interpolated, so that columns join
 * without gaps whatever the zoom. Columns outside the curve hold NaN. Costs the samples in sight, not the whole curve.
 * @param values samples, evenly spaced
 * @param first sample position of the left edge of column 0 (may lie outside)
 * @param perColumn samples a column
 * @param columns how many
 */
export function envelope(values: ArrayLike<number>, first: number, perColumn: number, columns: number): Envelope {
  const low = new Float32Array(columns).fill(NaN);
  const high = new Float32Array(columns).fill(NaN);
  const end = values.length - 1;
  const at = (position: number): number => {
    const i = Math.min(Math.floor(position), Math.max(0, end - 1));
    return values[i] + (position - i) * ((values[i + 1] ?? values[i]) - values[i]);
  };
  for (let column = 0; column < columns; column++) {
    const from = Math.max(0, first + column * perColumn);
    const to = Math.min(end, first + (column + 1) * perColumn);
    if (!(from <= to)) continue;
    let [least, most] = [at(from), at(from)];
    const take = (value: number) => {
      if (value < least) least = value;
      if (value > most) most = value;
    };
    take(at(to));
    for (let i = Math.ceil(from); i <= to; i++) take(values[i]);
    low[column] = least;
    high[column] = most;
  }
  return { low, high };
}
