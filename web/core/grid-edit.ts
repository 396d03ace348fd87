/**
 * Corrections of a beat grid. Every function gives a new grid that a document may hold: beats ascending and inside the song,
 * downbeats among them. Times are seconds, rounded to microseconds so that an edit and its opposite give the same numbers again.
 */
import { percentile } from './interpolate';
import { lowerBound, nearestIndex } from './snap';
import type { BeatGrid } from './types';

/** Slowest and fastest tempo of a grid, beats per minute, as the document's schema has it. */
export const GRID_TEMPO = { min: 20, max: 400 } as const;
/** Beats are never put closer together than this, seconds. */
const MIN_BEAT_GAP = 0.05;
/** So many gaps at an end of the grid tell how it goes on beyond. */
const EDGE_GAPS = 8;
/** A downbeat belongs to a beat that is this near, seconds: files may have rounded them differently. */
const SAME = 1e-3;

/** Rounded to microseconds. */
export const tidy = (seconds: number): number => Math.round(seconds * 1e6) / 1e6;

/** Seconds between beats at the start (-1) or the end (1) of a grid, where it goes on at the same pace. */
function edgeGap({ beats, tempo }: BeatGrid, side: -1 | 1): number {
  const part = side < 0 ? beats.slice(0, EDGE_GAPS + 1) : beats.slice(-EDGE_GAPS - 1);
  if (part.length < 2) return 60 / tempo;
  return percentile(
    part.slice(1).map((time, i) => time - part[i]),
    0.5,
  );
}

/**
 * The fractional beat index of a time: 0 on the first beat, 2.5 halfway between the third and the fourth; it goes on before the
 * first and after the last beat at the pace of the beats there. A grid without beats counts from 0 s at its tempo.
 */
export function beatPosition(grid: BeatGrid, time: number): number {
  const { beats } = grid;
  const last = beats.length - 1;
  if (last < 0) return (time * grid.tempo) / 60;
  if (time <= beats[0]) return (time - beats[0]) / edgeGap(grid, -1);
  if (time >= beats[last]) return last + (time - beats[last]) / edgeGap(grid, 1);
  const i = lowerBound(beats, time) - 1;
  return i + (time - beats[i]) / (beats[i + 1] - beats[i]);
}

/** The time of a fractional beat index, seconds: the inverse of {@link beatPosition}. */
export function timeAtBeat(grid: BeatGrid, position: number): number {
  const { beats } = grid;
  const last = beats.length - 1;
  if (last < 0) return (position * 60) / grid.tempo;
  if (position <= 0) return beats[0] + position * edgeGap(grid, -1);
  if (position >= last) return beats[last] + (position - last) * edgeGap(grid, 1);
  const i = Math.floor(position);
  return beats[i] + (position - i) * (beats[i + 1] - beats[i]);
}

/** Index of the beat that bar 1 begins on; 0 where no beat is a downbeat. */
export function firstBar({ beats, downbeats }: BeatGrid): number {
  for (const time of downbeats) {
    const i = nearestIndex(beats, time);
    if (i >= 0 && Math.abs(beats[i] - time) <= SAME) return i;
  }
  return 0;
}

/**
 * A grid with a bar line on every `beatsPerBar`-th beat.
 * @param beats - Ascending.
 * @param anchor - Index of a beat that a bar begins on; may lie outside the list.
 * @param tempo - Beats per minute; left out, it is that of the median gap.
 */
export function barred(
  beats: readonly number[],
  beatsPerBar: 3 | 4,
  anchor: number,
  tempo = medianTempo(beats),
): BeatGrid {
  return {
    tempo: tempo ?? 120,
    beatsPerBar,
    beats: [...beats],
    downbeats: beats.filter((_, i) => (i - anchor) % beatsPerBar === 0),
  };
}

/** Beats per minute of the median gap, to a thousandth; undefined with fewer than two beats. */
function medianTempo(beats: readonly number[]): number | undefined {
  if (beats.length < 2) return undefined;
  const tempo =
    60 /
    percentile(
      beats.slice(1).map((time, i) => time - beats[i]),
      0.5,
    );
  return Math.round(Math.min(Math.max(tempo, GRID_TEMPO.min), GRID_TEMPO.max) * 1000) / 1000;
}

/** Every second beat, those of bar 1 among them; the same grid when that would be too slow. */
export function halveGrid(grid: BeatGrid): BeatGrid {
  if (grid.beats.length < 4 || grid.tempo / 2 < GRID_TEMPO.min) return grid;
  const bar = firstBar(grid);
  const beats = grid.beats.filter((_, i) => (i - bar) % 2 === 0);
  return barred(beats, grid.beatsPerBar, beats.indexOf(grid.beats[bar]));
}

/** A beat more in the middle of every two; the same grid when that would be too fast. */
export function doubleGrid(grid: BeatGrid): BeatGrid {
  if (grid.beats.length < 2 || grid.tempo * 2 > GRID_TEMPO.max) return grid;
  const { beats } = grid;
  const denser = beats.flatMap((time, i) => (i + 1 < beats.length ? [time, tidy((time + beats[i + 1]) / 2)] : [time]));
  return barred(denser, grid.beatsPerBar, 2 * firstBar(grid));
}

