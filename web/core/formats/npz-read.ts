/**
 * SMPL motions in npz files: AMASS (Mahmood et al. 2019; `poses` [N, 156 or 165], Z up), AIST++ (Li et al. 2021; `smpl_poses` [N, 72],
 * Y up) and what else calls its axis-angles by those names. The first 22 joints of SMPL, SMPL-H and SMPL-X are the same, and ours.
 */
import { axisAngleToQuaternion } from '../rotation';
import { JOINT_COUNT } from '../skeleton';
import { readNpy, type NumberArray } from './npy-read';
import { axisOf, frameStep, meanUp, turnUpright, type PoseClips, type PoseSequence } from './pose-sequence';
import { isZip, zipEntries, type ZipEntry } from './zip-read';

/** Joints before the hands, which SMPL-H and SMPL-X number otherwise. */
const BODY_JOINTS = 22;
const MAX_BYTES = 600e6;
const UPRIGHT = 0.6;
/** Names under which a file keeps its frames per second. */
const RATES = ['mocap_framerate', 'mocap_frame_rate', 'frame_rate', 'fps'];

interface Source {
  /** Frames x width axis-angle numbers, radians. */
  poses: NumberArray;
  /** Frames per second where the file does not say. */
  fps: number;
  /** The way up that such files have. */
  up: [number, number, number];
  /** Nothing that is seen in the motion tells otherwise: the file names both conventions, as Posebeat's own do. */
  sure?: true;
}

/**
 * Reads a SMPL npz file.
 * @throws Error with a sentence for the visitor when it is none, damaged or has other contents
 */
export function readNpz(bytes: Uint8Array): PoseClips {
  if (!isZip(bytes)) throw new Error('This is no npz file: it is damaged or of another kind.');
  let entries: ZipEntry[];
  try {
    entries = zipEntries(bytes);
  } catch {
    throw new Error('This npz file is damaged or was not copied completely: get it again.');
  }
  const array = (key: string): NumberArray | null => {
    const entry = entries.find(({ name }) => name === `${key}.npy`);
    if (!entry) return null;
    let content: Uint8Array;
    try {
      content = entry.read(MAX_BYTES);
    } catch {
      throw new Error(`“${key}” in the npz file is damaged or too large.`);
    }
    return readNpy(content, key);
  };
  const { poses, fps, up, sure } = findPoses(array, entries);
  const rate = RATES.map(array).find((each) => each?.data.length === 1)?.data[0] ?? fps;
  if (!(rate > 0 && rate < 10_000)) throw new Error('The npz file’s frames per second make no sense.');
  const clip = toSequence(poses, rate);
  const seen = sure ? null : axisOf(meanUp(clip), UPRIGHT);
  // What is seen decides between the two conventions; a body that lies is no reason to believe in a third.
  turnUpright(clip, seen && (seen[1] === 1 || seen[2] === 1) ? seen : up);
  return { kind: 'SMPL', clips: [clip] };
}

function findPoses(array: (key: string) => NumberArray | null, entries: readonly ZipEntry[]): Source {
  const aist = array('smpl_poses');
  if (aist) {
    const both = entries.some(({ name }) => name === 'poses.npy');
    return { poses: aist, fps: 60, up: [0, 1, 0], ...(both ? { sure: true } : {}) };
  }
  const amass = array('poses');
  if (amass) return { poses: amass, fps: 30, up: [0, 0, 1] };
  const [root, body] = [array('root_orient'), array('pose_body')];
  if (root && body) return { poses: joined(root, body), fps: 30, up: [0, 0, 1] };
  const names = entries.slice(0, 6).map(({ name }) => name.replace(/\.npy$/, ''));
  throw new Error(
    `This npz file has no SMPL poses: “poses” (AMASS) or “smpl_poses” (AIST++) was looked for, found: ${names.join(', ') || 'nothing'}.`,
  );
}

/** Orientation and body side by side. */
function joined(root: NumberArray, body: NumberArray): NumberArray {
  const frames = root.shape[0] ?? 0;
  if (root.shape[1] !== 3 || body.shape.length !== 2 || body.shape[0] !== frames) {
    throw new Error('“root_orient” and “pose_body” of the npz file do not fit each other.');
  }
  const width = 3 + body.shape[1];
  const data = new Float64Array(frames * width);
  for (let frame = 0; frame < frames; frame++) {
    data.set(root.data.subarray(frame * 3, frame * 3 + 3), frame * width);
    data.set(body.data.subarray(frame * body.shape[1], (frame + 1) * body.shape[1]), frame * width + 3);
  }
  return { shape: [frames, width], data };
}

function toSequence(poses: NumberArray, rate: number): PoseSequence {
  // [N, 24, 3] and a single frame [72] mean the same as [N, 72].
  const shape =
    poses.shape.at(-1) === 3 && poses.shape.length > 1
      ? [...poses.shape.slice(0, -2), poses.shape.at(-2)! * 3]
      : poses.shape;
  const [frames, width] = shape.length === 1 ? [1, shape[0]] : [shape[0], shape[1]];
  if (shape.length > 2 || !(width >= BODY_JOINTS * 3) || width % 3 !== 0) {
    throw new Error(
      `The npz file’s poses have the shape ${poses.shape.join(' x ')}: frames x 72, 156 or 165 axis-angle numbers are understood.`,
    );
  }
  if (frames < 1) throw new Error('This npz file has no frames.');
  const joints = width === JOINT_COUNT * 3 ? JOINT_COUNT : BODY_JOINTS;
  const step = frameStep(frames);
  const kept = Math.ceil(frames / step);
  const quaternions = new Float32Array(kept * JOINT_COUNT * 4);
  for (let i = 3; i < quaternions.length; i += 4) quaternions[i] = 1;
  for (let frame = 0; frame < kept; frame++) {
    for (let joint = 0; joint < joints; joint++) {
      const at = frame * step * width + joint * 3;
      const turn = poses.data.subarray(at, at + 3);
      if (!turn.every(Number.isFinite)) {
        throw new Error(`Frame ${frame * step + 1} of the npz file is not finite: the file is damaged.`);
      }
      quaternions.set(axisAngleToQuaternion(turn), (frame * JOINT_COUNT + joint) * 4);
    }
  }
  return { name: '', fps: rate / step, frames: kept, quaternions };
}
