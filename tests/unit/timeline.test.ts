import { describe, expect, it } from 'vitest';
import { barAndBeat, clockTime, lowerBound, snapTime, stepBeat } from '../../web/app/snapping';
import { barStep, keyWidths, placeKeys, stretchInSight, timeToX, xToTime } from '../../web/ui/timeline/geometry';
import { keyText, matches, SHORTCUTS } from '../../web/ui/shortcuts';

const grid = { tempo: 120, beatsPerBar: 4 as const, beats: [0.5, 1, 1.5, 2, 2.5, 3], downbeats: [1, 3] };
const key = (id: string, time: number) => ({ id, time, rotations: [] });

describe('snapping', () => {
  it('finds the nearest beat, the earlier one of two as near', () => {
    expect([0, 0.7, 0.75, 0.76, 9].map((time) => snapTime(grid, time, 'beat'))).toEqual([0.5, 0.5, 0.5, 1, 3]);
    expect(snapTime(null, 0.7, 'beat')).toBe(0.7);
  });
  it('steps over the beat it stands on', () => {
    expect(stepBeat(grid, 1, 1)).toBe(1.5);
    expect(stepBeat(grid, 1, -1)).toBe(0.5);
    expect(stepBeat(grid, 1.2, -1)).toBe(1);
    expect(stepBeat(grid, 3, 1)).toBe(3.5);
  });
  it('names bar and beat', () => {
    expect(barAndBeat(grid, 0.6)).toBeNull();
    expect(barAndBeat(grid, 1)).toEqual({ bar: 1, beat: 1 });
    expect(barAndBeat(grid, 2.6)).toEqual({ bar: 1, beat: 4 });
    expect(barAndBeat(grid, 3)).toEqual({ bar: 2, beat: 1 });
  });
  it('writes times', () => {
    expect([0, 59.99, 60, 125.3].map(clockTime)).toEqual(['0:00.0', '0:59.9', '1:00.0', '2:05.3']);
  });
  it('searches like indexOf does', () => {
    for (const time of [0, 0.5, 0.9, 1, 3, 4]) {
      const index = grid.beats.findIndex((beat) => beat >= time);
      expect(lowerBound(grid.beats, time)).toBe(index < 0 ? grid.beats.length : index);
    }
  });
});

describe('geometry', () => {
  const view = { start: 2, pixelsPerSecond: 50 };
  it('goes from time to pixels and back', () => {
    expect(timeToX(view, 4)).toBe(100);
    expect(xToTime(view, timeToX(view, 7.3))).toBeCloseTo(7.3, 12);
  });
  it('places only what is in sight and a little more, and what must stay', () => {
    const keys = Array.from({ length: 400 }, (_, i) => key(`k${i}`, i));
    const stretch = stretchInSight(view, 500);
    expect(stretch).toEqual({ from: -52, to: 808 });
    const placed = placeKeys(keys, keyWidths(keys, 50), 50, stretch, new Set(['k300']));
    expect(placed.map((each) => each.key.id)).toEqual([...Array.from({ length: 17 }, (_, i) => `k${i}`), 'k300']);
    // Panning on does not change it until a step is over.
    expect(stretchInSight({ ...view, start: 5.1 }, 500)).toEqual(stretch);
    expect(stretchInSight({ ...view, start: 5.2 }, 500)).not.toEqual(stretch);
  });
  it('gives key poses the width that their neighbours leave', () => {
    const keys = [key('a', 2), key('b', 2.2), key('c', 6), key('d', 7), key('e', 7.8)];
    expect(keyWidths(keys, 50)).toEqual([16, 16, 44, 36, 36]);
    expect(keyWidths([key('a', 1)], 50)).toEqual([52]);
  });
  it('never makes more elements than there is room for', () => {
    const keys = Array.from({ length: 400 }, (_, i) => key(`k${i}`, i * 1.5));
    const widths = keyWidths(keys, 2);
    expect(widths.filter((width) => width > 0)).toHaveLength(134);
    expect(new Set(widths)).toEqual(new Set([16, 0]));
    const keep = placeKeys(keys, widths, 2, { from: 0, to: 0 }, new Set(['k1']));
    expect(keep).toEqual([{ key: keys[1], index: 1, width: 16 }]);
  });
  it('thins bars out by doubling', () => {
    expect([50, 10, 1].map((width) => barStep(width, 44))).toEqual([1, 8, 64]);
  });
});

describe('shortcuts', () => {
  const press = (name: string, modifiers: Partial<KeyboardEvent> = {}) =>
    SHORTCUTS.filter((shortcut) =>
      shortcut.keys.some((combo) =>
        matches({ key: name, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...modifiers }, combo),
      ),
    ).map((shortcut) => shortcut.id);

  it('each press means one thing at most', () => {
    expect(press(' ')).toEqual(['play']);
    expect(press('<', { shiftKey: true })).toEqual(['key-back']);
    expect(press('?', { shiftKey: true })).toEqual(['help']);
    expect(press('+', { shiftKey: true })).toEqual(['zoom-in']);
    expect(press('z', { ctrlKey: true })).toEqual(['undo']);
    expect(press('Z', { metaKey: true, shiftKey: true })).toEqual(['redo']);
    expect(press('y', { ctrlKey: true })).toEqual(['redo']);
    expect(press('Enter')).toEqual(['add']);
    expect(press('Enter', { shiftKey: true })).toEqual(['remove']);
    expect(press('g')).toEqual(['generate']);
    expect(press('g', { ctrlKey: true })).toEqual([]);
    expect(press('m', { altKey: true })).toEqual([]);
    expect(press('0')).toEqual(['fit']);
    expect(press(')', { shiftKey: true, code: 'Digit0' })).toEqual(['fit-selection']);
  });
  it('are unique and readable', () => {
    // The pose editor and the timeline share some keys: only one of them is open.
    const combos = SHORTCUTS.flatMap(({ keys, group }) =>
      keys.map((combo) => (group === 'Pose editor' ? `posing ${combo}` : combo)),
    );
    expect(new Set(combos).size).toBe(combos.length);
    expect(combos.map(keyText).every((text) => text.length > 0)).toBe(true);
  });
});
