/** Times that key poses snap to. */
import type { BeatGrid, Snap } from './types';

/** Index of the first value >= time in an ascending list. */
export function lowerBound(list: ArrayLike<number>, time: number): number {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Index of the value nearest to a time in an ascending list, the earlier one of two as near; -1 in an empty list. */
export function nearestIndex(list: ArrayLike<number>, time: number): number {
  const after = Math.min(lowerBound(list, time), list.length - 1);
  const before = Math.max(0, after - 1);
  if (after < 0) return -1;
  return Math.abs(list[after] - time) < Math.abs(time - list[before]) ? after : before;
}

const halves = new WeakMap<BeatGrid, readonly number[]>();

/**
 * All times of a grid that a key pose can snap to.
 *
 * @param grid - Beats of the song, or null while there are none.
 * @param snap - Bars are the downbeats (the beats where there is no downbeat), half beats lie between two beats.
 * @returns Seconds, ascending; empty without beats or with snapping off.
 */
export function gridTimes(grid: BeatGrid | null, snap: Snap): readonly number[] {
  if (!grid || snap === 'off') return [];
  if (snap === 'bar' && grid.downbeats.length > 0) return grid.downbeats;
  if (snap !== 'half') return grid.beats;
  let times = halves.get(grid);
  if (!times) {
    times = grid.beats.flatMap((beat, i, all) => (i === all.length - 1 ? [beat] : [beat, (beat + all[i + 1]) / 2]));
    halves.set(grid, times);
  }
  return times;
}

/** The nearest time that key poses snap to; the time itself without beats or with snapping off. */
export function snapTime(grid: BeatGrid | null, time: number, snap: Snap): number {
  const times = gridTimes(grid, snap);
  return times[nearestIndex(times, time)] ?? time;
}
