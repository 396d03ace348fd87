/** What a range is called: by its bars where it has some, else by its times. */
import type { TimeRange } from '../core/document';
import type { BeatGrid } from '../core/types';
import { barAndBeat, clockTime } from './snapping';

/** An end this near to a beat counts as on it, seconds. */
const NEAR = 0.04;

/** The bars of a range, from 1, both included; null where its ends are on no bar lines. */
export function barsOf(grid: BeatGrid | null, { start, end }: TimeRange): { first: number; last: number } | null {
  const from = barAndBeat(grid, start + NEAR);
  const to = barAndBeat(grid, end + NEAR);
  if (!grid || !from || !to) return null;
  const onBar = (time: number) => grid.downbeats.some((downbeat) => Math.abs(downbeat - time) <= NEAR);
  // The song's end closes its last bar, on a bar line or not.
  const lastBar = to.bar === grid.downbeats.length && !onBar(end);
  if (!onBar(start) || !(onBar(end) || lastBar)) return null;
  const last = lastBar ? to.bar : to.bar - 1;
  return last < from.bar ? null : { first: from.bar, last };
}

/** Short: "5–8" for bars, "0:07.5–0:12.0" for times. */
export function shortRangeName(grid: BeatGrid | null, range: TimeRange): string {
  const bars = barsOf(grid, range);
  if (!bars) return `${clockTime(range.start)}–${clockTime(range.end)}`;
  return bars.first === bars.last ? `${bars.first}` : `${bars.first}–${bars.last}`;
}

/** In words: "bars 5–8", "bar 3", "0:07.5–0:12.0". */
export function rangeName(grid: BeatGrid | null, range: TimeRange): string {
  const bars = barsOf(grid, range);
  const name = shortRangeName(grid, range);
  return bars ? `${bars.first === bars.last ? 'bar' : 'bars'} ${name}` : name;
}
