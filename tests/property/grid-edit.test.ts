import fc from 'fast-check';
import * as v from 'valibot';
import { describe, expect, it } from 'vitest';
import { gridSchema } from '../../web/core/document-schema';
import {
  beatPosition,
  deleteBeat,
  doubleGrid,
  halveGrid,
  insertBeat,
  moveBeat,
  setBarOne,
  setMeter,
  setTempo,
  shiftGrid,
  timeAtBeat,
} from '../../web/core/grid-edit';
import { followBeats, rippleKeys } from '../../web/core/grid-ripple';
import { tapGrid } from '../../web/core/grid-tap';
import type { BeatGrid } from '../../web/core/types';

const DURATION = 40;
const number = (min: number, max: number) => fc.double({ min, max, noNaN: true });

/** What an analysis may give: uneven beats, somewhere in the song. */
const grids = fc
  .record({
    start: number(0, 10),
    gaps: fc.array(number(0.3, 1), { minLength: 1, maxLength: 24 }),
    beatsPerBar: fc.constantFrom(3 as const, 4 as const),
    first: fc.nat(3),
  })
  .map(({ start, gaps, beatsPerBar, first }): BeatGrid => {
    const beats = [start];
    for (const gap of gaps) beats.push(beats[beats.length - 1] + gap);
    return {
      tempo: 100,
      beatsPerBar,
      beats,
      downbeats: beats.filter((_, i) => i % beatsPerBar === first % beatsPerBar),
    };
  });

type Edit = (grid: BeatGrid) => BeatGrid;
const edits: fc.Arbitrary<Edit> = fc.oneof(
  fc.constantFrom<Edit>(
    halveGrid,
    doubleGrid,
    (grid) => setMeter(grid, 3),
    (grid) => setMeter(grid, 4),
  ),
  number(-3, 3).map(
    (seconds): Edit =>
      (grid) =>
        shiftGrid(grid, seconds, DURATION),
  ),
  fc.nat(40).map(
    (index): Edit =>
      (grid) =>
        setBarOne(grid, index),
  ),
  fc.nat(40).map(
    (index): Edit =>
      (grid) =>
        deleteBeat(grid, index),
  ),
  number(0, DURATION - 1e-3).map(
    (time): Edit =>
      (grid) =>
        insertBeat(grid, time),
  ),
  number(-10, 1000).map(
    (tempo): Edit =>
      (grid) =>
        setTempo(grid, tempo, DURATION),
  ),
  fc.tuple(fc.nat(40), number(-5, 50), fc.boolean()).map(
    ([index, time, rest]): Edit =>
      (grid) =>
        moveBeat(grid, index, time, rest, DURATION),
  ),
  fc.array(number(0, DURATION), { maxLength: 20 }).map(
    (taps): Edit =>
      (grid) =>
        tapGrid(taps, grid, DURATION) ?? grid,
  ),
  fc.tuple(number(0.2, 2), number(0, 20), fc.array(number(-0.06, 0.06), { minLength: 4, maxLength: 12 })).map(
    ([period, from, noise]): Edit =>
      (grid) =>
        tapGrid(
          noise.map((off, i) => from + i * period + off),
          grid,
          DURATION,
        ) ?? grid,
  ),
);

describe('a grid', () => {
  it('stays one that a document may hold, whatever is done to it', () => {
    fc.assert(
      fc.property(grids, fc.array(edits, { maxLength: 8 }), (start, list) => {
        const grid = list.reduce((now, edit) => edit(now), start);
        expect(v.is(gridSchema, grid)).toBe(true);
        expect(
          grid.beats.every((time, i) => time >= 0 && time < DURATION && (i === 0 || time > grid.beats[i - 1])),
        ).toBe(true);
        expect(grid.downbeats.every((time) => grid.beats.includes(time))).toBe(true);
        const bars = grid.downbeats.map((time) => grid.beats.indexOf(time));
        expect(bars.every((index, i) => i === 0 || index - bars[i - 1] === grid.beatsPerBar)).toBe(true);
      }),
    );
  });
  it('counts beats and seconds there and back', () => {
    fc.assert(
      fc.property(grids, number(-20, 60), (grid, time) => {
        expect(timeAtBeat(grid, beatPosition(grid, time))).toBeCloseTo(time, 6);
      }),
    );
    fc.assert(
      fc.property(grids, number(-20, 60), (grid, position) => {
        expect(beatPosition(grid, timeAtBeat(grid, position))).toBeCloseTo(position, 6);
      }),
    );
  });
  it('warps key poses without losing one, in order, one to a frame', () => {
    const keys = fc.uniqueArray(fc.record({ frame: fc.nat(DURATION * 30 - 1), locked: fc.boolean() }), {
      selector: ({ frame }) => frame,
      maxLength: 30,
    });
    fc.assert(
      fc.property(grids, edits, keys, number(0, DURATION), (before, edit, places, anchor) => {
        const list = places
          .sort((a, b) => a.frame - b.frame)
          .map(({ frame, locked }, i) => ({
            id: `k${i}`,
            time: frame / 30,
            rotations: [],
            ...(locked ? { locked: true as const } : {}),
          }));
        const moved = rippleKeys(list, followBeats(before, edit(before), anchor), DURATION);
        expect(new Set(moved.map(({ id }) => id))).toEqual(new Set(list.map(({ id }) => id)));
        const frames = moved.map(({ time }) => Math.round(time * 30));
        expect(
          frames.every((frame, i) => frame >= 0 && frame < DURATION * 30 && (i === 0 || frame > frames[i - 1])),
        ).toBe(true);
        const free = (all: typeof list) => all.filter(({ locked }) => !locked).map(({ id }) => id);
        expect(free(moved as typeof list)).toEqual(free(list));
        for (const key of list.filter(({ locked }) => locked)) expect(moved).toContain(key);
      }),
    );
  });
});
