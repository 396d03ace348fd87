/** What a change of the beats does to things that were placed on them. */
import { frameOf, type TakeRange } from './document';
import { beatPosition, tidy, timeAtBeat } from './grid-edit';
import spec from './spec.json';
import type { BeatGrid, KeyPose } from './types';

/** Where a moment on the former beats goes on the new ones, seconds to seconds. */
export type Warp = (time: number) => number;

/** New beats per former beat that are the same music counted otherwise. */
const LEVELS = [1, 2, 1 / 2, 3, 1 / 3, 4, 1 / 4] as const;
const LEVEL_NEAR = 0.12;
/** A range is never made shorter than this, seconds. */
const SHORTEST_RANGE = 0.1;
/** A shorter way than this is none, seconds. */
const UNMOVED = 1e-5;

/**
 * Keeps every moment on its beat when one grid takes the place of another. Where the new grid counts the same music twice as fast
 * (or half, three, four times), a beat becomes two, so that nothing runs away from the music.
 *
 * @param anchor - Seconds, where both grids are sure to speak of the same music: around it, the beats of both that lie closest together are taken for the same.
 */
export function followBeats(before: BeatGrid, after: BeatGrid, anchor: number): Warp {
  const [from, to] = meetingBeats(before, after, anchor);
  const gap = (grid: BeatGrid, beat: number): number => timeAtBeat(grid, beat + 2) - timeAtBeat(grid, beat - 2);
  const ratio = gap(before, from) / gap(after, to);
  const level = LEVELS.find((each) => Math.abs(Math.log(ratio / each)) < LEVEL_NEAR) ?? 1;
  return (time) => timeAtBeat(after, to + level * (beatPosition(before, time) - from));
}

/** The beats of both grids that lie closest together, looked for around a time. */
function meetingBeats(before: BeatGrid, after: BeatGrid, anchor: number): [from: number, to: number] {
  const middle = Math.round(beatPosition(before, anchor));
  let best: [number, number] = [middle, Math.round(beatPosition(after, timeAtBeat(before, middle)))];
  let least = Infinity;
  for (const step of [0, -1, 1, -2, 2, -3, 3]) {
    const time = timeAtBeat(before, middle + step);
    const to = Math.round(beatPosition(after, time));
    const apart = Math.abs(timeAtBeat(after, to) - time);
    if (apart < least - UNMOVED) [best, least] = [[middle + step, to], apart];
  }
  return best;
}

/**
 * Key poses moved along; locked ones stay at their time, and none is lost: where two would meet on one frame, one takes the nearest
 * free frame, and all keep their order.
 *
 * @param keys - Ascending in time.
 * @param duration - Length of the song, seconds.
 * @returns ascending in time; the same list when none moves
 */
export function rippleKeys(keys: readonly KeyPose[], warp: Warp, duration: number): KeyPose[] {
  const last = Math.max(0, Math.ceil(duration * spec.fps) - 1);
  const taken = new Set(keys.filter((key) => key.locked).map((key) => frameOf(key.time)));
  const places = keys
    .filter((key) => !key.locked)
    .map((key) => {
      const time = tidy(Math.min(Math.max(warp(key.time), 0), last / spec.fps));
      const frame = freeFrame(frameOf(time), last, taken);
      taken.add(frame);
      return frame === frameOf(time) ? time : frame / spec.fps;
    })
    .sort((a, b) => a - b);
  let next = 0;
  let changed = false;
  const moved = keys.map((key) => {
    if (key.locked) return key;
    const time = places[next++];
    if (Math.abs(time - key.time) < UNMOVED) return key;
    changed = true;
    return { ...key, time };
  });
  return changed ? moved.sort((a, b) => a.time - b.time) : (keys as KeyPose[]);
}

/** The free frame nearest to one, inside 0..last; the frame itself when all are taken. */
function freeFrame(frame: number, last: number, taken: ReadonlySet<number>): number {
  for (let step = 0; step <= last; step += 1) {
    for (const each of [frame + step, frame - step]) if (each >= 0 && each <= last && !taken.has(each)) return each;
  }
  return frame;
}

/** Ranges moved along; one that would shrink to nothing at an end of the song stays as it is. The same list when none moves. */
export function rippleRanges(ranges: readonly TakeRange[], warp: Warp, duration: number): TakeRange[] {
  let changed = false;
  const moved = ranges.map((range) => {
    const [start, end] = [range.start, range.end].map((time) => tidy(Math.min(Math.max(warp(time), 0), duration)));
    const still = Math.abs(start - range.start) < UNMOVED && Math.abs(end - range.end) < UNMOVED;
    if (still || end - start < SHORTEST_RANGE) return range;
    changed = true;
    return { ...range, start, end };
  });
  return changed ? moved : (ranges as TakeRange[]);
}
