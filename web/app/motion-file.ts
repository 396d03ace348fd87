/**
 * A dance as compact bytes (the demo): little-endian
 * `PBM1`, uint32 frames, float32 fps, then for each frame the root x y z as int16 (half millimetres),
 * then for each frame 24 quaternions x y z w as int16 (32767 = 1).
 */
import { JOINT_COUNT } from '../core/skeleton';
import type { Motion } from '../core/types';

const MAGIC = 0x314d4250; // "PBM1", read as a little-endian number
const HEADER_BYTES = 12;
const ROOT_SCALE = 2000;
const QUATERNION_SCALE = 32767;
const MAX_FRAMES = 200_000;

/** Bytes of a dance. Rotations keep 2e-5, positions half a millimetre. */
export function writeMotion(motion: Motion): ArrayBuffer {
  const { frames } = motion;
  const bytes = new ArrayBuffer(HEADER_BYTES + frames * (3 + JOINT_COUNT * 4) * 2);
  const header = new DataView(bytes);
  header.setUint32(0, MAGIC, true);
  header.setUint32(4, frames, true);
  header.setFloat32(8, motion.fps, true);
  const root = new Int16Array(bytes, HEADER_BYTES, frames * 3);
  const quaternions = new Int16Array(bytes, HEADER_BYTES + frames * 6, frames * JOINT_COUNT * 4);
  for (let i = 0; i < root.length; i += 1) root[i] = Math.round(motion.root[i] * ROOT_SCALE);
  for (let i = 0; i < quaternions.length; i += 1) quaternions[i] = Math.round(motion.quaternions[i] * QUATERNION_SCALE);
  return bytes;
}

/**
 * The dance in such bytes.
 * @throws Error when they are none
 */
export function readMotion(bytes: ArrayBuffer): Motion {
  if (bytes.byteLength < HEADER_BYTES) throw new Error('This is no dance file: it is too short.');
  const header = new DataView(bytes);
  const frames = header.getUint32(4, true);
  const fps = header.getFloat32(8, true);
  const expected = HEADER_BYTES + frames * (3 + JOINT_COUNT * 4) * 2;
  if (header.getUint32(0, true) !== MAGIC || frames > MAX_FRAMES || !(fps > 0))
    throw new Error('This is no dance file.');
  if (bytes.byteLength !== expected) throw new Error('The dance file is cut off or damaged.');
  const root = Float32Array.from(new Int16Array(bytes, HEADER_BYTES, frames * 3), (value) => value / ROOT_SCALE);
  const packed = new Int16Array(bytes, HEADER_BYTES + frames * 6, frames * JOINT_COUNT * 4);
  const quaternions = new Float32Array(packed.length);
  for (let i = 0; i < packed.length; i += 4) {
    const length = Math.hypot(packed[i], packed[i + 1], packed[i + 2], packed[i + 3]) || 1;
    for (let k = i; k < i + 4; k += 1) quaternions[k] = packed[k] / length;
  }
  return { fps, frames, root, quaternions };
}
