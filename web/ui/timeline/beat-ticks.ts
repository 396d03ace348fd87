/** Which beats are shown in their lane, and what they are called: pure functions. */
import { barAndBeat } from '../../app/snapping';
import { lowerBound, nearestIndex } from '../../core/snap';
import type { BeatGrid } from '../../core/types';
import { barStep } from './geometry';

/** Beats closer than this on screen are not shown, only bars; bars closer than this are thinned out. */
const MIN_PIXELS = 12;

/** A beat to show. */
export interface Tick {
  /** Index in the grid's beats. */
  index: number;
  time: number;
  /** A bar begins here. */
  bar: boolean;
}

/**
 * The beats between two times that have room on screen.
 * @param pixelsPerSecond - Scale.
 * @param keep - Index of a beat to keep although it has no room or is out of sight; -1 = none.
 * @returns ascending in time
 */
export function visibleTicks(grid: BeatGrid, pixelsPerSecond: number, from: number, to: number, keep: number): Tick[] {
  const { beats, downbeats, tempo, beatsPerBar } = grid;
  const spacing = (60 / tempo) * pixelsPerSecond;
  if (!(pixelsPerSecond > 0)) return [];
  const found: Tick[] = [];
  const bars = new Set(downbeats);
  if (spacing >= MIN_PIXELS) {
    const last = lowerBound(beats, to);
    for (let i = lowerBound(beats, from); i < last; i += 1) {
      found.push({ index: i, time: beats[i], bar: bars.has(beats[i]) });
    }
  } else {
    const step = barStep(spacing * beatsPerBar, MIN_PIXELS);
    const last = lowerBound(downbeats, to);
    for (let i = Math.ceil(lowerBound(downbeats, from) / step) * step; i < last; i += step) {
      found.push({ index: nearestIndex(beats, downbeats[i]), time: downbeats[i], bar: true });
    }
  }
  if (keep in beats && !found.some(({ index }) => index === keep)) {
    found.push({ index: keep, time: beats[keep], bar: bars.has(beats[keep]) });
    found.sort((a, b) => a.time - b.time);
  }
  return found;
}

/** "Beat 3 of bar 12, 24.31 s". */
export function tickName(grid: BeatGrid, time: number): string {
  const place = barAndBeat(grid, time);
  return `${place ? `Beat ${place.beat} of bar ${place.bar}` : 'Beat before bar 1'}, ${time.toFixed(2)} s`;
}
