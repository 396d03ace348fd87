/** Euler angles Z Y X: R = Rz(z) Ry(y) Rx(x), the order in which a BVH file's channels Zrotation Yrotation Xrotation are applied. */
import type { Numbers } from '../rotation';

const TURN = 2 * Math.PI;
/** Below this the sum (or the difference) of z and x is not told by the rotation, and a free choice moves it by less than 1e-5 rad. */
const LOCKED = 1e-6;

/** The whole turns that bring an angle nearest to another. */
const nearest = (angle: number, to: number) => angle + TURN * Math.round((to - angle) / TURN);

/**
 * Angles of a unit quaternion, radians, as near to `before` as they can be: of the two triples that stand for one rotation, and of all
 * their whole turns, the nearest is taken, and at a quarter turn about Y (gimbal lock) z and x go on as they were. So plain
 * interpolation between frames, as animation programs do it, never spins the long way round.
 *
 * Half sums and half differences of z and x come from two atan2, without the arcsine that loses digits near the lock (the idea of
 * Bernardes and Viollet 2022, "Quaternion to Euler angles conversion: A direct, general and computationally efficient method").
 * @param before the frame before: z, y, x
 * @returns z, y, x
 */
export function quaternionToZyx(q: Numbers, before: Numbers = [0, 0, 0]): [number, number, number] {
  const [x, y, z, w] = [q[0], q[1], q[2], q[3]];
  // (cos y/2 - sin y/2) (cos, sin) of (z + x) / 2, and (cos y/2 + sin y/2) (cos, sin) of (z - x) / 2.
  const below = Math.hypot(w - y, x + z);
  const above = Math.hypot(w + y, z - x);
  const half = below > LOCKED ? Math.atan2(x + z, w - y) : (before[0] + before[2]) / 2;
  const apart = above > LOCKED ? Math.atan2(z - x, w + y) : (before[0] - before[2]) / 2;
  const pitch = 2 * Math.atan2(above, below) - Math.PI / 2;
  const [first, other] = [
    [half + apart, pitch, half - apart],
    [half + apart + Math.PI, Math.PI - pitch, half - apart + Math.PI],
  ].map((angles) => angles.map((angle, k) => nearest(angle, before[k])) as [number, number, number]);
  const way = (angles: readonly number[]) => angles.reduce((sum, angle, k) => sum + (angle - before[k]) ** 2, 0);
  return way(other) < way(first) - 1e-9 ? other : first;
}
