import { describe, expect, it } from 'vitest';
import { REAL_DANCE } from '../../web/app/report-reference';
import { excerpt } from '../../web/core/excerpt';
import { chooseStretch, PAGE, pictureX, stripTimes } from '../../web/ui/report/picture-layout';
import { axesOf, place, PLOT, strengthNear } from '../../web/ui/report/trade-off-shape';
import {
  beatVerdict,
  errorText,
  footVerdict,
  freezeVerdict,
  jerkVerdict,
  keyVerdict,
  smoothnessVerdict,
} from '../../web/ui/report/verdicts';
import { clickFeatures, key, poseWith, steadyGrid } from './dance';
import { fakeReport } from './support/app';

const report = (change: Partial<typeof fakeReport>) => ({ ...fakeReport, ...change });

describe('verdicts', () => {
  it('write errors in few digits', () => {
    expect([0, 5e-7, 2e-4, 0.0042, 0.0999, 0.5, 3.456, 12.3].map(errorText)).toEqual([
      '0',
      '0',
      '<0.001',
      '0.004',
      '0.10',
      '0.50',
      '3.46',
      '12',
    ]);
  });
  it('say how close the key poses are', () => {
    expect(keyVerdict(report({ consistencyError: NaN }))).toBeNull();
    expect(keyVerdict(report({ consistencyError: 5e-7 }))).toMatchObject({ value: 'Exact' });
    // 32 x (1 degree in radians) squared is one degree a joint.
    expect(keyVerdict(report({ consistencyError: 32 * (Math.PI / 180) ** 2 }))).toEqual({
      value: '0.010',
      unit: 'E_c, 0 is exact',
      sentence: 'Joints are some 1° off at your poses: too little to see.',
    });
    expect(keyVerdict(report({ consistencyError: 0.9 }))?.sentence).toMatch(/some 10° off.*raise the key strength/);
  });
  it('compare beats, jerk and feet with real dance', () => {
    const hits = (rate: number) => beatVerdict(report({ beatHitRate: [0, 0, rate, 0, 0] }))?.sentence;
    expect(hits(0.99)).toMatch(/^More often than real dancers, who hit 68%/);
    expect(hits(0.7)).toMatch(/^As good as/);
    expect(hits(0.62)).toMatch(/^Nearly as often/);
    expect(hits(0.5)).toMatch(/^Less often/);
    expect(hits(0.2)).toMatch(/across the beats/);
    expect(beatVerdict(report({ beatHitRate: [NaN, NaN, NaN, NaN, NaN] }))).toBeNull();
    const [calm, wild] = REAL_DANCE.jerk;
    expect(
      [calm - 1, calm, wild, wild + 1].map((jerk) => jerkVerdict(report({ jerk }))?.sentence.split(':')[0]),
    ).toEqual([
      'Calmer than people dance',
      'As lively as people dance.',
      'As lively as people dance.',
      'Rougher than people dance',
    ]);
    expect(jerkVerdict(report({ jerk: NaN }))).toBeNull();
    expect(footVerdict(report({ footSkate: 0.2 }))).toMatchObject({ value: '20', unit: 'cm/s on the floor' });
    expect(footVerdict(report({ footSkate: NaN }))).toBeNull();
    expect(freezeVerdict(report({ longestFreeze: 1 }))).toMatchObject({ value: '1.0', unit: 's' });
    expect(freezeVerdict(report({ longestFreeze: 1.1 })).sentence).toMatch(/freezes/);
    expect(smoothnessVerdict(report({ smoothness: 1736.4 }))).toMatchObject({ value: '1,736', unit: 'S_cv' });
    expect(smoothnessVerdict(report({ smoothness: Infinity }))).toBeNull();
  });
});

