/** Which stretch of a dance a moving preview shows. Pure: no DOM. */
import type { TimeRange } from '../core/document';
import type { BeatGrid } from '../core/types';
import type { FramePlan } from './options';

/** Frames per second: a GIF counts time in hundredths of a second, and six of them are a frame. */
export const LOOP_FPS = 100 / 6;
/** Pixels of the square. */
export const LOOP_SIZE = 480;
/** Seconds: what has no bars, the least, the most. */
const LENGTH = { usual: 3, least: 1.9, most: 4.2 } as const;

/**
 * The selected stretch where it is short enough, else whole bars from the one at a time on, so that it goes round on the beat.
 * @param time seconds
 * @param within the part of the song that is danced
 */
export function loopPlan(
  time: number,
  selected: TimeRange | null,
  grid: BeatGrid | null,
  within: TimeRange,
): FramePlan {
  const plan = (start: number, end: number): FramePlan => ({
    start,
    fps: LOOP_FPS,
    frames: Math.max(2, Math.round((end - start) * LOOP_FPS)),
  });
  if (selected && selected.end - selected.start <= LENGTH.most) return plan(selected.start, selected.end);
  const at = selected?.start ?? time;
  const bars = (grid?.downbeats ?? []).filter((bar) => bar >= within.start - 1e-6 && bar <= within.end + 1e-6);
  const first = bars.findLastIndex((bar) => bar <= at + 1e-3);
  // From the bar at hand; near the end of the song from as far before it as the loop is long.
  for (let from = Math.max(0, first); from >= 0; from--) {
    const to = bars.find((bar) => bar - bars[from] >= LENGTH.least && bar - bars[from] <= LENGTH.most);
    if (to !== undefined) return plan(bars[from], to);
  }
  const length = Math.min(LENGTH.usual, within.end - within.start);
  const start = Math.max(within.start, Math.min(at, within.end - length));
  return plan(start, start + length);
}
