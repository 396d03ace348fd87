import { describe, expect, it } from 'vitest';
import { degreesPerJoint } from '../../web/app/report-reference';
import { emptyMotion } from '../../web/core/motion';
import { consistencyPerKey, envelope, movesOnBeats, tradeOffAt, tradeOffStrengths } from '../../web/core/report-curves';
import { key, poseWith } from './dance';

describe('consistency of each key pose', () => {
  it('is the squared distance at that key alone, and eq. 13 is its mean', () => {
    const motion = emptyMotion(60);
    // A quarter turn about z moves column 0 and column 1 by sqrt 2 each: 2 + 2. About x column 0 stays: 2.
    const z = poseWith({ left_elbow: [0, 0, Math.PI / 2] });
    const x = poseWith({ left_elbow: [Math.PI / 2, 0, 0] });
    const errors = consistencyPerKey(motion, [key(0.5, z), key(1, x), key(1.5, poseWith({})), key(9, z)]);
    expect(errors.map(({ id, time }) => [id, time])).toEqual([
      ['k0.5', 0.5],
      ['k1', 1],
      ['k1.5', 1.5],
    ]);
    [4, 2, 0].forEach((error, i) => expect(errors[i].error).toBeCloseTo(error, 5));
  });

  it('is told in degrees a joint', () => {
    // All 24 joints off by 1 degree about an axis at random: 24 x 4/3 x (pi / 180)^2.
    expect(degreesPerJoint(32 * (Math.PI / 180) ** 2)).toBeCloseTo(1, 12);
    expect(degreesPerJoint(0)).toBe(0);
  });
});

describe('the trade-off', () => {
  it('is worked out from the ends inwards, each strength once', () => {
    expect(tradeOffStrengths(0)).toEqual([1, 0]);
    expect(tradeOffStrengths(2)).toEqual([1, 0, 0.5, 0.25, 0.75]);
    expect([...tradeOffStrengths(3)].sort()).toEqual([0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1]);
  });
  it('is straight between its points and ends at its ends', () => {
    const points = [
      { strength: 0, error: 0.4, jerk: 100 },
      { strength: 0.5, error: 0.1, jerk: 110 },
      { strength: 1, error: 0, jerk: 150 },
    ];
    expect(tradeOffAt(points, 0.25)).toEqual({ strength: 0.25, error: 0.25, jerk: 105 });
    expect(tradeOffAt(points, 1)).toEqual(points[2]);
    expect(tradeOffAt(points, 0)).toEqual(points[0]);
    expect(tradeOffAt(points.slice(1), 0.2)).toEqual({ strength: 0.2, error: 0.1, jerk: 110 });
    expect(tradeOffAt(points.slice(0, 2), 0.9)).toEqual({ strength: 0.9, error: 0.1, jerk: 110 });
    expect(tradeOffAt([], 1)).toBeNull();
  });
});

describe('moves on beats', () => {
  it('asks for the nearest beat, ends of the tolerance included', () => {
    expect(movesOnBeats([0.1, 0.4, 0.74, 0.76, 2], [0, 0.5, 1], 0.1)).toEqual([true, true, false, false, false]);
  });
  it('does not need the moves in order, and knows a song without beats', () => {
    expect(movesOnBeats([2, 0], [0, 1], 0.1)).toEqual([false, true]);
    expect(movesOnBeats([2, 0], [], 0.1)).toEqual([false, false]);
  });
});

describe('the envelope of a curve', () => {
  const columns = ({ low, high }: { low: Float32Array; high: Float32Array }) =>
    Array.from(low, (value, i) => [value, high[i]]);
  it('holds the peaks of what falls into one column', () => {
    expect(columns(envelope([0, 5, 1, 2, -3, 0], 0, 2, 2))).toEqual([
      [0, 5],
      [-3, 2],
    ]);
  });
  it('interpolates where a sample is wider than a column, so that columns join', () => {
    expect(columns(envelope([0, 4, 0], 0, 0.5, 4))).toEqual([
      [0, 2],
      [2, 4],
      [2, 4],
      [0, 2],
    ]);
  });
  it('is empty outside the curve', () => {
    expect(columns(envelope([1, 3], -2, 1, 5))).toEqual([
      [NaN, NaN],
      [1, 1],
      [1, 3],
      [3, 3],
      [NaN, NaN],
    ]);
    expect(columns(envelope([], 0, 1, 1))).toEqual([[NaN, NaN]]);
  });
});
