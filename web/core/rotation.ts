/**
 * Rotations: axis-angle (radians), unit quaternions x y z w, and 6D = column 0 then column 1 of the matrix (Zhou et al. 2019,
 * "On the continuity of rotation representations in neural networks").
 * Every function reads any array-like, writes `out` when it is given (it may be one of the inputs) and returns it.
 */

/** What is read. */
export type Numbers = ArrayLike<number>;
/** What can be written. */
export type Writable = number[] | Float32Array | Float64Array;

const JOINTS_IN_POSE = 24;

/** Same rotation, unit length, with the sign that makes w >= 0 (at w = 0 the first non-zero of x, y, z is positive). */
export function canonicalQuaternion<T extends Writable = number[]>(
  q: Numbers,
  out: T = [0, 0, 0, 1] as Writable as T,
): T {
  const [x, y, z, w] = [q[0], q[1], q[2], q[3]];
  const length = Math.sqrt(x * x + y * y + z * z + w * w);
  if (!(length > 1e-12)) return set(out, 0, 0, 0, 1);
  const negative = w < 0 || (w === 0 && (x < 0 || (x === 0 && (y < 0 || (y === 0 && z < 0)))));
  const scale = (negative ? -1 : 1) / length;
  return set(out, x * scale, y * scale, z * scale, w * scale);
}

function set<T extends Writable>(out: T, x: number, y: number, z: number, w: number): T {
  // `+ 0` turns a negative zero into zero, so that equal rotations are equal numbers.
  out[0] = x + 0;
  out[1] = y + 0;
  out[2] = z + 0;
  out[3] = w + 0;
  return out;
}

/** Rotation vector of any length (radians) to a canonical quaternion. */
export function axisAngleToQuaternion<T extends Writable = number[]>(
  aa: Numbers,
  out: T = [0, 0, 0, 1] as Writable as T,
): T {
  const [x, y, z] = [aa[0], aa[1], aa[2]];
  const angle = Math.hypot(x, y, z);
  // Below 1e-4 rad the series is exact to double precision and needs no division by the angle.
  const scale = angle < 1e-4 ? 0.5 - (angle * angle) / 48 : Math.sin(angle / 2) / angle;
  return canonicalQuaternion([x * scale, y * scale, z * scale, Math.cos(angle / 2)], out);
}

/** Quaternion (any sign) to the shortest rotation vector, 0..pi radians long. */
export function quaternionToAxisAngle<T extends Writable = number[]>(
  q: Numbers,
  out: T = [0, 0, 0] as Writable as T,
): T {
  const [x, y, z, w] = canonicalQuaternion(q);
  const sine = Math.hypot(x, y, z);
  const scale = sine < 1e-9 ? 2 / w : (2 * Math.atan2(sine, w)) / sine;
  out[0] = x * scale;
  out[1] = y * scale;
  out[2] = z * scale;
  return out;
}

/** Columns 0 and 1 of the rotation matrix of a unit quaternion: 6 numbers. */
export function quaternionToSixD<T extends Writable = number[]>(
  q: Numbers,
  out: T = [0, 0, 0, 0, 0, 0] as Writable as T,
): T {
  const [x, y, z, w] = [q[0], q[1], q[2], q[3]];
  out[0] = 1 - 2 * (y * y + z * z);
  out[1] = 2 * (x * y + w * z);
  out[2] = 2 * (x * z - w * y);
  out[3] = 2 * (x * y - w * z);
  out[4] = 1 - 2 * (x * x + z * z);
  out[5] = 2 * (y * z + w * x);
  return out;
}

/**
 * Nearest proper rotation by Gram-Schmidt (Zhou et al. 2019, eq. 15), as a canonical quaternion.
 * Columns that are zero, parallel or not finite still give a rotation, so that a bad network output never becomes NaN.
 */
export function sixDToQuaternion<T extends Writable = number[]>(
  sixD: Numbers,
  out: T = [0, 0, 0, 1] as Writable as T,
): T {
  let [ax, ay, az] = [sixD[0], sixD[1], sixD[2]];
  let length = Math.sqrt(ax * ax + ay * ay + az * az);
  if (usable(length)) [ax, ay, az] = [ax / length, ay / length, az / length];
  else [ax, ay, az] = [1, 0, 0];
  const along = ax * sixD[3] + ay * sixD[4] + az * sixD[5];
  let [bx, by, bz] = [sixD[3] - along * ax, sixD[4] - along * ay, sixD[5] - along * az];
  length = Math.sqrt(bx * bx + by * by + bz * bz);
  if (!usable(length)) {
    // Any direction across `a` will do: cross it with the axis that it is not near to.
    [bx, by, bz] = Math.abs(ay) < 0.9 ? [az, 0, -ax] : [-ay, ax, 0];
    length = Math.sqrt(bx * bx + by * by + bz * bz);
  }
  [bx, by, bz] = [bx / length, by / length, bz / length];
  const [cx, cy, cz] = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
  return matrixToQuaternion([ax, bx, cx, ay, by, cy, az, bz, cz], out);
}

function usable(length: number): boolean {
  return length > 1e-8 && length < Infinity;
}

