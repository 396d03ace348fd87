import { describe, expect, it } from 'vitest';
import {
  beatPosition,
  deleteBeat,
  doubleGrid,
  evenGrid,
  halveGrid,
  insertBeat,
  moveBeat,
  setBarOne,
  setMeter,
  setTempo,
  shiftGrid,
  timeAtBeat,
} from '../../web/core/grid-edit';
import type { BeatGrid } from '../../web/core/types';

/** Nine beats from 0.5 s, 0.5 s apart, bar 1 on the second. */
const grid: BeatGrid = {
  tempo: 120,
  beatsPerBar: 4,
  beats: [0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5],
  downbeats: [1, 3],
};
const SONG = 5;

describe('beats as a count', () => {
  const uneven: BeatGrid = { tempo: 100, beatsPerBar: 4, beats: [1, 1.5, 2.5, 3], downbeats: [1] };
  it('is linear between beats and goes on at the ends at the median gap there', () => {
    expect([1, 1.25, 2, 2.75].map((time) => beatPosition(uneven, time))).toEqual([0, 0.5, 1.5, 2.5]);
    expect(beatPosition(uneven, 0)).toBe(-2);
    expect(beatPosition(uneven, 4)).toBe(5);
    expect([-2, 0.5, 1.5, 5].map((position) => timeAtBeat(uneven, position))).toEqual([0, 1.25, 2, 4]);
  });
  it('counts from the start at the tempo where there are no beats, and from the only beat', () => {
    const none: BeatGrid = { tempo: 60, beatsPerBar: 4, beats: [], downbeats: [] };
    expect(beatPosition(none, 3)).toBe(3);
    expect(timeAtBeat({ ...none, beats: [2] }, 1.5)).toBe(3.5);
  });
});

describe('halving and doubling', () => {
  it('keeps the beat of bar 1 and counts bars of four anew', () => {
    expect(halveGrid(grid)).toEqual({ tempo: 60, beatsPerBar: 4, beats: [1, 2, 3, 4], downbeats: [1] });
    expect(doubleGrid(grid).beats.slice(0, 4)).toEqual([0.5, 0.75, 1, 1.25]);
    expect(doubleGrid(grid)).toMatchObject({ tempo: 240, downbeats: [1, 2, 3, 4] });
  });
  it('of a halved grid doubled gives the beats between back', () => {
    expect(doubleGrid(halveGrid(grid)).beats).toEqual([1, 1.5, 2, 2.5, 3, 3.5, 4]);
    expect(halveGrid(doubleGrid(grid))).toEqual(grid);
  });
  it('stops where the tempo would leave what a document may hold', () => {
    const slow = { ...grid, tempo: 39 };
    const fast = { ...grid, tempo: 201 };
    expect(halveGrid(slow)).toBe(slow);
    expect(doubleGrid(fast)).toBe(fast);
  });
});

describe('shifting', () => {
  it('moves beats and bar lines alike', () => {
    expect(shiftGrid(grid, 0.01, SONG)).toEqual({
      ...grid,
      beats: [0.51, 1.01, 1.51, 2.01, 2.51, 3.01, 3.51, 4.01, 4.51],
      downbeats: [1.01, 3.01],
    });
  });
  it('drops what leaves the song, and brings it in again on the way back', () => {
    const full = evenGrid(0.5, 1, 4, SONG);
    const away = shiftGrid(full, -0.02, SONG);
    expect(away.beats).toEqual([0.48, 0.98, 1.48, 1.98, 2.48, 2.98, 3.48, 3.98, 4.48, 4.98]);
    expect(away.downbeats).toEqual([0.98, 2.98, 4.98]);
    expect(shiftGrid(away, 0.02, SONG)).toEqual(full);
  });
  it('puts no beats into a silence that the analysis left free', () => {
    const late: BeatGrid = { tempo: 120, beatsPerBar: 4, beats: [2, 2.5, 3], downbeats: [2] };
    expect(shiftGrid(late, 0.1, 10).beats).toEqual([2.1, 2.6, 3.1]);
  });
});

