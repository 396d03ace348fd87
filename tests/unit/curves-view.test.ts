import { describe, expect, it } from 'vitest';
import { alignKnots, CHANNELS, emptyCurves, rotationChannel } from '../../web/core/curves';
import { applyEdits, type CurveEdit } from '../../web/core/curves-edit';
import { knotsMovedTo, meanShape, trackPicture } from '../../web/core/curves-view';
import { axisAngleToQuaternion } from '../../web/core/rotation';

const radians = Math.PI / 180;

/** A joint that turns about Y, on and on: 60 degrees a knot. */
function spinning() {
  const curves = emptyCurves([0, 1, 2, 3], 3, ['k1', 'k2', 'k3', 'k4']);
  for (let i = 0; i < 10; i++) {
    const list = i % 3 === 0 ? curves.keys : curves.inner;
    const row = i % 3 === 0 ? i / 3 : Math.floor(i / 3) * 2 + (i % 3) - 1;
    list.set(axisAngleToQuaternion([0, i * 60 * radians, 0]), row * CHANNELS + rotationChannel(0));
    list.set([i / 10, 0.9, 0], row * CHANNELS);
  }
  return alignKnots(curves);
}

describe('the picture of a track', () => {
  it('is angles in degrees that go on past a full turn', () => {
    const { values, rate, knots, knotValues, lowest, highest } = trackPicture(spinning(), 0);
    for (let i = 0; i < 10; i++) expect(knotValues[i * 3 + 1]).toBeCloseTo(i * 60, 2);
    for (let i = 4; i < values.length; i += 3) expect(Math.abs(values[i] - values[i - 3])).toBeLessThan(6);
    expect(values[Math.round(knots[5] * rate) * 3 + 1]).toBeCloseTo(300, 0);
    expect(lowest).toBeLessThan(0);
    expect(highest).toBeGreaterThan(540);
  });

  it('is centimetres for the way of the body', () => {
    const { knotValues, highest, lowest } = trackPicture(spinning(), 'root');
    expect([...knotValues.slice(9, 12)]).toEqual([30, 90, 0].map((value) => expect.closeTo(value, 3)));
    expect(highest - lowest).toBeGreaterThan(90);
  });
});

describe('a knot moved on its curve', () => {
  it.each([0, 1, 2])('comes to the value on axis %i, the others stay', (axis) => {
    const base = spinning();
    const place = { interval: 1, n: 1, track: 0 } as const;
    let edit: CurveEdit = { from: 'k2', to: 'k3', track: 'pelvis' };
    for (const value of [20, 320, 250]) {
      const shown = trackPicture(applyEdits(base, [edit]), 0);
      edit = { ...edit, knots: knotsMovedTo(base, shown, edit, place, axis, value) };
      const after = trackPicture(applyEdits(base, [edit]), 0);
      const wanted = [...shown.knotValues.slice(15, 18)];
      wanted[axis] = value;
      // A whole turn more or less is the same rotation.
      const q = (v: number[]) => axisAngleToQuaternion(v.map((each) => each * radians));
      const [a, b] = [q([...after.knotValues.slice(15, 18)]), q(wanted)];
      expect(Math.abs(a.reduce((sum, each, c) => sum + each * b[c], 0))).toBeCloseTo(1, 6);
      expect([...after.knotValues.slice(12, 15)]).toEqual([...shown.knotValues.slice(12, 15)]);
    }
    expect(edit.knots![0]).toEqual([0, 0, 0]);
  });

  it('moves the way of the body', () => {
    const base = spinning();
    const knots = knotsMovedTo(
      base,
      trackPicture(base, 'root'),
      undefined,
      { interval: 0, n: 0, track: 'root' },
      1,
      75,
    );
    expect(knots[0]).toEqual([expect.closeTo(0, 6), expect.closeTo(-0.15, 6), expect.closeTo(0, 6)]);
  });

  it('has a shape that is the mean of its channels', () => {
    const curves = spinning();
    curves.shape.set([1, 0, 0, 0.2], CHANNELS * 3 + rotationChannel(3));
    expect(meanShape(curves, 1, 3, 0)).toBeCloseTo(0.3, 6);
    expect(meanShape(curves, 1, 3, 1)).toBe(0);
  });
});
