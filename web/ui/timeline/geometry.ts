/** Where things are on the timeline: pure functions of the view. */
import type { TimelineView } from '../../app/state';
import { lowerBound } from '../../app/snapping';
import type { KeyPose } from '../../core/types';

/** The lanes, CSS pixels, top to bottom. */
export const LANES = {
  /** Bar numbers, loop and trim. */
  ruler: { top: 0, height: 24 },
  /** Beats and downbeats, to be dragged. */
  beats: { top: 24, height: 14 },
  wave: { top: 38, height: 44 },
  onset: { top: 82, height: 14 },
  keys: { top: 96, height: 72 },
  /** What is danced, and the takes of ranges. */
  ranges: { top: 168, height: 20 },
  /** Kinetic velocity against the music; shown on demand. */
  curves: { top: 188, height: 96 },
} as const;
/** Height of the lanes that are always shown. */
export const LANES_HEIGHT = 188;
/** Width of a key pose's thumbnail. */
export const KEY_WIDTH = 52;
/** Width of a key pose without room for a thumbnail. */
export const COMPACT_WIDTH = 16;

/** Pixels from the left edge. */
export function timeToX(view: TimelineView, time: number): number {
  return (time - view.start) * view.pixelsPerSecond;
}

/** Seconds at a distance from the left edge. */
export function xToTime(view: TimelineView, x: number): number {
  return view.start + x / view.pixelsPerSecond;
}

/** A key pose to draw. */
export interface PlacedKey {
  key: KeyPose;
  x: number;
  /** No room for the thumbnail: a small diamond. */
  compact: boolean;
}

/**
 * The key poses in sight, and those to keep although out of sight (focused, dragged).
 *
 * @param keys - Ascending in time.
 */
export function placeKeys(
  keys: readonly KeyPose[],
  view: TimelineView,
  width: number,
  keep: ReadonlySet<string>,
): PlacedKey[] {
  if (view.pixelsPerSecond <= 0) return [];
  const times = keys.map((key) => key.time);
  const margin = KEY_WIDTH / view.pixelsPerSecond;
  const from = lowerBound(times, view.start - margin);
  const to = lowerBound(times, xToTime(view, width) + margin);
  const placed: PlacedKey[] = [];
  let edge = -Infinity;
  keys.forEach((key, index) => {
    const inSight = index >= from && index < to;
    if (!inSight && !keep.has(key.id)) return;
    const x = timeToX(view, key.time);
    const compact = x - KEY_WIDTH / 2 < edge - KEY_WIDTH * 0.45;
    if (!compact) edge = x + KEY_WIDTH / 2;
    placed.push({ key, x, compact });
  });
  return placed;
}

/** Every how many bars a line (and every how many a number) is drawn, so that lines stay apart. */
export function barStep(barWidth: number, minimum: number): number {
  let step = 1;
  while (barWidth * step < minimum && step < 4096) step *= 2;
  return step;
}
