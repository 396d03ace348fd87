/** Tempo and beats from an onset envelope: local autocorrelation for the tempo, dynamic programming for the beats (Ellis 2007). */

import { logTempoPrior } from './beats-level';

/** Slowest and fastest beat that is looked for, beats per minute. */
const TEMPO_RANGE = [50, 220] as const;
/** Tempo candidates per octave: 1.5 % steps, fine against the tolerance of the beat search. */
const STEPS_PER_OCTAVE = 48;
/** Window and step of the local autocorrelation, seconds. */
const WINDOW_SECONDS = 12;
const STEP_SECONDS = 2;
/** Weight of repetition after a bar against repetition after a beat. */
const BAR_WEIGHT = 1.5;
/** Cost of a tempo change between windows, times the square of its size in octaves: rubato is cheap, a jump is dear. */
const CHANGE_COST = 25;
/** Weight of even spacing against strong onsets in the beat search (Ellis 2007, alpha). */
const TIGHTNESS = 200;

/** Beat period over time. */
export interface TempoCurve {
  /** Seconds between entries. */
  step: number;
  /** Beat periods, seconds. */
  periods: Float64Array;
}

/**
 * Evens out loudness: removes the moving mean and divides by the moving deviation, so that a quiet passage counts like a loud one.
 * @param envelope onset strength at `rate` frames per second
 * @returns non-negative envelope of about unit variance where anything sounds
 */
export function normaliseEnvelope(envelope: ArrayLike<number>, rate: number): Float64Array {
  const n = envelope.length;
  const sums = new Float64Array(n + 1);
  const squares = new Float64Array(n + 1);
  for (let i = 0; i < n; i++) {
    sums[i + 1] = sums[i] + envelope[i];
    squares[i + 1] = squares[i] + envelope[i] ** 2;
  }
  const overall = n ? Math.sqrt(squares[n] / n) : 0;
  const out = new Float64Array(n);
  const short = Math.round(0.75 * rate);
  const long = Math.round(4 * rate);
  for (let i = 0; i < n; i++) {
    const mean = windowMean(sums, i, short);
    const spread = Math.sqrt(Math.max(0, windowMean(squares, i, long) - windowMean(sums, i, long) ** 2));
    out[i] = Math.max(0, envelope[i] - mean) / (spread + 0.1 * overall + 1e-9);
  }
  return out;
}

function windowMean(sums: Float64Array, at: number, reach: number): number {
  const from = Math.max(0, at - reach);
  const to = Math.min(sums.length - 1, at + reach + 1);
  return (sums[to] - sums[from]) / (to - from);
}

/** Autocorrelation of one Hann-weighted stretch for lags 0 .. maxLag, divided by that at lag 0. */
function localAutocorrelation(envelope: Float64Array, centre: number, reach: number, maxLag: number): Float64Array {
  const length = 2 * reach + 1;
  const part = new Float64Array(length);
  for (let i = 0; i < length; i++) {
    const value = envelope[centre - reach + i] ?? 0;
    part[i] = value * (0.5 + 0.5 * Math.cos((Math.PI * (i - reach)) / (reach + 1)));
  }
  const out = new Float64Array(maxLag + 1);
  for (let lag = 0; lag <= maxLag; lag++) {
    let sum = 0;
    for (let i = lag; i < length; i++) sum += part[i] * part[i - lag];
    // Fewer products at long lags: without this slow tempi would lose.
    out[lag] = sum / (1 - (0.5 * lag) / length);
  }
  const energy = out[0];
  if (energy > 0) for (let lag = 0; lag <= maxLag; lag++) out[lag] /= energy;
  return out;
}

/** Value between samples by linear interpolation; 0 outside. */
function sampleAt(values: ArrayLike<number>, position: number): number {
  const below = Math.floor(position);
  if (below < 0 || below + 1 >= values.length) return 0;
  return values[below] + (values[below + 1] - values[below]) * (position - below);
}

/** Candidate tempi, beats per minute, evenly spaced on a log scale. */
function tempoCandidates(): Float64Array {
  const count = Math.floor(STEPS_PER_OCTAVE * Math.log2(TEMPO_RANGE[1] / TEMPO_RANGE[0])) + 1;
  return Float64Array.from({ length: count }, (_, i) => TEMPO_RANGE[0] * 2 ** (i / STEPS_PER_OCTAVE));
}

/**
 * Support for a beat period: it repeats after one beat, and after a bar of four or of three. A pulse of one and a half beats repeats
 * after itself too, but no bar of it does.
 */
function comb(correlation: ArrayLike<number>, lag: number): number {
  const at = (beats: number): number => sampleAt(correlation, beats * lag);
  const four = 0.4 * at(2) + 0.6 * at(4);
  const three = 0.7 * at(3) + 0.3 * at(6);
  return at(1) + BAR_WEIGHT * Math.max(four, three);
}

/**
 * Follows the tempo through the song: local scores, then the best path (Viterbi) that changes little.
 * @param envelopes normalised onset strengths (of the whole and of parts of the sound), equally long
 * @param rate their frames per second
 */
