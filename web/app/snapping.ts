/** Times and beats: where a pose snaps to, what a time is called. */
import type { BeatGrid } from '../core/types';

/** Index of the first value >= time in an ascending list. */
export function lowerBound(list: readonly number[], time: number): number {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The beat nearest to a time; the time itself when there are no beats. */
export function nearestBeat(grid: BeatGrid | null, time: number): number {
  if (!grid || grid.beats.length === 0) return time;
  const after = lowerBound(grid.beats, time);
  const next = grid.beats[Math.min(after, grid.beats.length - 1)];
  const previous = grid.beats[Math.max(0, after - 1)];
  return Math.abs(next - time) < Math.abs(time - previous) ? next : previous;
}

/** The beat before (-1) or after (1) a time; half a second on where there is none. */
export function stepBeat(grid: BeatGrid | null, time: number, direction: -1 | 1): number {
  const beats = grid?.beats ?? [];
  // A pose on a beat must move on, although its time is the beat's only to a rounding error.
  const margin = 1e-3;
  const index = direction > 0 ? lowerBound(beats, time + margin) : lowerBound(beats, time - margin) - 1;
  return beats[index] ?? time + direction * 0.5;
}

/** Bar and beat of a time, both from 1; null before the first bar or without beats. */
export function barAndBeat(grid: BeatGrid | null, time: number): { bar: number; beat: number } | null {
  if (!grid) return null;
  const bar = lowerBound(grid.downbeats, time + 1e-3);
  if (bar === 0) return null;
  const start = lowerBound(grid.beats, grid.downbeats[bar - 1] - 1e-3);
  const beat = lowerBound(grid.beats, time + 1e-3) - start;
  return { bar, beat: Math.max(1, beat) };
}

/** m:ss.t, as the transport shows it. */
export function clockTime(seconds: number): string {
  const tenths = Math.max(0, Math.floor(seconds * 10 + 1e-6));
  const whole = Math.floor(tenths / 10);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}.${tenths % 10}`;
}
