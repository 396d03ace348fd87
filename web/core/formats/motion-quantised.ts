/**
 * A dance as the bytes that its hash is of. Two dances have the same hash when they are the same to a tenth of a millimetre and
 * 1/16384 of a quaternion (0.007 degrees); two that lie on either side of a rounding step differ, however near they are. Little-endian:
 *
 * - `PBQ1`, frames per second (float32), number of frames (uint32);
 * - root: frames x 3 int32, tenths of a millimetre;
 * - rotations: frames x 24 x 4 int16, x y z w times 16384, of the sign that makes w >= 0.
 */
import { canonicalQuaternion } from '../rotation';
import { JOINT_COUNT } from '../skeleton';
import type { Motion } from '../types';

const MAGIC = 0x31514250; // "PBQ1", read as a little-endian number
const METRE = 10_000;
const UNIT = 16_384;

/** The bytes of a dance, to be hashed with SHA-256. */
export function quantisedMotion({ fps, frames, root, quaternions }: Motion): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(12 + frames * (12 + JOINT_COUNT * 8));
  const view = new DataView(bytes.buffer);
  view.setUint32(0, MAGIC, true);
  view.setFloat32(4, fps, true);
  view.setUint32(8, frames, true);
  let at = 12;
  for (let i = 0; i < frames * 3; i += 1, at += 4) view.setInt32(at, Math.round(root[i] * METRE), true);
  const part = new Float64Array(4);
  for (let i = 0; i < frames * JOINT_COUNT * 4; i += 4) {
    canonicalQuaternion(quaternions.subarray(i, i + 4), part);
    for (const value of part) {
      view.setInt16(at, Math.round(value * UNIT), true);
      at += 2;
    }
  }
  return bytes;
}