export function followTempo(envelopes: readonly Float64Array[], rate: number): TempoCurve {
  const candidates = tempoCandidates();
  const length = envelopes[0].length;
  const windows = Math.max(1, Math.ceil(length / (STEP_SECONDS * rate)));
  const reach = Math.round((WINDOW_SECONDS * rate) / 2);
  const maxLag = Math.min(2 * reach, Math.ceil((6 * 60 * rate) / TEMPO_RANGE[0]));
  const scores = Array.from({ length: windows }, (_, w) => {
    const mean = new Float64Array(maxLag + 1);
    for (const envelope of envelopes) {
      const one = localAutocorrelation(envelope, Math.round((w + 0.5) * STEP_SECONDS * rate), reach, maxLag);
      for (let lag = 0; lag <= maxLag; lag++) mean[lag] += one[lag] / envelopes.length;
    }
    return candidates.map((bpm) => comb(mean, (60 / bpm) * rate) * Math.exp(logTempoPrior(60 / bpm)));
  });
  const path = smoothestPath(scores);
  return { step: STEP_SECONDS, periods: Float64Array.from(path, (c) => 60 / candidates[c]) };
}

/** Viterbi: one candidate per window, maximising scores minus the cost of jumps. */
function smoothestPath(scores: Float64Array[]): number[] {
  const count = scores[0].length;
  const back: Int32Array[] = [];
  let total = Float64Array.from(scores[0]);
  for (let w = 1; w < scores.length; w++) {
    const next = new Float64Array(count);
    const from = new Int32Array(count);
    for (let c = 0; c < count; c++) {
      let best = -Infinity;
      for (let p = 0; p < count; p++) {
        const value = total[p] - CHANGE_COST * ((p - c) / STEPS_PER_OCTAVE) ** 2;
        if (value > best) {
          best = value;
          from[c] = p;
        }
      }
      next[c] = best + scores[w][c];
    }
    back.push(from);
    total = next;
  }
  let at = total.indexOf(Math.max(...total));
  const path = [at];
  for (let w = back.length - 1; w >= 0; w--) path.unshift((at = back[w][at]));
  return path;
}

/** Period at a time, seconds. */
export function periodAt(curve: TempoCurve, seconds: number): number {
  const index = Math.max(0, Math.min(curve.periods.length - 1, Math.floor(seconds / curve.step)));
  return curve.periods[index];
}

/**
 * Beat search by dynamic programming (Ellis 2007, eq. 5-6): the chain of frames that has strong onsets and steps near the local
 * period, from the first frames to the last.
 * @returns beat positions in frames, fractional (parabola through the neighbouring values of the envelope)
 */
export function trackBeats(envelope: Float64Array, rate: number, curve: TempoCurve): number[] {
  const n = envelope.length;
  const smooth = smoothed(envelope, rate);
  const total = new Float64Array(n);
  const back = new Int32Array(n).fill(-1);
  for (let t = 0; t < n; t++) {
    const period = periodAt(curve, t / rate) * rate;
    const from = Math.max(0, Math.round(t - 2 * period));
    const to = Math.round(t - period / 2);
    let best = 0;
    for (let p = from; p <= to; p++) {
      const value = total[p] - TIGHTNESS * Math.log((t - p) / period) ** 2;
      if (value > best) {
        best = value;
        back[t] = p;
      }
    }
    total[t] = smooth[t] + best;
  }
  // The last beat is the best end within the last period and a half.
  let at = n - 1;
  const lastPeriod = periodAt(curve, n / rate) * rate;
  for (let t = Math.max(0, Math.floor(n - 1.5 * lastPeriod)); t < n; t++) if (total[t] > total[at]) at = t;
  const beats: number[] = [];
  for (; at >= 0; at = back[at]) beats.push(at);
  beats.reverse();
  return beats.map((b) => refinePeak(smooth, b));
}

/** Gaussian smoothing by about 20 ms: onsets of one beat that are a few milliseconds apart become one peak. */
function smoothed(envelope: Float64Array, rate: number): Float64Array {
  const sigma = 0.02 * rate;
  const reach = Math.ceil(3 * sigma);
  const kernel = Float64Array.from({ length: 2 * reach + 1 }, (_, i) => Math.exp(-0.5 * ((i - reach) / sigma) ** 2));
  const out = new Float64Array(envelope.length);
  for (let t = 0; t < out.length; t++) {
    for (let k = -reach; k <= reach; k++) out[t] += kernel[k + reach] * (envelope[t + k] ?? 0);
  }
  return out;
}

function refinePeak(values: Float64Array, at: number): number {
  if (at <= 0 || at + 1 >= values.length) return at;
  const [a, b, c] = [values[at - 1], values[at], values[at + 1]];
  const curvature = a - 2 * b + c;
  if (!(curvature < 0) || b < a || b < c) return at;
  return at + (0.5 * (a - c)) / curvature;
}
