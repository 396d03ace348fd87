import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import * as R from '../../web/core/rotation';

const coordinate = fc.double({ min: -3, max: 3, noNaN: true });
const vector = fc.tuple(coordinate, coordinate, coordinate);
const quaternion = vector.map((v) => Array.from(R.axisAngleToQuaternion(v)));
const number = fc.oneof(fc.double({ min: -10, max: 10, noNaN: true }), fc.constantFrom(0, 1, -1, 1e-9, NaN, Infinity));

describe('any rotation', () => {
  it('survives the way through each representation', () => {
    fc.assert(
      fc.property(quaternion, (q) => {
        expect(R.angleBetween(q, R.axisAngleToQuaternion(R.quaternionToAxisAngle(q)))).toBeLessThan(1e-7);
        expect(R.angleBetween(q, R.sixDToQuaternion(R.quaternionToSixD(q)))).toBeLessThan(1e-7);
      }),
    );
  });
  it('is made of any six numbers', () => {
    fc.assert(
      fc.property(fc.array(number, { minLength: 6, maxLength: 6 }), (six) => {
        const q = R.sixDToQuaternion(six);
        expect(Math.abs(Math.hypot(q[0], q[1], q[2], q[3]) - 1)).toBeLessThan(1e-6);
      }),
    );
  });
  it('is undone by its conjugate and keeps lengths', () => {
    fc.assert(
      fc.property(quaternion, vector, (q, v) => {
        const back = R.rotateVector(R.conjugate(q), R.rotateVector(q, v));
        v.forEach((value, i) => expect(back[i]).toBeCloseTo(value, 9));
      }),
    );
  });
  it('interpolates in proportion to the angle', () => {
    fc.assert(
      fc.property(quaternion, quaternion, fc.double({ min: 0, max: 1, noNaN: true }), (a, b, t) => {
        fc.pre(R.angleBetween(a, b) < 3.1);
        expect(R.angleBetween(a, R.slerp(a, b, t))).toBeCloseTo(t * R.angleBetween(a, b), 6);
      }),
    );
  });
});
