import { describe, expect, it } from 'vitest';
import { findSections } from '../../web/core/sections';
import { spec } from '../../web/core/spec';
import type { BeatGrid, Features } from '../../web/core/types';

/** A song of 2 s bars: each bar has a chord (three chroma bins) and a liveliness, with a little noise. */
function song(bars: readonly { chord: readonly number[]; onset: number }[]): [Features, BeatGrid, number] {
  const { names } = spec.features;
  const perBar = 2 * spec.fps;
  const frames = bars.length * perBar;
  const data = new Float32Array(frames * names.length);
  let noise = 1;
  const random = () => (noise = (noise * 16807) % 2147483647) / 2147483647;
  for (let t = 0; t < frames; t += 1) {
    const { chord, onset } = bars[Math.floor(t / perBar)];
    names.forEach((name, column) => {
      const at = t * names.length + column;
      if (name.startsWith('chroma')) data[at] = (chord.includes(column) ? 0.55 : 0.02) + 0.05 * random();
      if (name === 'onset') data[at] = t % 15 === 0 ? onset : 0.02 * random();
    });
  }
  const duration = bars.length * 2;
  const beats = Array.from({ length: bars.length * 4 }, (_, i) => i / 2);
  return [
    { fps: spec.fps, names, frames, data },
    { tempo: 120, beatsPerBar: 4, beats, downbeats: beats.filter((_, i) => i % 4 === 0) },
    duration,
  ];
}
const verse = [0, 5, 7, 5].map((root) => ({ chord: [root, (root + 4) % 12, (root + 7) % 12], onset: 0.4 }));
const chorus = [9, 2, 4, 11].map((root) => ({ chord: [root, (root + 3) % 12, (root + 7) % 12], onset: 0.9 }));
const times = <T>(count: number, list: readonly T[]): T[] => Array.from({ length: count }, () => list).flat();

describe('sections', () => {
  it('finds A B A with its borders on the bar, and hears that A comes back', () => {
    const sections = findSections(...song([...times(4, verse), ...times(3, chorus), ...times(2, verse)]));
    expect(sections).toEqual([
      { start: 0, end: 32, label: 'A' },
      { start: 32, end: 56, label: 'B' },
      { start: 56, end: 72, label: 'A' },
    ]);
  });
  it('hears a change of liveliness alone', () => {
    const quiet = times(3, verse).map((bar) => ({ ...bar, onset: 0.05 }));
    const loud = times(3, verse).map((bar) => ({ ...bar, onset: 1 }));
    expect(findSections(...song([...quiet, ...loud])).map(({ start, label }) => [start, label])).toEqual([
      [0, 'A'],
      [24, 'B'],
    ]);
  });
  it('names nothing in a song that goes on and on, nor in a short one', () => {
    expect(findSections(...song(times(8, verse)))).toEqual([]);
    expect(findSections(...song([...verse, ...chorus]))).toEqual([]);
    expect(findSections(...song(times(24, [verse[0]])))).toEqual([]);
  });
  it('bears a grid without bars and a song that ends early', () => {
    const [features, grid, duration] = song(times(4, verse));
    expect(findSections(features, { ...grid, downbeats: [] }, duration)).toEqual([]);
    expect(findSections({ ...features, frames: 0, data: new Float32Array(0) }, grid, duration)).toEqual([]);
  });
});