/** Row-major 3 x 3 rotation matrix to a canonical quaternion, dividing by the largest component (Shepperd 1978). */
export function matrixToQuaternion<T extends Writable = number[]>(
  m: Numbers,
  out: T = [0, 0, 0, 1] as Writable as T,
): T {
  const trace = m[0] + m[4] + m[8];
  let q: number[];
  if (trace > Math.max(m[0], m[4], m[8])) q = [m[7] - m[5], m[2] - m[6], m[3] - m[1], 1 + trace];
  else if (m[0] > m[4] && m[0] > m[8]) q = [1 + m[0] - m[4] - m[8], m[1] + m[3], m[2] + m[6], m[7] - m[5]];
  else if (m[4] > m[8]) q = [m[1] + m[3], 1 - m[0] + m[4] - m[8], m[5] + m[7], m[2] - m[6]];
  else q = [m[2] + m[6], m[5] + m[7], 1 - m[0] - m[4] + m[8], m[3] - m[1]];
  return canonicalQuaternion(q, out);
}

/** Hamilton product: `multiply(a, b)` turns by b first, then by a. */
export function multiply<T extends Writable = number[]>(
  a: Numbers,
  b: Numbers,
  out: T = [0, 0, 0, 1] as Writable as T,
): T {
  const [ax, ay, az, aw] = [a[0], a[1], a[2], a[3]];
  const [bx, by, bz, bw] = [b[0], b[1], b[2], b[3]];
  out[0] = aw * bx + ax * bw + ay * bz - az * by;
  out[1] = aw * by - ax * bz + ay * bw + az * bx;
  out[2] = aw * bz + ax * by - ay * bx + az * bw;
  out[3] = aw * bw - ax * bx - ay * by - az * bz;
  return out;
}

/** The inverse of a unit quaternion. */
export function conjugate<T extends Writable = number[]>(q: Numbers, out: T = [0, 0, 0, 1] as Writable as T): T {
  out[0] = -q[0];
  out[1] = -q[1];
  out[2] = -q[2];
  out[3] = q[3];
  return out;
}

/** A vector turned by a unit quaternion. */
export function rotateVector<T extends Writable = number[]>(
  q: Numbers,
  v: Numbers,
  out: T = [0, 0, 0] as Writable as T,
): T {
  const [x, y, z, w] = [q[0], q[1], q[2], q[3]];
  const [vx, vy, vz] = [v[0], v[1], v[2]];
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  out[0] = vx + w * tx + y * tz - z * ty;
  out[1] = vy + w * ty + z * tx - x * tz;
  out[2] = vz + w * tz + x * ty - y * tx;
  return out;
}

/** Shortest great-circle interpolation between unit quaternions; `t` = 0 gives a, 1 gives b. */
export function slerp<T extends Writable = number[]>(
  a: Numbers,
  b: Numbers,
  t: number,
  out: T = [0, 0, 0, 1] as Writable as T,
): T {
  const dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const cosine = Math.min(Math.abs(dot), 1);
  let from = 1 - t;
  let to = t;
  // Within 0.06 degrees the chord and the arc agree to 1e-7, and the sine would be too small to divide by.
  if (cosine < 0.9999995) {
    const angle = Math.acos(cosine);
    from = Math.sin(from * angle) / Math.sin(angle);
    to = Math.sin(to * angle) / Math.sin(angle);
  }
  if (dot < 0) to = -to;
  const x = from * a[0] + to * b[0];
  const y = from * a[1] + to * b[1];
  const z = from * a[2] + to * b[2];
  const w = from * a[3] + to * b[3];
  const scale = 1 / (Math.sqrt(x * x + y * y + z * z + w * w) || 1);
  return set(out, x * scale, y * scale, z * scale, w * scale);
}

/** Angle of the rotation between two unit quaternions, 0..pi radians, exact near 0 too. */
export function angleBetween(a: Numbers, b: Numbers): number {
  const [x, y, z, w] = multiply(conjugate(a), b);
  return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
}

/** A pose of 24 x 3 axis-angle numbers as 24 x 4 quaternions. */
export function poseToQuaternions(
  rotations: Numbers,
  out: Float32Array = new Float32Array(JOINTS_IN_POSE * 4),
): Float32Array {
  const q = [0, 0, 0, 1];
  for (let joint = 0; joint < JOINTS_IN_POSE; joint++) {
    const i = joint * 3;
    axisAngleToQuaternion([rotations[i], rotations[i + 1], rotations[i + 2]], q);
    out.set(q, joint * 4);
  }
  return out;
}

/** A pose of 24 x 4 quaternions as 24 x 3 axis-angle numbers. */
export function quaternionsToPose(quaternions: Numbers): number[] {
  const pose: number[] = [];
  const aa = [0, 0, 0];
  for (let joint = 0; joint < JOINTS_IN_POSE; joint++) {
    const i = joint * 4;
    quaternionToAxisAngle([quaternions[i], quaternions[i + 1], quaternions[i + 2], quaternions[i + 3]], aa);
    pose.push(aa[0], aa[1], aa[2]);
  }
  return pose;
}

/** 24 x 4 quaternions as 144 numbers, 6 a joint. */
export function quaternionsToSixD(
  quaternions: Numbers,
  out: Float32Array = new Float32Array(JOINTS_IN_POSE * 6),
): Float32Array {
  const sixD = [0, 0, 0, 0, 0, 0];
  for (let joint = 0; joint < JOINTS_IN_POSE; joint++) {
    const i = joint * 4;
    quaternionToSixD([quaternions[i], quaternions[i + 1], quaternions[i + 2], quaternions[i + 3]], sixD);
    out.set(sixD, joint * 6);
  }
  return out;
}
