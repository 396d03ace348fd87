/** From onset strength and harmony to the beat grid of a song. */
import { findBars } from './beats-bars';
import { followTempo, normaliseEnvelope, trackBeats } from './beats';
import { PITCH_CLASSES } from './chroma';
import { percentile } from './onset';
import type { BeatGrid } from './types';

/** What the beat search works on. */
export interface GridEvidence {
  /** Frames per second of the onset strengths. */
  rate: number;
  /** Onset strength of the whole sound and of its bass, middle and treble. */
  all: Float32Array;
  low: Float32Array;
  middle: Float32Array;
  high: Float32Array;
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
  const curve = followTempo(normal, rate);
  const positions = trackBeats(normal, rate, curve);
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
