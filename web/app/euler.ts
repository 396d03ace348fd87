/** A joint's rotation as three angles a person can type. */
import { axisAngleToQuaternion, multiply, quaternionToAxisAngle } from '../core/rotation';

const DEGREES = 180 / Math.PI;

/** x, y, z degrees, applied about the joint's own axes in the order x, y, z (R = Rx Ry Rz). */
export type Degrees = [number, number, number];

/** Axis-angle radians to x, y, z degrees; y stays within +-90. */
export function axisAngleToEuler(turn: ArrayLike<number>): Degrees {
  const [x, y, z, w] = axisAngleToQuaternion(turn);
  const sine = Math.min(Math.max(2 * (x * z + w * y), -1), 1);
  if (Math.abs(sine) > 0.999999) {
    // Gimbal lock: x and z turn about the same line, so all of it goes to x.
    return [2 * Math.atan2(x, w) * DEGREES, Math.sign(sine) * 90, 0];
  }
  return [
    Math.atan2(2 * (w * x - y * z), 1 - 2 * (x * x + y * y)) * DEGREES,
    Math.asin(sine) * DEGREES,
    Math.atan2(2 * (w * z - x * y), 1 - 2 * (y * y + z * z)) * DEGREES,
  ];
}

/** x, y, z degrees to axis-angle radians. */
export function eulerToAxisAngle(degrees: readonly [number, number, number]): Degrees {
  const [x, y, z] = degrees.map((angle) => angle / DEGREES);
  const turn = multiply(
    axisAngleToQuaternion([x, 0, 0]),
    multiply(axisAngleToQuaternion([0, y, 0]), axisAngleToQuaternion([0, 0, z])),
  );
  const [ax, ay, az] = quaternionToAxisAngle(turn);
  return [ax, ay, az];
}
