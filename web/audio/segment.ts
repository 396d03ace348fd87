/** How the song lies on a clock: pure, so that sounds that go with it are laid by the same rule. */

/** A stretch of the song, seconds. */
export interface LoopRange {
  start: number;
  end: number;
}

/** From `from` on (seconds of its clock) the song runs from `position` at `rate`, and stops at `end` unless it loops before. */
export interface Segment {
  clock: 'audio' | 'timer';
  from: number;
  position: number;
  rate: number;
  loop: LoopRange | null;
  /** Seconds of the song. */
  end: number;
}

/** Where in the song a segment is at a time of its clock, seconds. */
export function positionAt(segment: Segment, at: number): number {
  const { from, position, rate, loop, end } = segment;
  const run = position + Math.max(0, at - from) * rate;
  if (!loop || position >= loop.end || run < loop.end) return Math.min(run, end);
  return loop.start + ((run - loop.start) % (loop.end - loop.start));
}

/** A stretch of the song as it is played: song times [start, end) begin at `at` of the clock. */
export interface Pass {
  start: number;
  end: number;
  at: number;
}

/**
 * The song as it is played between two times of the clock: one pass, or several around a loop.
 * @param until - Not before `after`.
 */
export function passes(segment: Segment, after: number, until: number): Pass[] {
  const { from, position, rate, loop, end } = segment;
  const found: Pass[] = [];
  const add = (start: number, stop: number, at: number): void => {
    const begin = Math.max(start, start + (after - at) * rate);
    const finish = Math.min(stop, start + (until - at) * rate);
    if (begin < finish) found.push({ start: begin, end: finish, at: at + (begin - start) / rate });
  };
  if (!loop || position >= loop.end) {
    add(position, end, from);
    return found;
  }
  add(position, loop.end, from);
  const length = (loop.end - loop.start) / rate;
  const first = from + (loop.end - position) / rate;
  const skip = Math.max(0, Math.floor((after - first) / length));
  for (let at = first + skip * length; at < until; at += length) add(loop.start, loop.end, at);
  return found;
}