describe('the trade-off plot', () => {
  const points = [
    { strength: 0, error: 0.04, jerk: 100 },
    { strength: 1, error: 0, jerk: 140 },
  ];
  it('has exact poses left and smooth motion below', () => {
    const axes = axesOf(points);
    expect(axes).toEqual({ error: 0.04, jerk: [100, 140] });
    expect(place(points[0], axes)).toEqual({ x: PLOT.width - PLOT.right, y: PLOT.height - PLOT.bottom });
    expect(place(points[1], axes)).toEqual({ x: PLOT.left, y: PLOT.top });
    // A quarter of the error is half the way: the axis is a square root.
    expect(place({ error: 0.01, jerk: 120 }, axes).x).toBeCloseTo((PLOT.left + PLOT.width - PLOT.right) / 2, 9);
  });
  it('does not blow a flat curve up', () => {
    expect(
      axesOf([
        { ...points[0], jerk: 99 },
        { ...points[1], jerk: 101 },
      ]).jerk,
    ).toEqual([90, 110]);
  });
  it('finds the strength under a pointer', () => {
    const axes = axesOf(points);
    expect(strengthNear(points, axes, PLOT.left, PLOT.top)).toBe(1);
    expect(strengthNear(points, axes, PLOT.width, PLOT.height)).toBe(0);
    const at = place({ error: 0.01, jerk: 130 }, axes);
    expect(strengthNear(points, axes, at.x, at.y)).toBe(0.75);
  });
});

describe('the picture of two dances', () => {
  it('takes the loop, else what is in sight, else bars from the playhead', () => {
    const now = {
      loop: null,
      view: { start: 4, pixelsPerSecond: 100 },
      viewWidth: 1000,
      time: 21,
      duration: 60,
      grid: steadyGrid(60, 120, 0),
    };
    expect(chooseStretch({ ...now, loop: { start: 8, end: 30 } })).toEqual({ start: 8, end: 20, why: 'loop' });
    expect(chooseStretch(now)).toEqual({ start: 4, end: 14, why: 'view' });
    const far = { ...now, view: { start: 0, pixelsPerSecond: 20 } };
    expect(chooseStretch(far)).toEqual({ start: 20, end: 30, why: 'playhead' });
    expect(chooseStretch({ ...far, time: 59 })).toEqual({ start: 50, end: 60, why: 'playhead' });
    expect(chooseStretch({ ...far, duration: 2, time: 1 })).toEqual({ start: 0, end: 2, why: 'playhead' });
  });
  it('shows every key pose and fills the gaps evenly', () => {
    const range = { start: 10, end: 20 };
    const times = stripTimes(range, [5, 12, 16, 20], 10);
    expect(times.filter(({ key }) => key).map(({ time }) => time)).toEqual([12, 16]);
    expect(times.length).toBeLessThanOrEqual(10);
    expect(times.every(({ time }) => time >= 10 && time < 20)).toBe(true);
    // Between 12 and 16 stand three: a second apart.
    expect(times.map(({ time }) => time).filter((time) => time > 12 && time < 16)).toEqual([13, 14, 15]);
  });
  it('is evenly filled without key poses, half a figure from the borders', () => {
    const times = stripTimes({ start: 0, end: 10 }, [], 10);
    expect(times.map(({ time }) => Math.round(time * 1000) / 1000)).toEqual([
      0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5,
    ]);
  });
  it('thins out more key poses than fit', () => {
    const keys = Array.from({ length: 40 }, (_, i) => i / 4);
    const times = stripTimes({ start: 0, end: 10 }, keys, 8);
    expect(times.map(({ time }) => time)).toEqual([0, 1.25, 2.5, 3.75, 5, 6.25, 7.5, 8.75]);
  });
  it('has one time axis', () => {
    expect(pictureX({ start: 10, end: 20 }, 10)).toBe(PAGE.left);
    expect(pictureX({ start: 10, end: 20 }, 20)).toBe(PAGE.right);
  });
});

describe('an excerpt of a song', () => {
  it('counts from its own start', () => {
    const grid = steadyGrid(10, 120, 0);
    const features = clickFeatures(10, grid);
    const cut = excerpt(
      { features, grid, keyPoses: [key(1, poseWith({})), key(4, poseWith({})), key(7, poseWith({}))] },
      90,
      180,
    );
    expect(cut.frames).toBe(90);
    expect(cut.features.frames).toBe(90);
    expect(cut.features.data).toEqual(features.data.slice(90 * 15, 180 * 15));
    expect(cut.keyPoses.map(({ id, time }) => [id, time])).toEqual([['k4', 1]]);
    expect(cut.grid.beats.slice(0, 8)).toEqual([-3, -2.5, -2, -1.5, -1, -0.5, 0, 0.5]);
    expect(cut.grid.downbeats[0]).toBe(-3);
  });
});
