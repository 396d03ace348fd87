import { rotateVector, type Numbers } from '../core/rotation';

/** Direction that a pose faces on the floor, radians about Y, 0 = +Z. For a pelvis lying flat, the direction of its top or bottom. */
export function headingOf(quaternions: Numbers): number {
  const q = [0, 1, 2, 3].map((i) => quaternions[i]);
  const forward = rotateVector(q, [0, 0, 1]);
  if (Math.hypot(forward[0], forward[2]) > 0.25) return Math.atan2(forward[0], forward[2]);
  const up = rotateVector(q, [0, 1, 0]);
  const sign = forward[1] > 0 ? -1 : 1;
  return Math.atan2(sign * up[0], sign * up[2]);
}
