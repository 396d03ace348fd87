/**
 * How far each joint of the body turns. A local rotation is split into a twist about the bone and the swing that then points the bone
 * (the decomposition of Dobrowolski 2015, "Swing-twist decomposition in Clifford algebra"); the swing's rotation vector must lie in a
 * convex region, the twist in a range. Clamping goes to the nearest point of the region, so it is continuous and never flips a limb.
 * The ranges and their sources are in joint-limits-table.ts.
 */
import { ACROSS, JOINT_LIMITS, Y, type JointLimit, type Point } from './joint-limits-table';
import type { Numbers, Writable } from './rotation';
import { JOINT_COUNT } from './skeleton';

export { JOINT_LIMITS, type JointLimit } from './joint-limits-table';

const DEGREES = 180 / Math.PI;
/** Rounding of single precision must not count as beyond the limit; degrees. */
const TOLERANCE = 0.01;

/** A rotation taken apart, degrees: swing over the two axes across the bone, twist, and how far each is beyond its limit. */
interface Split {
  u: number;
  v: number;
  twist: number;
  /** Nearest swing inside. */
  insideU: number;
  insideV: number;
  insideTwist: number;
  swingExcess: number;
  twistExcess: number;
}

const scratch: Split = {
  u: 0,
  v: 0,
  twist: 0,
  insideU: 0,
  insideV: 0,
  insideTwist: 0,
  swingExcess: 0,
  twistExcess: 0,
};

function split(limit: JointLimit, q: Numbers): Split {
  const s = scratch;
  const { axis } = limit;
  const [a, b] = ACROSS[axis];
  const sign = q[3] < 0 ? -1 : 1;
  const w = q[3] * sign;
  const along = q[axis] * sign;
  const h = Math.hypot(along, w);
  // Swung by half a turn there is no telling swing from twist: take it all for swing.
  const [c, d] = h > 1e-9 ? [w / h, along / h] : [1, 0];
  // swing = q x inverse(twist); its part along the bone is zero by construction.
  const handed = axis === Y ? -1 : 1;
  const [qa, qb] = [q[a] * sign, q[b] * sign];
  const x = c * qa - handed * d * qb;
  const y = c * qb + handed * d * qa;
  const sine = Math.hypot(x, y);
  const scale = sine > 1e-12 ? (2 * Math.atan2(sine, h) * DEGREES) / sine : 2 * DEGREES;
  s.u = x * scale;
  s.v = y * scale;
  const [least, most] = limit.twist;
  const middle = (least + most) / 2;
  let twist = 2 * Math.atan2(d, c) * DEGREES;
  // The turn is counted from the middle of the range, so that the far side is where clamping changes ends.
  twist -= 360 * Math.round((twist - middle) / 360);
  s.twist = twist;
  s.insideTwist = Math.min(Math.max(twist, least), most);
  s.twistExcess = Math.abs(twist - s.insideTwist);
  nearestInside(limit.swing, s);
  return s;
}

/** Nearest point of a convex region (corners counter-clockwise). */
function nearestInside(corners: readonly Point[], s: Split): void {
  let outside = false;
  let best = Infinity;
  for (let i = 0, j = corners.length - 1; i < corners.length; j = i++) {
    const [ax, ay] = corners[j];
    const [ex, ey] = [corners[i][0] - ax, corners[i][1] - ay];
    const [px, py] = [s.u - ax, s.v - ay];
    if (ex * py - ey * px >= 0) continue;
    outside = true;
    const t = Math.min(Math.max((px * ex + py * ey) / (ex * ex + ey * ey), 0), 1);
    const [x, y] = [ax + t * ex, ay + t * ey];
    const distance = Math.hypot(s.u - x, s.v - y);
    if (distance < best) {
      best = distance;
      s.insideU = x;
      s.insideV = y;
    }
  }
  s.swingExcess = outside ? best : 0;
  if (!outside) {
    s.insideU = s.u;
    s.insideV = s.v;
  }
}

