/** What the picture of two dances shows and where: pure geometry, pixels. */
import { lowerBound } from '../../app/snapping';
import type { LoopRange } from '../../audio/player';
import type { TimelineView } from '../../app/state';
import type { BeatGrid } from '../../core/types';

/** Longest stretch that strips of figures can show, and the shortest that is worth it, seconds. */
export const STRETCH = { longest: 12, usual: 10, shortest: 3 } as const;
/** Most figures of a strip. */
export const MOST_FIGURES = 18;

/** The picture, pixels; the strips' time axis runs from `left` to `right`. */
export const PAGE = {
  width: 2400,
  height: 1172,
  margin: 72,
  left: 372,
  right: 2304,
  music: { top: 168, height: 170 },
  strips: [
    { top: 362, height: 312 },
    { top: 698, height: 312 },
  ],
  axis: { top: 1018 },
  legend: { top: 1108 },
  figure: 264,
} as const;

/** Which stretch of the song, and how it was chosen. */
export interface Stretch {
  start: number;
  end: number;
  why: 'loop' | 'view' | 'playhead';
}

/** The loop, else what the timeline shows if that is short enough, else some bars from the playhead on. */
export function chooseStretch(now: {
  loop: LoopRange | null;
  view: TimelineView;
  viewWidth: number;
  time: number;
  duration: number;
  grid: BeatGrid | null;
}): Stretch {
  const { loop, view, viewWidth, time, duration, grid } = now;
  if (loop && loop.end - loop.start >= STRETCH.shortest) {
    return { start: loop.start, end: Math.min(loop.end, loop.start + STRETCH.longest), why: 'loop' };
  }
  const start = Math.max(0, view.start);
  const end = Math.min(duration, view.start + viewWidth / Math.max(view.pixelsPerSecond, 1e-6));
  if (end - start <= STRETCH.longest && end - start >= STRETCH.shortest) return { start, end, why: 'view' };
  const downbeats = grid?.downbeats ?? [];
  const bar = downbeats[Math.max(0, lowerBound(downbeats, time + 1e-3) - 1)] ?? time;
  const begin = Math.max(0, Math.min(bar <= time ? bar : time, duration - STRETCH.usual));
  return { start: begin, end: Math.min(duration, begin + STRETCH.usual), why: 'playhead' };
}

/**
 * Times of a strip's figures: every key pose, and evenly in the gaps between them as many more as have room.
 * @param range seconds
 * @param keys times of the key poses, ascending; those outside the range do not count
 * @param most figures; more key poses than that are thinned out evenly
 */
export function stripTimes(
  range: { start: number; end: number },
  keys: readonly number[],
  most = MOST_FIGURES,
): { time: number; key: boolean }[] {
  const inside = keys.filter((time) => time >= range.start && time < range.end);
  const chosen =
    inside.length > most
      ? Array.from({ length: most }, (_, i) => inside[Math.floor((i * inside.length) / most)])
      : inside;
  const cell = (range.end - range.start) / most;
  // A figure at a border stands half a cell inside, so half a cell is missing from each outer gap.
  const borders = [range.start - cell / 2, ...chosen, range.end + cell / 2];
  const gaps = borders.slice(1).map((to, i) => ({ from: borders[i], to, more: 0 }));
  for (let room = most - chosen.length; room > 0; room--) {
    const widest = gaps.reduce((best, gap) => (spacing(gap) > spacing(best) ? gap : best));
    if (spacing(widest) < cell) break;
    widest.more++;
  }
  const times = chosen.map((time) => ({ time, key: true }));
  for (const { from, to, more } of gaps)
    for (let i = 1; i <= more; i++) times.push({ time: from + ((to - from) * i) / (more + 1), key: false });
  return times.sort((a, b) => a.time - b.time);
}

/** Distance between the figures of a gap if it got one more. */
const spacing = (gap: { from: number; to: number; more: number }) => (gap.to - gap.from) / (gap.more + 2);

/** Pixels of a time. */
export function pictureX(range: { start: number; end: number }, time: number): number {
  return PAGE.left + ((time - range.start) / (range.end - range.start)) * (PAGE.right - PAGE.left);
}
