import { describe, expect, it } from 'vitest';
import * as R from '../../web/core/rotation';

const close = (actual: ArrayLike<number>, expected: number[], digits = 7) =>
  expected.forEach((value, i) => expect(actual[i]).toBeCloseTo(value, digits));

describe('rotations', () => {
  it('turns a quarter about each axis', () => {
    const h = Math.SQRT1_2;
    close(R.axisAngleToQuaternion([Math.PI / 2, 0, 0]), [h, 0, 0, h]);
    close(R.rotateVector(R.axisAngleToQuaternion([0, Math.PI / 2, 0]), [0, 0, 1]), [1, 0, 0]);
    close(R.rotateVector(R.axisAngleToQuaternion([Math.PI / 2, 0, 0]), [0, 1, 0]), [0, 0, 1]);
  });

  it('is exact at nothing and next to nothing', () => {
    close(R.axisAngleToQuaternion([0, 0, 0]), [0, 0, 0, 1], 15);
    close(R.axisAngleToQuaternion([2e-9, 0, 0]), [1e-9, 0, 0, 1], 17);
    close(R.quaternionToAxisAngle([1e-9, 0, 0, 1]), [2e-9, 0, 0], 17);
    close(R.quaternionToAxisAngle([0, 0, 0, 1]), [0, 0, 0], 17);
  });

  it('survives half a turn and more', () => {
    close(R.quaternionToAxisAngle(R.axisAngleToQuaternion([0, Math.PI, 0])), [0, Math.PI, 0]);
    close(R.quaternionToAxisAngle(R.axisAngleToQuaternion([0, 1.5 * Math.PI, 0])), [0, -Math.PI / 2, 0]);
    close(R.quaternionToAxisAngle(R.axisAngleToQuaternion([2 * Math.PI, 0, 0])), [0, 0, 0]);
  });

  it('gives one sign to both signs of a rotation', () => {
    close(R.canonicalQuaternion([0, -0.6, 0, -0.8]), [0, 0.6, 0, 0.8], 15);
    close(R.canonicalQuaternion([0, -1, 0, 0]), [0, 1, 0, 0], 15);
    close(R.canonicalQuaternion([0, 0, 0, 0]), [0, 0, 0, 1], 15);
    close(R.canonicalQuaternion([NaN, 0, 0, 1]), [0, 0, 0, 1], 15);
  });

  it('stores columns 0 and 1 as 6D', () => {
    // A quarter turn about Z takes x to y and y to -x.
    close(R.quaternionToSixD([0, 0, Math.SQRT1_2, Math.SQRT1_2]), [0, 1, 0, -1, 0, 0]);
  });

  it('makes a rotation of any six numbers', () => {
    close(R.sixDToQuaternion([2, 0, 0, 5, 3, 0]), [0, 0, 0, 1]);
    for (const bad of [
      [0, 0, 0, 0, 0, 0],
      [1, 2, 3, 2, 4, 6],
      [0, 1, 0, 0, 2, 0],
      [NaN, 0, 0, 0, 1, 0],
      [1, 0, 0, Infinity, 0, 0],
    ]) {
      const q = R.sixDToQuaternion(bad);
      expect(Math.hypot(q[0], q[1], q[2], q[3])).toBeCloseTo(1, 6);
    }
  });

  it('multiplies from the right', () => {
    const x = R.axisAngleToQuaternion([Math.PI / 2, 0, 0]);
    const y = R.axisAngleToQuaternion([0, Math.PI / 2, 0]);
    // First x takes +Y to +Z, then y takes +Z to +X.
    close(R.rotateVector(R.multiply(y, x), [0, 1, 0]), [1, 0, 0]);
    close(R.multiply(x, R.conjugate(x)), [0, 0, 0, 1]);
  });

  it('interpolates along the short way at an even speed', () => {
    const b = R.axisAngleToQuaternion([0, 1.2, 0]);
    close(R.quaternionToAxisAngle(R.slerp([0, 0, 0, 1], b, 0.25)), [0, 0.3, 0]);
    close(R.quaternionToAxisAngle(R.slerp([0, 0, 0, -1], b, 0.25)), [0, 0.3, 0]);
    expect(R.angleBetween([0, 0, 0, 1], b)).toBeCloseTo(1.2, 12);
    expect(R.angleBetween(b, R.conjugate(R.conjugate(b)))).toBe(0);
    expect(R.angleBetween([0, 0, 0, 1], R.axisAngleToQuaternion([1e-8, 0, 0]))).toBeCloseTo(1e-8, 14);
  });
});
