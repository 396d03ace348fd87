import { describe, expect, it } from 'vitest';
import { doubleGrid, evenGrid, halveGrid, moveBeat, setTempo, shiftGrid } from '../../web/core/grid-edit';
import { followBeats, rippleKeys, rippleRanges } from '../../web/core/grid-ripple';
import type { KeyPose } from '../../web/core/types';

const SONG = 60;
const grid = evenGrid(0.5, 0, 4, SONG);
const key = (id: string, time: number, locked = false): KeyPose => ({
  id,
  time,
  rotations: [],
  ...(locked ? { locked: true as const } : {}),
});
const times = (keys: KeyPose[]) => keys.map(({ id, time }) => [id, time]);

describe('followBeats', () => {
  it('keeps a moment on its beat', () => {
    const warp = followBeats(grid, setTempo(grid, 100, SONG), 0);
    expect([0, 0.5, 1.25, 10].map(warp).map((time) => Math.round(time * 1e4) / 1e4)).toEqual([0, 0.6, 1.5, 12]);
  });
  it('leaves the music where it is when the same music is counted at another level', () => {
    for (const after of [doubleGrid(grid), halveGrid(grid), setTempo(grid, 40, SONG)]) {
      const warp = followBeats(grid, after, 20);
      for (const time of [0, 3.5, 20, 41.25]) expect(warp(time)).toBeCloseTo(time, 4);
    }
  });
  it('moves only what lies beside a dragged beat', () => {
    const warp = followBeats(grid, moveBeat(grid, 4, 2.2, false, SONG), 0);
    expect([1.5, 1.75, 2, 2.25, 2.5, 9].map((time) => Math.round(warp(time) * 1e6) / 1e6)).toEqual([
      1.5, 1.85, 2.2, 2.35, 2.5, 9,
    ]);
  });
  it('is no whole beat off after beats were pushed out at the start', () => {
    const earlier = shiftGrid(grid, -0.2, SONG);
    expect(earlier.beats[0]).toBe(0.3);
    expect(followBeats(grid, earlier, 30)(10)).toBeCloseTo(9.8, 6);
  });
});

describe('rippled key poses', () => {
  it('move with their beats, locked ones do not', () => {
    const keys = [key('a', 1), key('b', 2, true), key('c', 3)];
    expect(times(rippleKeys(keys, (time) => time * 1.2, SONG))).toEqual([
      ['a', 1.2],
      ['b', 2],
      ['c', 3.6],
    ]);
    expect(rippleKeys(keys, (time) => time, SONG)).toBe(keys);
  });
  it('are sorted anew when one passes a locked one', () => {
    const keys = [key('a', 1), key('b', 1.2, true)];
    expect(times(rippleKeys(keys, (time) => time + 1, SONG))).toEqual([
      ['b', 1.2],
      ['a', 2],
    ]);
  });
  it('are all kept, in order, when they are pushed to an end of the song', () => {
    const keys = [key('a', 57), key('b', 58), key('c', 59)];
    const moved = rippleKeys(keys, (time) => time + 5, SONG);
    expect(moved.map(({ id, time }) => [id, Math.round(time * 30)])).toEqual([
      ['a', 1797],
      ['b', 1798],
      ['c', 1799],
    ]);
  });
  it('give way to a locked one on their frame', () => {
    const moved = rippleKeys([key('a', 1), key('b', 2, true)], () => 2, SONG);
    expect(new Set(moved.map(({ time }) => Math.round(time * 30))).size).toBe(2);
    expect(moved.find(({ id }) => id === 'b')!.time).toBe(2);
  });
});

describe('rippled ranges', () => {
  const range = (start: number, end: number) => ({ id: 'r1', start, end, takes: [], chosen: null });
  it('keep their beats, unless nothing would be left of them', () => {
    expect(rippleRanges([range(4, 8)], (time) => time * 1.1, SONG)).toEqual([range(4.4, 8.8)]);
    expect(rippleRanges([range(58, 60)], (time) => time + 5, SONG)).toEqual([range(58, 60)]);
    const still = [range(4, 8)];
    expect(rippleRanges(still, (time) => time, SONG)).toBe(still);
  });
});
