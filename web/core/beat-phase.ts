import { hermite } from './interpolate';
import type { BeatGrid } from './types';

/** Beats of a song as a continuous count: time -> beats and back, before the first and after the last beat too. */
export interface BeatPhase {
  /** Beats since the first downbeat (negative before it). */
  at(seconds: number): number;
  /** Seconds of a beat count. */
  time(beats: number): number;
  /** Beats in a bar. */
  perBar: number;
}

/**
 * A beat count with a continuous rate, so that a dance that is driven by it has no kinks at the beats: monotone cubic
 * interpolation through the beats (slopes by harmonic means, Fritsch and Butland 1984). A grid without two beats counts at its
 * tempo, or at 120 beats a minute without one.
 */
export function beatPhase(grid: BeatGrid): BeatPhase {
  const beats = grid.beats.filter((time, i, all) => Number.isFinite(time) && (i === 0 || time > all[i - 1]));
  const interval = 60 / (grid.tempo > 0 && Number.isFinite(grid.tempo) ? grid.tempo : 120);
  if (beats.length < 2) {
    const origin = beats[0] ?? 0;
    return { at: (t) => (t - origin) / interval, time: (b) => origin + b * interval, perBar: grid.beatsPerBar };
  }
  const first = firstDownbeat(beats, grid.downbeats);
  const gaps = beats.slice(1).map((time, i) => time - beats[i]);
  const slopes = beats.map((_, i) => {
    if (i === 0) return 1 / gaps[0];
    if (i === beats.length - 1) return 1 / gaps[i - 1];
    return 2 / (gaps[i - 1] + gaps[i]);
  });
  const last = beats.length - 1;
  const at = (seconds: number): number => {
    if (seconds <= beats[0]) return (seconds - beats[0]) * slopes[0] - first;
    if (seconds >= beats[last]) return last + (seconds - beats[last]) * slopes[last] - first;
    const i = segment(beats, seconds);
    const t = (seconds - beats[i]) / gaps[i];
    return hermite(i, slopes[i] * gaps[i], i + 1, slopes[i + 1] * gaps[i], t) - first;
  };
  const time = (count: number): number => {
    const index = count + first;
    if (index <= 0) return beats[0] + index / slopes[0];
    if (index >= last) return beats[last] + (index - last) / slopes[last];
    const whole = Math.floor(index);
    let [low, high] = [beats[whole], beats[whole + 1]];
    for (let step = 0; step < 40; step++) {
      const middle = (low + high) / 2;
      if (at(middle) < count) low = middle;
      else high = middle;
    }
    return index === whole ? beats[whole] : (low + high) / 2;
  };
  return { at, time, perBar: grid.beatsPerBar };
}

function firstDownbeat(beats: number[], downbeats: number[]): number {
  if (!downbeats.length) return 0;
  let nearest = 0;
  beats.forEach((time, i) => {
    if (Math.abs(time - downbeats[0]) < Math.abs(beats[nearest] - downbeats[0])) nearest = i;
  });
  return nearest;
}

/** Largest i with sorted[i] <= value, below the last. */
function segment(sorted: number[], value: number): number {
  let [low, high] = [0, sorted.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (sorted[middle] <= value) low = middle;
    else high = middle;
  }
  return low;
}
