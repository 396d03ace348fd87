import { describe, expect, it } from 'vitest';
import { buildPyramid, forEachColumn } from '../../web/ui/timeline/pyramid';

const length = 1000;
const max = Float32Array.from({ length }, (_, i) => Math.abs(Math.sin(i * 1.7)) * (i / length));
const min = max.map((value) => -value / 2);
const pyramid = buildPyramid(min, max);

const columns = (perColumn: number, first: number, count: number) => {
  const found = new Map<number, [number, number]>();
  forEachColumn(pyramid, perColumn, first, count, (column, low, high) => found.set(column, [low, high]));
  return found;
};

describe('pyramid', () => {
  it('halves down to one bucket that holds the extremes', () => {
    expect(pyramid.levels.map((level) => level.max.length)).toEqual([1000, 500, 250, 125, 63, 32, 16, 8, 4, 2, 1]);
    expect(pyramid.levels[10].max[0]).toBe(Math.max(...max));
    expect(pyramid.levels[10].min[0]).toBe(Math.min(...min));
  });
  it('gives every column the extremes of its own buckets, at most a bucket of its level wider', () => {
    for (const perColumn of [1, 2, 3.3, 10, 64, 97]) {
      const level = 2 ** Math.floor(Math.log2(perColumn));
      for (const [column, [low, high]] of columns(perColumn, 0, Math.ceil(length / perColumn))) {
        const inside = max.slice(Math.floor(column * perColumn), Math.ceil((column + 1) * perColumn));
        const wide = max.slice(
          Math.max(0, Math.floor(column * perColumn) - level),
          Math.ceil((column + 1) * perColumn) + level,
        );
        expect(high).toBeLessThanOrEqual(Math.max(...wide));
        expect(low).toBeGreaterThanOrEqual(-Math.max(...wide) / 2);
        if (Number.isInteger(perColumn) && Number.isInteger(Math.log2(perColumn)))
          expect(high).toBe(Math.max(...inside));
      }
    }
  });
  it('shows the same in the same place however far the view has moved', () => {
    const still = columns(5.7, 0, 150);
    for (const [column, extremes] of columns(5.7, 40, 60)) expect(extremes).toEqual(still.get(column + 40));
  });
  it('leaves out what is before and after the curve', () => {
    expect([...columns(10, -5, 20).keys()][0]).toBe(5);
    expect(Math.max(...columns(10, 90, 50).keys())).toBe(9);
    expect(columns(10, 200, 50).size).toBe(0);
    forEachColumn(buildPyramid(new Float32Array(0), new Float32Array(0)), 1, 0, 10, () => expect.unreachable());
  });
});