describe('bars', () => {
  it('begin where they are told to, before and after', () => {
    expect(setBarOne(grid, 6).downbeats).toEqual([1.5, 3.5]);
    expect(setBarOne(grid, 6).beats).toEqual(grid.beats);
  });
  it('have three beats or four', () => {
    expect(setMeter(grid, 3)).toMatchObject({ beatsPerBar: 3, downbeats: [1, 2.5, 4], tempo: 120 });
    expect(setMeter(setMeter(grid, 3), 4)).toEqual(grid);
  });
});

describe('one beat', () => {
  it('moves alone, between its neighbours', () => {
    const moved = moveBeat(grid, 3, 2.1, false, SONG);
    expect(moved.beats).toEqual([0.5, 1, 1.5, 2.1, 2.5, 3, 3.5, 4, 4.5]);
    expect(moved.downbeats).toEqual([1, 3]);
    expect(moveBeat(grid, 3, 9, false, SONG).beats[3]).toBe(2.45);
    expect(moveBeat(grid, 3, 0, false, SONG).beats[3]).toBe(1.55);
    expect(moveBeat(grid, 0, -3, false, SONG).beats[0]).toBe(0);
  });
  it('takes its bar line along', () => {
    expect(moveBeat(grid, 5, 3.2, false, SONG).downbeats).toEqual([1, 3.2]);
  });
  it('takes all later beats along when asked to', () => {
    const moved = moveBeat(grid, 3, 2.2, true, SONG);
    expect(moved.beats).toEqual([0.5, 1, 1.5, 2.2, 2.7, 3.2, 3.7, 4.2, 4.7]);
    expect(moved.downbeats).toEqual([1, 3.2]);
    expect(moved.tempo).toBe(120);
    const early = moveBeat(grid, 3, 1.7, true, SONG);
    expect(early.beats).toEqual([0.5, 1, 1.5, 1.7, 2.2, 2.7, 3.2, 3.7, 4.2, 4.7]);
  });
  it('that was missed comes in, and the bars behind it are counted anew', () => {
    const missed: BeatGrid = { ...grid, beats: [0.5, 1, 1.5, 2.5, 3, 3.5, 4, 4.5], downbeats: [1, 3.5] };
    expect(insertBeat(missed, 2)).toEqual(grid);
    expect(insertBeat(grid, 2.04)).toBe(grid);
    expect(insertBeat(grid, 0.2).downbeats).toEqual([1, 3]);
  });
  it('that was none goes', () => {
    const extra = insertBeat(grid, 1.8);
    expect(extra.downbeats).toEqual([1, 2.5, 4.5]);
    expect(deleteBeat(extra, 3)).toEqual(grid);
    expect(deleteBeat(grid, 0).downbeats).toEqual([1, 3]);
    expect(deleteBeat(grid, 1).downbeats).toEqual([1.5, 3.5]);
    expect(deleteBeat({ ...grid, beats: [1, 2] }, 0).beats).toEqual([1, 2]);
  });
});

describe('a typed tempo', () => {
  it('makes even beats over the whole song and leaves bar 1 in its place', () => {
    expect(setTempo(grid, 60, SONG)).toEqual({ tempo: 60, beatsPerBar: 4, beats: [0, 1, 2, 3, 4], downbeats: [1] });
    const odd = setTempo(grid, 90, SONG);
    expect(odd.beats).toEqual([0.333333, 1, 1.666667, 2.333333, 3, 3.666667, 4.333333]);
    expect(odd.downbeats).toEqual([1, 3.666667]);
  });
  it('is kept within what a document may hold', () => {
    expect(setTempo(grid, 1000, SONG).tempo).toBe(400);
    expect(setTempo(grid, 1, SONG).tempo).toBe(20);
    expect(setTempo(grid, NaN, SONG)).toBe(grid);
  });
});
