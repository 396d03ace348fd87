/**
 * A dance as JSON that a program can read without knowing Posebeat. Version 1:
 * ```
 * { "format": "posebeat-motion", "version": 1,
 *   "fps": 30, "frames": 2,                       frames per second, number of frames; frame i is at i / fps seconds
 *   "joints": ["pelvis", ...], "parents": [-1, ...], "offsets": [[0, 0, 0], ...],   rest T-pose, metres from the parent
 *   "root": [[x, y, z], ...],                     pelvis, metres, one row per frame; right-handed, Y up, the rest pose faces +Z
 *   "rotations": [[x, y, z, w, x, y, z, w, ...], ...],   joints' local unit quaternions, one row per frame; joint 0 turns in the world
 *   "song": {"name", "start", "tempo", "beatsPerBar", "beats", "downbeats"},   optional; start: where in the song frame 0 is; beats in seconds from frame 0
 *   "keyPoses": [{"time", "name"}],               optional; seconds from frame 0
 *   "origin": {"motionHash", "frames", ...} }     optional; what the dance was made from (`motion-origin.ts`)
 * ```
 */
import * as v from 'valibot';
import { emptyMotion } from '../motion';
import { canonicalQuaternion } from '../rotation';
import { JOINT_COUNT, JOINTS, OFFSETS, PARENTS } from '../skeleton';
import type { Motion } from '../types';
import { originSchema, type MotionOrigin } from './motion-origin';

const VERSION = 1;
const MAX_FRAMES = 200_000;
const MAX_MARKS = 100_000;
const DIGITS = 6;

const seconds = v.pipe(v.number(), v.finite());
const row = (width: number) =>
  v.custom<number[]>((value) => Array.isArray(value) && value.length === width && value.every(Number.isFinite));
const rows = (width: number) => v.pipe(v.array(row(width)), v.minLength(1), v.maxLength(MAX_FRAMES));
const marks = v.pipe(v.array(seconds), v.maxLength(MAX_MARKS));
const song = v.object({
  name: v.pipe(v.string(), v.maxLength(500)),
  start: seconds,
  tempo: v.pipe(v.number(), v.finite()),
  beatsPerBar: v.picklist([3, 4]),
  beats: marks,
  downbeats: marks,
});
const keyPose = v.object({ time: seconds, name: v.optional(v.pipe(v.string(), v.maxLength(200))) });
const schema = v.object({
  format: v.literal('posebeat-motion'),
  version: v.pipe(v.number(), v.integer(), v.minValue(1)),
  fps: v.pipe(v.number(), v.finite(), v.minValue(1), v.maxValue(1000)),
  frames: v.pipe(v.number(), v.integer()),
  joints: v.array(v.string()),
  root: rows(3),
  rotations: rows(JOINT_COUNT * 4),
  song: v.optional(song),
  keyPoses: v.optional(v.pipe(v.array(keyPose), v.maxLength(MAX_MARKS))),
  // Whatever another program wrote there, the dance is the dance.
  origin: v.fallback(v.optional(originSchema), undefined),
});

/** The music and the key poses that a dance goes with, and where it comes from. */
export interface MotionNotes {
  song?: v.InferOutput<typeof song>;
  keyPoses?: v.InferOutput<typeof keyPose>[];
  origin?: MotionOrigin;
}

const short = (value: number) => Number(value.toFixed(DIGITS)) + 0;

/**
 * Writes the file; numbers have six digits after the point.
 * @throws Error when the dance has no frames
 */
export function writeMotionJson(motion: Motion, notes: MotionNotes = {}): string {
  const { fps, frames, root, quaternions } = motion;
  if (frames < 1) throw new Error('The dance has no frames yet: generate it first.');
  const lines = (values: Float32Array, width: number) => {
    const out: string[] = [];
    for (let at = 0; at < frames * width; at += width) {
      out.push(JSON.stringify(Array.from(values.subarray(at, at + width), short)));
    }
    return `[\n${out.join(',\n')}\n]`;
  };
  const head = {
    format: 'posebeat-motion',
    version: VERSION,
    fps,
    frames,
    joints: JOINTS,
    parents: PARENTS,
    offsets: OFFSETS,
  };
  const members = [
    ...Object.entries({ ...head, ...notes }).map(([name, value]) => `"${name}": ${JSON.stringify(value)}`),
    `"root": ${lines(root, 3)}`,
    `"rotations": ${lines(quaternions, JOINT_COUNT * 4)}`,
  ];
  return `{\n${members.join(',\n')}\n}\n`;
}

/** True for text that may be such a file. */
export function looksLikeMotionJson(text: string): boolean {
  return /^\s*\{/.test(text) && text.slice(0, 2000).includes('"posebeat-motion"');
}

/**
 * Reads the file.
 * @throws Error with a sentence for the visitor when it is none, damaged, of a newer version or of another skeleton
 */
export function readMotionJson(text: string): { motion: Motion } & MotionNotes {
  let raw: unknown;
  try {
    raw = JSON.parse(text);
  } catch {
    throw new Error('This dance file is no JSON: it is damaged or cut off.');
  }
  const parsed = v.safeParse(schema, raw);
  if (!parsed.success) {
    const where = v.getDotPath(parsed.issues[0]) ?? 'the file';
    throw new Error(`This is no dance file of Posebeat, or it is damaged: “${where}” is wrong.`);
  }
  const { version, fps, frames, joints, root, rotations, song: music, keyPoses, origin } = parsed.output;
  if (version > VERSION) throw new Error('This dance file was made by a newer Posebeat: reload the page.');
  if (joints.length !== JOINT_COUNT || joints.some((name, i) => name !== JOINTS[i])) {
    throw new Error('This dance file is of another skeleton: 24 joints of SMPL are understood.');
  }
  if (root.length !== frames || rotations.length !== frames) {
    throw new Error(`This dance file should have ${frames} frames but has ${root.length} and ${rotations.length}.`);
  }
  const motion = { ...emptyMotion(frames), fps };
  for (let frame = 0; frame < frames; frame++) {
    motion.root.set(root[frame], frame * 3);
    const pose = rotations[frame];
    for (let i = 0; i < pose.length; i += 4) {
      motion.quaternions.set(canonicalQuaternion(pose.slice(i, i + 4)), frame * JOINT_COUNT * 4 + i);
    }
  }
  return {
    motion,
    ...(music ? { song: music } : {}),
    ...(keyPoses ? { keyPoses } : {}),
    ...(origin ? { origin } : {}),
  };
}