/**
 * All beats later (or earlier). Those pushed out of the song go; where the grid reached an end of the song and room for a beat
 * opens there, one comes in, so that shifting back and forth is the grid again.
 * @param seconds - Positive = later.
 * @param duration - Length of the song.
 */
export function shiftGrid(grid: BeatGrid, seconds: number, duration: number): BeatGrid {
  return filled(grid, 0, seconds, duration);
}

/** Beats from index `from` on shifted; new ones where the ends of the song were reached before and no longer are. */
function filled(grid: BeatGrid, from: number, seconds: number, duration: number): BeatGrid {
  const { beats, beatsPerBar } = grid;
  if (beats.length === 0 || seconds === 0) return grid;
  const inside = (time: number): boolean => time >= 0 && time < duration;
  const moved = beats.map((time, i) => tidy(i < from ? time : time + seconds));
  const out = moved.filter(inside);
  if (out.length === 0) return grid;
  let bar = firstBar(grid) - moved.findIndex(inside);
  const [before, after] = [edgeGap(grid, -1), edgeGap(grid, 1)];
  if (from === 0 && beats[0] < before) {
    for (let time = tidy(out[0] - before); inside(time); time = tidy(time - before)) {
      out.unshift(time);
      bar += 1;
    }
  }
  if (duration - beats[beats.length - 1] <= after) {
    for (let time = tidy(out[out.length - 1] + after); inside(time); time = tidy(time + after)) out.push(time);
  }
  return barred(out, beatsPerBar, bar, grid.tempo);
}

/** Bars begin on this beat, and on every third or fourth before and after it. */
export function setBarOne(grid: BeatGrid, index: number): BeatGrid {
  return barred(grid.beats, grid.beatsPerBar, index, grid.tempo);
}

/** Three or four beats in a bar; bar 1 begins where it did. */
export function setMeter(grid: BeatGrid, beatsPerBar: 3 | 4): BeatGrid {
  return barred(grid.beats, beatsPerBar, firstBar(grid), grid.tempo);
}

/**
 * One beat somewhere else.
 * @param index - Which beat.
 * @param time - Where to, seconds; kept between its neighbours.
 * @param rest - True: all later beats go along, at the same distances; false: no other beat moves.
 * @param duration - Length of the song, seconds.
 */
export function moveBeat(grid: BeatGrid, index: number, time: number, rest: boolean, duration: number): BeatGrid {
  const { beats } = grid;
  if (!(index in beats)) return grid;
  const low = index > 0 ? beats[index - 1] + MIN_BEAT_GAP : 0;
  const end = tidy(duration - 1e-3);
  const high = rest || index + 1 === beats.length ? end : beats[index + 1] - MIN_BEAT_GAP;
  const target = tidy(low < high ? Math.min(Math.max(time, low), high) : beats[index]);
  if (target === beats[index]) return grid;
  if (rest) return filled(grid, index, target - beats[index], duration);
  const moved = beats.with(index, target);
  return barred(moved, grid.beatsPerBar, firstBar(grid));
}

/** A beat that was missed; bars are counted anew from bar 1. The same grid where a beat is already that near. */
export function insertBeat(grid: BeatGrid, time: number): BeatGrid {
  const at = tidy(time);
  const near = nearestIndex(grid.beats, at);
  if (near >= 0 && Math.abs(grid.beats[near] - at) < MIN_BEAT_GAP) return grid;
  const index = lowerBound(grid.beats, at);
  const bar = firstBar(grid);
  return barred(
    grid.beats.toSpliced(index, 0, at),
    grid.beatsPerBar,
    bar + (index <= bar && grid.beats.length > 0 ? 1 : 0),
  );
}

/** One beat less; bars are counted anew from bar 1, which the next beat takes over when its own goes. Two beats always stay. */
export function deleteBeat(grid: BeatGrid, index: number): BeatGrid {
  if (!(index in grid.beats) || grid.beats.length <= 2) return grid;
  const bar = firstBar(grid);
  return barred(grid.beats.toSpliced(index, 1), grid.beatsPerBar, bar - (index < bar ? 1 : 0));
}

/**
 * Even beats over the whole song.
 * @param period - Seconds between beats.
 * @param bar - Seconds: a time that a bar begins at.
 */
export function evenGrid(period: number, bar: number, beatsPerBar: 3 | 4, duration: number): BeatGrid {
  // A beat a microsecond before the song is the beat at 0 that rounding moved.
  const first = Math.ceil(-bar / period - 1e-6);
  const beats: number[] = [];
  for (let k = first; ; k += 1) {
    const time = Math.max(0, tidy(bar + k * period));
    if (!(time < duration)) break;
    beats.push(time);
  }
  return barred(beats, beatsPerBar, -first, Math.round((60 / period) * 1e6) / 1e6);
}

/** Even beats at a tempo that was typed in; bar 1 stays where it is. The tempo is kept within {@link GRID_TEMPO}. */
export function setTempo(grid: BeatGrid, tempo: number, duration: number): BeatGrid {
  if (!Number.isFinite(tempo)) return grid;
  const kept = Math.min(Math.max(tempo, GRID_TEMPO.min), GRID_TEMPO.max);
  return evenGrid(60 / kept, grid.beats[firstBar(grid)] ?? 0, grid.beatsPerBar, duration);
}
