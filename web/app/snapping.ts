/** Times and beats: where a pose snaps to, what a time is called. */
import { beatCount } from '../core/beat-count';
import { lowerBound } from '../core/snap';
import type { BeatGrid } from '../core/types';

export { stepBeat } from '../core/beat-count';
export { lowerBound, snapTime } from '../core/snap';

/** Bar and beat of a time, both from 1; null before the first bar or without beats. */
export function barAndBeat(grid: BeatGrid | null, time: number): { bar: number; beat: number } | null {
  if (!grid) return null;
  const bar = lowerBound(grid.downbeats, time + 1e-3);
  if (bar === 0) return null;
  const start = lowerBound(grid.beats, grid.downbeats[bar - 1] - 1e-3);
  const beat = lowerBound(grid.beats, time + 1e-3) - start;
  return { bar, beat: Math.max(1, beat) };
}

/** The beat of a time inside its bar with its fraction, from 1; null before the first bar or without beats. */
export function exactBeat(grid: BeatGrid | null, time: number): number | null {
  const place = barAndBeat(grid, time);
  if (!grid || !place) return null;
  const count = beatCount(grid);
  return Math.round((count.of(time) - count.of(grid.downbeats[place.bar - 1]) + 1) * 1000) / 1000;
}

/** The time of a beat (from 1, with fractions) in a bar (from 1); after the last bar the beats go on. */
export function timeOfBeat(grid: BeatGrid, bar: number, beat: number): number {
  const count = beatCount(grid);
  const start = grid.downbeats[bar - 1];
  return count.time(
    (start === undefined ? count.of(grid.downbeats[0] ?? 0) + (bar - 1) * grid.beatsPerBar : count.of(start)) +
      beat -
      1,
  );
}

/** m:ss.t, as the transport shows it. */
export function clockTime(seconds: number): string {
  const tenths = Math.max(0, Math.floor(seconds * 10 + 1e-6));
  const whole = Math.floor(tenths / 10);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}.${tenths % 10}`;
}
