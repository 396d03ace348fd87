import { describe, expect, it } from 'vitest';
import {
  copyKeysBy,
  deleteKeys,
  distributeKeys,
  duplicateKeys,
  lastKeyTime,
  nudgeKeys,
  pasteKeys,
  setStrength,
  settleKeys,
  shiftKeys,
  shiftKeysByBeats,
  toggleLock,
} from '../../web/core/key-ops';
import { stepBeat } from '../../web/core/beat-count';
import { gridTimes, snapTime } from '../../web/core/snap';
import type { BeatGrid, KeyPose } from '../../web/core/types';

/** Beats every half second from 0 to 20 s, bars of four from 0. */
const beats = Array.from({ length: 41 }, (_, i) => i / 2);
const grid: BeatGrid = { tempo: 120, beatsPerBar: 4, beats, downbeats: beats.filter((_, i) => i % 4 === 0) };
const space = { duration: 20, grid };
const key = (id: string, time: number, more: Partial<KeyPose> = {}): KeyPose => ({ id, time, rotations: [], ...more });
const ids = (...list: string[]) => new Set(list);
const places = (keys: readonly KeyPose[]) => keys.map(({ id, time }) => [id, time]);

describe('snapping', () => {
  it('goes to bars, beats, half beats or nowhere', () => {
    expect((['bar', 'beat', 'half', 'off'] as const).map((snap) => snapTime(grid, 2.8, snap))).toEqual([
      2, 3, 2.75, 2.8,
    ]);
    expect(snapTime(null, 2.8, 'beat')).toBe(2.8);
  });
  it('puts half beats between beats of a changing tempo, and keeps the beats as they are', () => {
    const slowing: BeatGrid = { tempo: 100, beatsPerBar: 4, beats: [1, 1.5, 2.1, 2.8, 3.6], downbeats: [1, 3.6] };
    const halves = gridTimes(slowing, 'half');
    expect(halves.filter((_, i) => i % 2 === 0)).toEqual(slowing.beats);
    expect(halves[3]).toBeCloseTo(1.8, 12);
  });
  it('steps on at the local tempo where there are no beats', () => {
    expect(stepBeat(grid, 20, 1)).toBeCloseTo(20.5, 9);
    expect(stepBeat(null, 3, -1)).toBe(2.5);
  });
});

describe('settleKeys', () => {
  it('replaces what is on the frame, but not a locked key pose: then it goes beside', () => {
    expect(places(settleKeys([key('a', 1), key('b', 2)], [key('c', 2)], 20))).toEqual([
      ['a', 1],
      ['c', 2],
    ]);
    const beside = settleKeys([key('b', 2, { locked: true })], [key('c', 2)], 20);
    expect(places(beside)).toEqual([
      ['b', 2],
      ['c', 61 / 30],
    ]);
  });
  it('keeps two that land on one frame, and all inside the song', () => {
    const [a, b] = settleKeys([], [key('a', 25), key('b', 30)], 20);
    expect(a.time).toBeCloseTo(598 / 30, 9);
    expect(b.time).toBe(lastKeyTime(20));
  });
  it('drops what no frame is left for', () => {
    expect(settleKeys([key('a', 0, { locked: true })], [key('b', 0)], 1 / 30)).toHaveLength(1);
  });
});

describe('moving', () => {
  const keys = [key('a', 1), key('b', 2), key('c', 5, { locked: true }), key('d', 8)];

  it('moves several by the same and stops them together at the ends', () => {
    expect(places(shiftKeys(keys, ids('a', 'b'), 0.25, 20))).toEqual([
      ['a', 1.25],
      ['b', 2.25],
      ['c', 5],
      ['d', 8],
    ]);
    expect(places(shiftKeys(keys, ids('a', 'b'), -9, 20)).slice(0, 2)).toEqual([
      ['a', 0],
      ['b', 1],
    ]);
  });
  it('by beats keeps places in the bar where the tempo changes', () => {
    const faster = [...Array.from({ length: 9 }, (_, i) => i), ...Array.from({ length: 8 }, (_, i) => 8.5 + i / 2)];
    const two = { duration: 12, grid: { tempo: 60, beatsPerBar: 4 as const, beats: faster, downbeats: [0, 4, 8] } };
    const moved = shiftKeysByBeats([key('a', 4), key('b', 6)], ids('a', 'b'), 6, two);
    expect(places(moved)).toEqual([
      ['a', 9],
      ['b', 10],
    ]);
  });
  it('by beats stops at whole beats at the ends', () => {
    const moved = shiftKeysByBeats([key('a', 1.25), key('b', 2)], ids('a', 'b'), -8, space);
    expect(moved[0].time).toBeCloseTo(0.25, 9);
    expect(moved[1].time).toBe(1);
  });
  it('leaves locked ones where they are and gives the same list when nothing moves', () => {
    expect(shiftKeys(keys, ids('c'), 1, 20)).toBe(keys);
    expect(shiftKeysByBeats(keys, ids('c'), 1, space)).toBe(keys);
    expect(nudgeKeys(keys, ids('c'), 1, 'beat', space)).toBe(keys);
    expect(nudgeKeys([key('a', 0)], ids('a'), -1, 'frame', space)[0].time).toBe(0);
  });
  it('nudges by a frame or to the next beat, the others as far', () => {
    expect(places(nudgeKeys([key('a', 1)], ids('a'), 1, 'frame', space))).toEqual([['a', 31 / 30]]);
    const nudged = nudgeKeys([key('a', 1.25), key('b', 3)], ids('a', 'b'), 1, 'beat', space);
    expect(nudged[0].time).toBe(1.5);
    expect(nudged[1].time).toBeCloseTo(3.25, 6);
  });
  it('hops over what is in the way', () => {
    const row = [key('a', 1), key('b', 1.5), key('c', 2)];
    expect(places(nudgeKeys(row, ids('a'), 1, 'beat', space))).toEqual([
      ['b', 1.5],
      ['c', 2],
      ['a', 2.5],
    ]);
    expect(nudgeKeys([key('a', 0), key('b', 0.5)], ids('b'), -1, 'beat', space).map((each) => each.time)).toEqual([
      0, 0.5,
    ]);
  });
});