/**
 * How far a joint is turned beyond its range.
 * @param q local rotation, x y z w
 * @returns degrees; 0 inside
 */
export function limitExcess(joint: number, q: Numbers): number {
  const limit = JOINT_LIMITS[joint];
  if (!limit) return 0;
  const { swingExcess, twistExcess } = split(limit, q);
  return Math.max(swingExcess, twistExcess);
}

/**
 * The nearest rotation that the joint can reach; a rotation inside comes back as it is.
 * @param q local rotation, unit quaternion x y z w
 * @param slack degrees beyond the limits that are let pass, for a joint that was outside before
 */
export function clampRotation<T extends Writable = number[]>(
  joint: number,
  q: Numbers,
  out: T = [0, 0, 0, 1] as Writable as T,
  slack = 0,
): T {
  const limit = JOINT_LIMITS[joint];
  const s = limit && split(limit, q);
  if (!s || Math.max(s.swingExcess, s.twistExcess) <= slack + TOLERANCE) {
    for (let i = 0; i < 4; i++) out[i] = q[i];
    return out;
  }
  const swingShare = s.swingExcess > slack ? slack / s.swingExcess : 1;
  const twistShare = s.twistExcess > slack ? slack / s.twistExcess : 1;
  const u = s.insideU + (s.u - s.insideU) * swingShare;
  const v = s.insideV + (s.v - s.insideV) * swingShare;
  const twist = s.insideTwist + (s.twist - s.insideTwist) * twistShare;

  // On the side of the quaternions' sphere where the given rotation is.
  const r = join(limit, u, v, twist);
  const sign = r[0] * q[0] + r[1] * q[1] + r[2] * q[2] + r[3] * q[3] < 0 ? -1 : 1;
  for (let i = 0; i < 4; i++) out[i] = sign * r[i];
  return out;
}

/** The rotation of a swing and a twist, degrees. */
function join({ axis }: JointLimit, u: number, v: number, twist: number): number[] {
  const [a, b] = ACROSS[axis];
  const angle = Math.hypot(u, v) / DEGREES;
  const scale = angle > 1e-9 ? Math.sin(angle / 2) / angle / DEGREES : 0.5 / DEGREES;
  const [x, y, h] = [u * scale, v * scale, Math.cos(angle / 2)];
  const [c, d] = [Math.cos(twist / 2 / DEGREES), Math.sin(twist / 2 / DEGREES)];
  const handed = axis === Y ? -1 : 1;
  const q = [0, 0, 0, h * c];
  q[a] = c * x + handed * d * y;
  q[b] = c * y - handed * d * x;
  q[axis] = h * d;
  return q;
}

/** Rotations spread over a joint's range: half-way and nearly all the way out to each corner of its swing, with five twists each; quaternions x y z w. */
export function directions(joint: number): number[][] {
  const limit = JOINT_LIMITS[joint];
  if (!limit) return [];
  const { swing, twist } = limit;
  const [x, y] = [0, 1].map((i) => swing.reduce((sum, corner) => sum + corner[i], 0) / swing.length);
  return [0.5, 0.9].flatMap((out) =>
    [0.5, 0.25, 0.75, 0.05, 0.95].flatMap((share) =>
      swing.map(([u, v]) =>
        join(limit, x + (u - x) * out, y + (v - y) * out, twist[0] + share * (twist[1] - twist[0])),
      ),
    ),
  );
}

/**
 * A pose with every joint inside its range.
 * @param quaternions 24 x 4 local rotations
 * @returns a new 24 x 4
 */
export function clampPose(quaternions: Numbers): Float32Array {
  const clamped = Float32Array.from(quaternions);
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const q = clamped.subarray(joint * 4, joint * 4 + 4);
    clampRotation(joint, q, q);
  }
  return clamped;
}

/**
 * Whether a joint is inside its range.
 * @param q local rotation, x y z w
 */
export function withinLimits(joint: number, q: Numbers, toleranceDegrees = 0.5): boolean {
  return limitExcess(joint, q) <= toleranceDegrees;
}
