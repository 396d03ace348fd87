/** Seconds and beats, also for a song without beats. */
import { beatPosition, timeAtBeat } from './grid-edit';
import { lowerBound } from './snap';
import type { BeatGrid } from './types';

/** Half a second is a beat where a song has none: 120 a minute. */
const SECONDS_WITHOUT_BEATS = 0.5;
/** Beat counts closer than this to a whole number are that number, so that a key pose on a beat stays exactly on beats. */
export const BEAT_NOISE = 1e-6;

/** Seconds to beats and back. */
export interface BeatCount {
  /** Beats since the first one, with fractions, negative before it. */
  of(time: number): number;
  /** Seconds; on whole counts exactly the beat's. */
  time(beats: number): number;
}

const counts = new WeakMap<BeatGrid, BeatCount>();

/** Counts the beats of a grid, before its first and after its last one too; without beats half a second counts as one. */
export function beatCount(grid: BeatGrid | null): BeatCount {
  if (!grid || grid.beats.length === 0) {
    return { of: (time) => time / SECONDS_WITHOUT_BEATS, time: (beats) => beats * SECONDS_WITHOUT_BEATS };
  }
  let count = counts.get(grid);
  if (!count) {
    count = {
      of: (time) => beatPosition(grid, time),
      time: (beats) => timeAtBeat(grid, Math.abs(beats - Math.round(beats)) < BEAT_NOISE ? Math.round(beats) : beats),
    };
    counts.set(grid, count);
  }
  return count;
}

/** The beat before (-1) or after (1) a time; outside the beats as far away as a beat is long. */
export function stepBeat(grid: BeatGrid | null, time: number, direction: -1 | 1): number {
  const beats = grid?.beats ?? [];
  // A time on a beat must move on, although it is the beat's only to a rounding error.
  const margin = 1e-3;
  const index = direction > 0 ? lowerBound(beats, time + margin) : lowerBound(beats, time - margin) - 1;
  const count = beatCount(grid);
  return beats[index] ?? count.time(count.of(time) + direction);
}
