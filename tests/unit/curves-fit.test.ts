import { describe, expect, it } from 'vitest';
import { CHANNELS, emptyCurves, rotationChannel, sampleCurves } from '../../web/core/curves';
import { followMotion } from '../../web/core/curves-fit';
import { angleBetween } from '../../web/core/rotation';
import { swingingMotion } from './dance';

const all = (count: number, value: boolean) => new Array<boolean>(count).fill(value);
const turnError = (a: Float32Array, b: Float32Array) => {
  let worst = 0;
  for (let i = 0; i < a.length; i += 4) {
    worst = Math.max(worst, angleBetween(a.subarray(i, i + 4), b.subarray(i, i + 4)));
  }
  return worst;
};

describe('curves that follow a dance', () => {
  const motion = swingingMotion(91);
  for (let t = 0; t < 91; t++) motion.root.set([Math.sin(t / 20), 0.95, t / 90], t * 3);
  const times = [0, 0.5, 1, 1.5, 2, 2.5, 3];

  it('find their knots again', () => {
    const wanted = emptyCurves(times, 91 / 30);
    for (let i = 0; i < wanted.shape.length; i++) wanted.shape[i] = 0.3 * Math.sin(i);
    for (const list of [wanted.keys, wanted.inner]) {
      for (let row = 0; row < list.length; row += CHANNELS) list[row] = Math.cos(row);
    }
    const made = emptyCurves(times, 91 / 30);
    made.shape.set(wanted.shape);
    followMotion(made, sampleCurves(wanted, 30), all(7, false));
    for (let row = 0; row < wanted.inner.length; row += CHANNELS) {
      expect(made.inner[row]).toBeCloseTo(wanted.inner[row], 2);
    }
    const [a, b] = [sampleCurves(made, 30), sampleCurves(wanted, 30)];
    a.root.forEach((value, i) => expect(value).toBeCloseTo(b.root[i], 2));
  });

  it('come within a quarter of a degree and three millimetres of a smooth dance', () => {
    const made = emptyCurves(times, 91 / 30);
    followMotion(made, motion, all(7, false));
    const sampled = sampleCurves(made, 30);
    expect(turnError(sampled.quaternions, motion.quaternions)).toBeLessThan((0.25 * Math.PI) / 180);
    sampled.root.forEach((value, i) => expect(Math.abs(value - motion.root[i])).toBeLessThan(3e-3));
  });

  it('leave exact key poses as they are', () => {
    const made = emptyCurves(times, 91 / 30);
    const channel = rotationChannel(5);
    const before = made.keys.slice(3 * CHANNELS + channel, 3 * CHANNELS + channel + 4);
    followMotion(made, motion, [false, true, false, true, false, true, false]);
    expect(made.keys.slice(3 * CHANNELS + channel, 3 * CHANNELS + channel + 4)).toEqual(before);
    const free = made.keys.subarray(2 * CHANNELS + channel, 2 * CHANNELS + channel + 4);
    expect(angleBetween(free, motion.quaternions.subarray((30 * 24 + 5) * 4, (30 * 24 + 5) * 4 + 4))).toBeLessThan(
      0.03,
    );
    expect(Math.hypot(...free)).toBeCloseTo(1, 6);
  });

  it('take the place of the root where there is one key pose only', () => {
    const made = emptyCurves([1], 3);
    followMotion(made, motion, [true]);
    expect([...made.keys.slice(0, 3)]).toEqual([...motion.root.slice(90, 93)]);
  });
});
