/**
 * A dance as compact bytes (the demo's dance.bin), about 140 bytes a frame, little-endian:
 * - `PBM2`, then uint32: length of the header text, which is padded with spaces to a multiple of 4;
 * - the header, JSON: {version, fps, frames, joints: indices of the joints that move at all};
 * - root: frames x 3 float32, metres;
 * - rotations: frames x joints x 3 uint16. A unit quaternion's largest part follows from the other three, which lie within
 *   +-sqrt(1/2) and take 15 bits each ("smallest three"); the free top bits of the first two words say which part was left out.
 */
import { alignSigns, emptyMotion } from '../motion';
import { JOINT_COUNT } from '../skeleton';
import type { Motion } from '../types';

const MAGIC = 0x324d4250; // "PBM2", read as a little-endian number
const VERSION = 1;
const MAX_FRAMES = 200_000;
const STEPS = 0x7fff;
const LARGEST = Math.SQRT1_2;
/** Parts that are stored when part i is left out. */
const OTHERS = [0, 1, 2, 3].map((left) => [0, 1, 2, 3].filter((part) => part !== left));

interface Header {
  version: number;
  fps: number;
  frames: number;
  joints: number[];
}

/**
 * Bytes of a dance. Rotations keep 2e-4 radians, the root its full precision.
 * @throws Error when the arrays do not fit the number of frames or hold numbers that are not finite
 */
export function encodeMotion(motion: Motion): Uint8Array<ArrayBuffer> {
  const { frames, fps, root, quaternions } = motion;
  if (root.length !== frames * 3 || quaternions.length !== frames * JOINT_COUNT * 4) {
    throw new Error(
      `A dance of ${frames} frames has ${root.length} positions and ${quaternions.length} rotation numbers.`,
    );
  }
  if (!root.every(Number.isFinite) || !quaternions.every(Number.isFinite)) {
    throw new Error('The dance holds numbers that are not finite.');
  }
  const joints = movingJoints(motion);
  const text = JSON.stringify({ version: VERSION, fps, frames, joints } satisfies Header);
  const header = new TextEncoder().encode(text.padEnd(Math.ceil(text.length / 4) * 4));
  const bytes = new Uint8Array(8 + header.length + frames * (12 + joints.length * 6));
  const view = new DataView(bytes.buffer);
  view.setUint32(0, MAGIC, true);
  view.setUint32(4, header.length, true);
  bytes.set(header, 8);
  let at = 8 + header.length;
  for (const value of root) {
    view.setFloat32(at, value, true);
    at += 4;
  }
  for (let t = 0; t < frames; t++) {
    for (const joint of joints) {
      writeRotation(view, at, quaternions, (t * JOINT_COUNT + joint) * 4);
      at += 6;
    }
  }
  return bytes;
}

/**
 * The dance in such bytes; neighbouring frames' quaternions have the same sign.
 * @throws Error when they are no dance, of a newer version, or cut off
 */
export function decodeMotion(bytes: ArrayBuffer | Uint8Array): Motion {
  const data = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  if (data.length < 8 || view.getUint32(0, true) !== MAGIC) throw new Error('This is no dance file.');
  const length = view.getUint32(4, true);
  const { fps, frames, joints } = readHeader(data.subarray(8, 8 + length));
  let at = 8 + length;
  if (data.length !== at + frames * (12 + joints.length * 6)) throw new Error('The dance file is cut off or damaged.');
  const motion = emptyMotion(frames);
  motion.fps = fps;
  for (let i = 0; i < frames * 3; i++, at += 4) motion.root[i] = view.getFloat32(at, true);
  for (let t = 0; t < frames; t++) {
    for (const joint of joints) {
      readRotation(view, at, motion.quaternions, (t * JOINT_COUNT + joint) * 4);
      at += 6;
    }
  }
  return alignSigns(motion);
}

function readHeader(bytes: Uint8Array): Header {
  let header: Partial<Header>;
  try {
    header = JSON.parse(new TextDecoder().decode(bytes)) as Partial<Header>;
  } catch {
    throw new Error('The dance file is cut off or damaged.');
  }
  const { version, fps, frames, joints } = header ?? {};
  if (version !== VERSION) throw new Error('This dance file was made by another Posebeat: reload the page.');
  const isJoint = (joint: unknown) =>
    Number.isInteger(joint) && (joint as number) >= 0 && (joint as number) < JOINT_COUNT;
  const sound =
    typeof fps === 'number' && fps > 0 && fps < 1000 &&
    typeof frames === 'number' && Number.isInteger(frames) && frames >= 0 && frames <= MAX_FRAMES &&
    Array.isArray(joints) && joints.every(isJoint) && new Set(joints).size === joints.length; // prettier-ignore
  if (!sound) throw new Error('The dance file is cut off or damaged.');
  return { version, fps, frames, joints };
}

/** Joints that are not the identity in every frame: hands never move, and need no bytes. */
function movingJoints({ frames, quaternions }: Motion): number[] {
  const moves = (joint: number): boolean => {
    for (let t = 0; t < frames; t++) {
      const i = (t * JOINT_COUNT + joint) * 4;
      if (Math.abs(quaternions[i]) + Math.abs(quaternions[i + 1]) + Math.abs(quaternions[i + 2]) > 1e-6) return true;
    }
    return false;
  };
  return Array.from({ length: JOINT_COUNT }, (_, joint) => joint).filter(moves);
}

function writeRotation(view: DataView, at: number, q: Float32Array, i: number): void {
  const length = Math.hypot(q[i], q[i + 1], q[i + 2], q[i + 3]) || 1;
  let left = 0;
  for (let part = 1; part < 4; part++) if (Math.abs(q[i + part]) > Math.abs(q[i + left])) left = part;
  // q and -q are the same rotation: the part that is left out is made positive.
  const scale = Math.sign(q[i + left] || 1) / length;
  OTHERS[left].forEach((part, word) => {
    const value = Math.max(-1, Math.min(1, (q[i + part] * scale) / LARGEST));
    const bits = Math.round((value * 0.5 + 0.5) * (STEPS - 1));
    const flag = word === 0 ? left >> 1 : word === 1 ? left & 1 : 0;
    view.setUint16(at + word * 2, bits | (flag << 15), true);
  });
}

function readRotation(view: DataView, at: number, q: Float32Array, i: number): void {
  const words = [view.getUint16(at, true), view.getUint16(at + 2, true), view.getUint16(at + 4, true)];
  const left = ((words[0] >> 15) << 1) | (words[1] >> 15);
  let square = 0;
  OTHERS[left].forEach((part, word) => {
    const value = (((words[word] & STEPS) / (STEPS - 1)) * 2 - 1) * LARGEST;
    q[i + part] = value;
    square += value * value;
  });
  q[i + left] = Math.sqrt(Math.max(0, 1 - square));
}
