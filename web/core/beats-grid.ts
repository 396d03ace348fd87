/** From onset strength and harmony to the beat grid of a song. */
import { findBars } from './beats-bars';
import { followTempo, normaliseEnvelope, periodAt, trackBeats, type TempoCurve } from './beats';
import { preferFaster } from './beats-level';
import { isBetweenBeats } from './beats-offbeat';
import { PITCH_CLASSES } from './chroma';
import { percentile } from './interpolate';
import type { BeatGrid } from './types';

/** Decibels below the loud parts of a song at which it counts as silent, and as fading where no onset is left. */
const SILENT_BELOW = 55;
const FADED_BELOW = 15;
/** Share of a typical beat's onset that is none. */
const WEAK_ONSET = 0.2;

/** What the beat search works on. */
export interface GridEvidence {
  /** Frames per second of the onset strengths. */
  rate: number;
  /** Onset strength of the whole sound and of its bass, middle and treble. */
  all: Float32Array;
  low: Float32Array;
  middle: Float32Array;
  high: Float32Array;
  /** Loudness, decibels. */
  level: Float32Array;
  /** Frames per second of the chroma. */
  fps: number;
  /** frames x 12, each of length 1 or 0. */
  chroma: Float32Array;
}

/** @returns beats and bar lines; no beats where nothing sounds */
export function findGrid(evidence: GridEvidence): BeatGrid {
  const { all, low, rate, fps } = evidence;
  const normal = normaliseEnvelope(all, rate);
  if (!all.some((v) => v > 0)) return { tempo: 120, beatsPerBar: 4, beats: [], downbeats: [] };
  const bands = [evidence.low, evidence.middle, evidence.high].map((band) => normaliseEnvelope(band, rate));
  const { positions: loudest, curve } = chooseLevel(evidence, normal, followTempo([normal, ...bands], rate));
  const tracked = isBetweenBeats(low, loudest, rate) ? trackBeats(bands[0], rate, curve) : loudest;
  const positions = trimmed(extended(tracked, all.length, curve, rate), evidence);
  const beats = positions.map((p) => p / rate);
  const peak = (values: ArrayLike<number>, p: number): number => {
    let best = 0;
    for (let i = Math.round(p) - 2; i <= Math.round(p) + 2; i++) best = Math.max(best, values[i] ?? 0);
    return best;
  };
  const frames = evidence.chroma.length / PITCH_CLASSES;
  const change = beats.map((b) => {
    const before = Math.max(0, Math.round((b - 0.25) * fps));
    const after = Math.min(frames - 1, Math.round((b + 0.25) * fps));
    let dot = 0;
    for (let c = 0; c < PITCH_CLASSES; c++)
      dot += evidence.chroma[before * PITCH_CLASSES + c] * evidence.chroma[after * PITCH_CLASSES + c];
    return 1 - dot;
  });
  const bars = findBars({ onset: positions.map((p) => peak(all, p)), low: positions.map((p) => peak(low, p)), change });
  const gaps = beats.slice(1).map((b, i) => b - beats[i]);
  return {
    tempo: gaps.length ? 60 / percentile(gaps, 0.5) : 120,
    beatsPerBar: bars.beatsPerBar,
    beats,
    downbeats: beats.filter((_, i) => i % bars.beatsPerBar === bars.first),
  };
}

/** Tracks the beats at the tempo found, and twice and half as fast while that is more likely the tapped beat. */
function chooseLevel(
  evidence: GridEvidence,
  envelope: Float64Array,
  curve: TempoCurve,
): { positions: number[]; curve: TempoCurve } {
  const { rate } = evidence;
  const track = (factor: number): { positions: number[]; curve: TempoCurve } => {
    const scaled = { step: curve.step, periods: curve.periods.map((p) => p / factor) };
    return { positions: trackBeats(envelope, rate, scaled), curve: scaled };
  };
  const seconds = (positions: number[]): number[] => positions.map((p) => p / rate);
  const found = track(1);
  const double = track(2);
  if (preferFaster(evidence, seconds(double.positions)) > 0) return double;
  if (preferFaster(evidence, seconds(found.positions)) < 0) return track(0.5);
  return found;
}

/** Goes on before the first and after the last beat at the local tempo: an intro without onsets has beats too. */
function extended(positions: readonly number[], frames: number, curve: TempoCurve, rate: number): number[] {
  const out = [...positions];
  const period = (at: number): number => periodAt(curve, at / rate) * rate;
  // A beat may lie a little before the first frame's centre.
  const early = -0.1 * rate;
  while (out.length > 0 && out[0] - period(out[0]) > early) out.unshift(Math.max(0, out[0] - period(out[0])));
  for (let last = out[out.length - 1]; last + period(last) < frames; last = out[out.length - 1])
    out.push(last + period(last));
  return out;
}

/** Leaves out the beats in the silence around the song, and in the dying away of its end. */
function trimmed(positions: readonly number[], evidence: GridEvidence): number[] {
  const { level, all, rate } = evidence;
  const loud = percentile(level, 0.95);
  const reach = Math.round(0.07 * rate);
  const around = (values: Float32Array, p: number): number =>
    Math.max(...values.subarray(Math.max(0, Math.round(p) - reach), Math.round(p) + reach + 1));
  const typical = percentile(
    positions.map((p) => around(all, p)),
    0.5,
  );
  const sounds = (p: number): boolean => around(level, p) > loud - SILENT_BELOW;
  const matters = (p: number): boolean =>
    sounds(p) && (around(all, p) > WEAK_ONSET * typical || around(level, p) > loud - FADED_BELOW);
  let from = 0;
  let to = positions.length;
  while (from < to && !sounds(positions[from])) from++;
  while (to > from && !matters(positions[to - 1])) to--;
  return positions.slice(from, to);
}
