import { describe, expect, it } from 'vitest';
import {
  alignKnots,
  CHANNELS,
  emptyCurves,
  evaluateTrack,
  inVelocity,
  knotTimes,
  knotTrack,
  outVelocity,
  rotationChannel,
  sampleCurves,
  type CurveDance,
} from '../../web/core/curves';
import { catmullRomWeights } from '../../web/core/interpolate';
import { axisAngleToQuaternion } from '../../web/core/rotation';
import { seededRandom } from '../../web/core/random';

const plain = { tension: 0, continuity: 0, bias: 0 };

/** Curves whose root x has these knots, one second a knot (key, inner, inner, key, ...). */
function line(values: number[]): CurveDance {
  const keys = (values.length - 1) / 3 + 1;
  const curves = emptyCurves(
    Array.from({ length: keys }, (_, k) => k * 3),
    (keys - 1) * 3,
  );
  values.forEach((value, i) => {
    if (i % 3 === 0) curves.keys[(i / 3) * CHANNELS] = value;
    else curves.inner[(Math.floor(i / 3) * 2 + (i % 3) - 1) * CHANNELS] = value;
  });
  return curves;
}

/** Sets tension (0), continuity (1) or bias (2) of root x in an interval. */
const shape = (curves: CurveDance, interval: number, which: 0 | 1 | 2, value: number) =>
  (curves.shape[(interval * 3 + which) * CHANNELS] = value);

/** A dance of random turns. */
function randomDance(times: number[], seed = 1): CurveDance {
  const random = seededRandom(seed);
  const curves = emptyCurves(times, times[times.length - 1]);
  for (const list of [curves.keys, curves.inner]) {
    for (let row = 0; row < list.length; row += CHANNELS) {
      for (let c = 0; c < 3; c++) list[row + c] = random();
      for (let joint = 0; joint < 24; joint++) {
        const turn = [0, 0, 0].map(() => random() * 2 - 1);
        list.set(axisAngleToQuaternion(turn), row + rotationChannel(joint));
      }
    }
  }
  for (let i = 0; i < curves.shape.length; i++) curves.shape[i] = random() - 0.5;
  return alignKnots(curves);
}

describe('the velocity at a knot', () => {
  it('is that of Catmull and Rom without tension, continuity and bias', () => {
    expect(outVelocity(2, 4, 2, plain)).toBe(3);
    expect(inVelocity(2, 4, 2, plain)).toBe(3);
    // Unevenly spaced: 2 in 1 s, then 4 in 3 s, is 6 in 4 s.
    expect(outVelocity(2, 4, 4, plain)).toBe(1.5);
  });

  it('shrinks with tension: nothing is left at 1, twice as much at -1', () => {
    expect(outVelocity(2, 4, 2, { ...plain, tension: 1 })).toBe(0);
    expect(inVelocity(2, 4, 2, { ...plain, tension: -1 })).toBe(6);
  });

  it('leans with bias: at 1 all on the way before, at -1 all on the way after', () => {
    expect(outVelocity(2, 4, 2, { ...plain, bias: 1 })).toBe(2);
    expect(inVelocity(2, 4, 2, { ...plain, bias: -1 })).toBe(4);
    expect(outVelocity(2, 4, 2, { ...plain, bias: 0.5 })).toBe(2.5);
  });

  it('breaks with continuity: at -1 a corner, the straight ways of both sides', () => {
    expect(inVelocity(2, 4, 2, { ...plain, continuity: -1 })).toBe(2);
    expect(outVelocity(2, 4, 2, { ...plain, continuity: -1 })).toBe(4);
    // Kochanek and Bartels, table of section 3: both sides change places at 1.
    expect(inVelocity(2, 4, 2, { ...plain, continuity: 1 })).toBe(4);
    expect(outVelocity(2, 4, 2, { ...plain, continuity: 1 })).toBe(2);
  });

  it('has all three at once as worked out by hand', () => {
    // (1 - 0.2)(1 + 0.5)(1 - 0.1) 3 + (1 - 0.2)(1 - 0.5)(1 + 0.1) 5 over 4 = (3.24 + 2.2) / 4
    const all = { tension: 0.2, continuity: 0.5, bias: -0.1 };
    expect(outVelocity(3, 5, 4, all)).toBeCloseTo(1.36, 12);
    // (0.8)(0.5)(0.9) 3 + (0.8)(1.5)(1.1) 5 over 4 = (1.08 + 6.6) / 4
    expect(inVelocity(3, 5, 4, all)).toBeCloseTo(1.92, 12);
  });
});

