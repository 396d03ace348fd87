/** Where things are on the timeline: pure functions of the view. */
import type { TimelineView } from '../../app/state';
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
/** Widths that a key pose's thumbnail can have, CSS pixels, ascending. */
const KEY_WIDTHS = [28, 36, 44, 52];
/** Width of a key pose's thumbnail where there is room. */
export const KEY_WIDTH = 52;
/** Width of a key pose without room for a thumbnail. */
export const COMPACT_WIDTH = 16;
/** Key poses without a thumbnail that are closer to the one before are only drawn, CSS pixels. */
const MIN_MARK_GAP = 9;

/** Pixels from the left edge. */
export function timeToX(view: TimelineView, time: number): number {
  return (time - view.start) * view.pixelsPerSecond;
}

/** Seconds at a distance from the left edge. */
export function xToTime(view: TimelineView, x: number): number {
  return view.start + x / view.pixelsPerSecond;
}

/** How wide each key pose is at a scale: a thumbnail's width, COMPACT_WIDTH for a diamond, 0 for a mark that is only drawn. */
export function keyWidths(keys: readonly KeyPose[], pixelsPerSecond: number): number[] {
  let mark = -Infinity;
  return keys.map((key, i) => {
    const before = i > 0 ? key.time - keys[i - 1].time : Infinity;
    const after = i + 1 < keys.length ? keys[i + 1].time - key.time : Infinity;
    const room = Math.min(before, after) * pixelsPerSecond - 2;
    const picture = KEY_WIDTHS.findLast((width) => width <= room);
    const x = key.time * pixelsPerSecond;
    if (!picture && x - mark < MIN_MARK_GAP) return 0;
    mark = x;
    return picture ?? COMPACT_WIDTH;
  });
}

/** A key pose to draw. */
export interface PlacedKey {
  key: KeyPose;
  /** Its place in the list. */
  index: number;
  width: number;
}

/** A stretch of the timeline that is kept ready, in pixels from the song's start at the scale in force. */
export interface Stretch {
  from: number;
  to: number;
}

/** The timeline renders anew when the view has moved by this much, CSS pixels. */
const STRETCH_STEP = 256;

/** What is in sight and a little on both sides; the same for neighbouring views, so that panning renders rarely. */
export function stretchInSight(view: TimelineView, width: number): Stretch {
  const page = Math.floor((view.start * view.pixelsPerSecond) / STRETCH_STEP);
  return {
    from: page * STRETCH_STEP - KEY_WIDTH,
    to: (page + 1) * STRETCH_STEP + width + KEY_WIDTH,
  };
}

/**
 * The key poses that are elements: those in a stretch, and those to keep although out of sight or without room (focused, dragged).
 *
 * @param keys - Ascending in time.
 * @param widths - Of {@link keyWidths} at the same scale.
 */
export function placeKeys(
  keys: readonly KeyPose[],
  widths: readonly number[],
  pixelsPerSecond: number,
  stretch: Stretch,
  keep: ReadonlySet<string>,
): PlacedKey[] {
  if (pixelsPerSecond <= 0) return [];
  const placed: PlacedKey[] = [];
  keys.forEach((key, index) => {
    const x = key.time * pixelsPerSecond;
    const shown = widths[index] > 0 && x >= stretch.from && x < stretch.to;
    if (shown || keep.has(key.id)) placed.push({ key, index, width: widths[index] || COMPACT_WIDTH });
  });
  return placed;
}

/** Every how many bars a line (and every how many a number) is drawn, so that lines stay apart. */
export function barStep(barWidth: number, minimum: number): number {
  let step = 1;
  while (barWidth * step < minimum && step < 4096) step *= 2;
  return step;
}