describe('copying', () => {
  const keys = [key('k1', 1), key('k2', 2, { locked: true, strength: 0.5 }), key('k3', 9)];

  it('by a drag: new ids, unlocked, originals stay', () => {
    const { keys: next, added } = copyKeysBy(keys, ids('k1', 'k2'), { beats: 4 }, space);
    expect(added).toEqual(['k4', 'k5']);
    expect(places(next)).toEqual([
      ['k1', 1],
      ['k2', 2],
      ['k4', 3],
      ['k5', 4],
      ['k3', 9],
    ]);
    expect(next[3]).toEqual({ id: 'k5', time: 4, rotations: [], strength: 0.5 });
  });
  it('duplicates by one bar, or by as many as the selection spans', () => {
    expect(places(duplicateKeys(keys, ids('k1'), space).keys)).toContainEqual(['k4', 3]);
    const wide = duplicateKeys([key('k1', 1), key('k2', 3)], ids('k1', 'k2'), space);
    expect(places(wide.keys)).toEqual([
      ['k1', 1],
      ['k2', 3],
      ['k3', 5],
      ['k4', 7],
    ]);
  });
  it('pastes with distances in beats and leaves out what is past the end', () => {
    const pasted = pasteKeys([], keys, 14, space);
    expect(places(pasted.keys)).toEqual([
      ['k1', 14],
      ['k2', 15],
    ]);
    expect(pasted.left).toBe(1);
    expect(pasteKeys(keys, [], 3, space).keys).toBe(keys);
  });
  it('without beats keeps distances in seconds', () => {
    const pasted = pasteKeys([], [key('k1', 1), key('k2', 2.2)], 5, { duration: 20, grid: null });
    expect(pasted.keys.map((each) => each.time)).toEqual([5, 6.2]);
  });
});

describe('distributing', () => {
  const row = [key('a', 1.1), key('b', 1.2), key('c', 1.3), key('d', 7.9)];
  const all = ids('a', 'b', 'c', 'd');

  it('spreads over beats from the first to the last', () => {
    expect(distributeKeys(row, all, 'beat', space).map((each) => each.time)).toEqual([1, 3.5, 5.5, 8]);
    expect(distributeKeys(row, all, 'off', space).map((each) => each.time)).toEqual([1, 3.5, 5.5, 8]);
    expect(distributeKeys(row, all, 'bar', space).map((each) => each.time)).toEqual([2, 4, 6, 8]);
  });
  it('takes beats that follow each other where there are too few between', () => {
    const close = [key('a', 3), key('b', 3.1), key('c', 3.2)];
    expect(distributeKeys(close, ids('a', 'b', 'c'), 'beat', space).map((each) => each.time)).toEqual([3, 3.5, 4]);
    const atEnd = [key('a', 19.4), key('b', 19.5), key('c', 19.6)];
    expect(distributeKeys(atEnd, ids('a', 'b', 'c'), 'beat', space).map((each) => each.time)).toEqual([18.5, 19, 19.5]);
  });
  it('does not touch others, locked or not', () => {
    const mixed = [key('a', 1), key('x', 1.5), key('b', 1.6), key('y', 2, { locked: true }), key('c', 3)];
    expect(places(distributeKeys(mixed, ids('a', 'b', 'c', 'y'), 'beat', space))).toEqual([
      ['a', 1],
      ['x', 1.5],
      ['y', 2],
      ['b', 2.5],
      ['c', 3],
    ]);
  });
  it('gives the same list for fewer than two and where all is even', () => {
    expect(distributeKeys(row, ids('a'), 'beat', space)).toBe(row);
    const even = [key('a', 1), key('b', 2), key('c', 3)];
    expect(distributeKeys(even, ids('a', 'b', 'c'), 'beat', space)).toBe(even);
  });
});

describe('lock, strength, deletion', () => {
  const keys = [key('a', 1), key('b', 2, { locked: true })];
  it('locks all until all are locked, then unlocks', () => {
    const locked = toggleLock(keys, ids('a', 'b'));
    expect(locked.map((each) => each.locked)).toEqual([true, true]);
    expect(toggleLock(locked, ids('a', 'b'))).toEqual([key('a', 1), key('b', 2)]);
    expect(toggleLock(keys, ids())).toBe(keys);
  });
  it('keeps strength between 0 and 1, and full strength unsaid', () => {
    const weak = setStrength(keys, ids('a', 'b'), 0.4);
    expect(weak).toEqual([key('a', 1, { strength: 0.4 }), keys[1]]);
    expect(setStrength(weak, ids('a'), 7)).toEqual(keys);
    expect(setStrength(keys, ids('a'), 1)).toBe(keys);
  });
  it('does not delete locked ones', () => {
    expect(places(deleteKeys(keys, ids('a', 'b')))).toEqual([['b', 2]]);
    expect(deleteKeys(keys, ids('b'))).toBe(keys);
  });
});