describe('a channel', () => {
  const values = [0, 1, 3, 2, 5, 4, 1];

  it('runs through all its knots', () => {
    const track = knotTrack(line(values), 0);
    expect([...track.times]).toEqual([0, 1, 2, 3, 4, 5, 6].map((time) => expect.closeTo(time, 6)));
    values.forEach((value, i) => expect(evaluateTrack(track, track.times[i])).toBeCloseTo(value, 12));
    expect(evaluateTrack(track, -1)).toBe(0);
    expect(evaluateTrack(track, 7)).toBe(1);
  });

  it('is a Catmull-Rom curve without tension, continuity and bias', () => {
    const track = knotTrack({ ...line(values), shares: new Float32Array([1 / 3, 2 / 3, 1 / 3, 2 / 3]) }, 0);
    for (const [i, t] of [
      [1, 0.25],
      [2, 0.5],
      [3, 0.8],
      [4, 0.1],
    ]) {
      const weights = catmullRomWeights(t);
      const wanted = weights.reduce((sum, weight, n) => sum + weight * values[i - 1 + n], 0);
      expect(evaluateTrack(track, i + t)).toBeCloseTo(wanted, 5);
    }
  });

  it('takes the shape of an interval inside it, and half of it at its key poses', () => {
    const curves = line(values);
    const before = knotTrack(curves, 0);
    shape(curves, 1, 0, 1);
    const after = knotTrack(curves, 0);
    expect([...after.leaving.slice(0, 3)]).toEqual([...before.leaving.slice(0, 3)]);
    expect(after.arriving[3]).toBe(before.arriving[3] / 2);
    expect(after.leaving[3]).toBe(before.leaving[3] / 2);
    expect(after.leaving.slice(4, 6).every((v) => Math.abs(v) === 0)).toBe(true);
    expect(after.arriving.slice(4, 7).every((v) => Math.abs(v) === 0)).toBe(true);
    expect(before.leaving.slice(3, 6).every((v) => Math.abs(v) > 0.1)).toBe(true);
  });

  it('has no kink while continuity is 0, whatever tension and bias are', () => {
    const curves = randomDance([0.5, 1, 1.8, 2.3]);
    const continuity = (i: number) => Math.floor(i / CHANNELS) % 3 === 1;
    for (let i = 0; i < curves.shape.length; i++) if (continuity(i)) curves.shape[i] = 0;
    for (const channel of [0, 7, 98]) {
      const { arriving, leaving } = knotTrack(curves, channel);
      for (let i = 1; i + 1 < arriving.length; i++) expect(arriving[i]).toBeCloseTo(leaving[i], 12);
    }
  });

  it('changes by an inner knot only between the second knot before and the second after it', () => {
    const curves = line([...values, 0, 2, 1]);
    const before = knotTrack(curves, 0);
    curves.inner[(1 * 2 + 0) * CHANNELS] += 1; // knot 4
    const after = knotTrack(curves, 0);
    for (let time = 1 / 16; time < 9; time += 0.125) {
      const same = evaluateTrack(before, time) === evaluateTrack(after, time);
      expect(same, `at ${time} s`).toBe(time < 2 || time > 6);
    }
  });
});

describe('sampling', () => {
  const curves = randomDance([0.2, 0.7, 1.5, 2]);

  it('is exact at key poses, at every rate that has their frames', () => {
    for (const fps of [30, 60, 120]) {
      const motion = sampleCurves(curves, fps);
      curves.times.forEach((time, k) => {
        const frame = Math.min(motion.frames - 1, Math.round(time * fps));
        if (frame / fps < time - 1e-9) return;
        for (let joint = 0; joint < 24; joint++) {
          const key = curves.keys.subarray(
            k * CHANNELS + rotationChannel(joint),
            k * CHANNELS + rotationChannel(joint) + 4,
          );
          const sampled = motion.quaternions.subarray((frame * 24 + joint) * 4, (frame * 24 + joint) * 4 + 4);
          key.forEach((value, c) => expect(sampled[c]).toBeCloseTo(value, 5));
        }
      });
    }
  });

  it('gives the same dance at 24, 30, 60 and 120 frames a second', () => {
    const fine = sampleCurves(curves, 120);
    expect(fine.frames).toBe(240);
    for (const fps of [24, 30, 60]) {
      const motion = sampleCurves(curves, fps);
      expect(motion.frames).toBe(2 * fps);
      const step = 120 / fps;
      for (let t = 0; t < motion.frames; t++) {
        for (let c = 0; c < 96; c++) {
          expect(motion.quaternions[t * 96 + c]).toBeCloseTo(fine.quaternions[t * step * 96 + c], 6);
        }
      }
    }
  });

  it('gives unit quaternions and holds still before the first and after the last key', () => {
    const motion = sampleCurves({ ...curves, duration: 3 }, 30);
    for (let i = 0; i < motion.quaternions.length; i += 4) {
      expect(Math.hypot(...motion.quaternions.subarray(i, i + 4))).toBeCloseTo(1, 6);
    }
    const frame = (t: number) => [...motion.quaternions.subarray(t * 96, t * 96 + 96)];
    expect(frame(0)).toEqual(frame(6));
    expect(frame(89)).toEqual(frame(61));
    expect(frame(20)).not.toEqual(frame(21));
  });

  it('holds one key pose for good, and refuses a dance without any', () => {
    const one = sampleCurves({ ...emptyCurves([1], 2) }, 30);
    expect(one.frames).toBe(60);
    expect([...one.quaternions.slice(0, 4)]).toEqual([0, 0, 0, 1]);
    expect(() => sampleCurves(emptyCurves([], 2), 30)).toThrow('no key pose');
  });
});

describe('signs', () => {
  it('run on from knot to knot, so that the curve between two near rotations stays near', () => {
    const curves = emptyCurves([0, 1], 1);
    const channel = rotationChannel(5);
    const knots = [curves.keys.subarray(0, CHANNELS), curves.inner.subarray(0, CHANNELS)];
    knots.push(curves.inner.subarray(CHANNELS, 2 * CHANNELS), curves.keys.subarray(CHANNELS, 2 * CHANNELS));
    knots.forEach((row, i) => {
      const q = axisAngleToQuaternion([0.2 + 0.01 * i, 0, 0]);
      row.set(
        q.map((v) => (i % 2 ? -v : v)),
        channel,
      );
    });
    alignKnots(curves);
    const motion = sampleCurves(curves, 30);
    for (let t = 0; t < 30; t++) expect(motion.quaternions[(t * 24 + 5) * 4 + 3]).toBeGreaterThan(0.99);
    expect(knotTimes(curves)[1]).toBeCloseTo(1 / 3, 6);
  });
});
