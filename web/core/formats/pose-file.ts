/** Files of poses: what the visitor's own library is exported to and imported from. */
import * as v from 'valibot';
import { rotationsSchema } from '../document-schema';

/** Newest version of the format. */
export const POSE_FILE_VERSION = 1;
/** More poses than this are in no library of a person. */
export const MAX_POSES = 5000;
/** Longest name of a pose, characters. */
export const MAX_POSE_NAME = 80;
/** Larger files are refused before they are read: MAX_POSES poses have some 8 MB. */
export const MAX_POSE_FILE_BYTES = 30e6;

/** A pose with a name. */
export interface NamedPose {
  name: string;
  /** 24 x 3 axis-angle, radians. */
  rotations: number[];
}

/** What a file held. */
export interface PoseFile {
  poses: NamedPose[];
  /** Entries that were no pose and are left out. */
  broken: number;
}

const poseSchema = v.object({ name: v.optional(v.string(), ''), rotations: rotationsSchema });

/** A name as it is kept: without control characters and outer spaces, not too long. */
export function poseName(text: string): string {
  // eslint-disable-next-line no-control-regex
  return [...text.replace(/[\u0000-\u001f\u007f-\u009f\u200e\u200f\u202a-\u202e\u2066-\u2069]/g, ' ').trim()]
    .slice(0, MAX_POSE_NAME)
    .join('');
}

/** Writes poses as a file's text. */
export function writePoseFile(poses: readonly NamedPose[]): string {
  const plain = poses.map(({ name, rotations }) => ({ name, rotations }));
  return JSON.stringify({ format: 'posebeat-poses', version: POSE_FILE_VERSION, poses: plain });
}

/** True when parsed JSON says that it is a file of poses. */
export function isPoseJson(raw: unknown): boolean {
  return typeof raw === 'object' && raw !== null && (raw as { format?: unknown }).format === 'posebeat-poses';
}

/**
 * Reads a file of poses, from anybody.
 * @param raw - The parsed JSON.
 * @throws Error with a sentence for the visitor when it is no such file, damaged, too large or of a newer version
 */
export function readPoseFile(raw: unknown): PoseFile {
  if (!isPoseJson(raw)) throw new Error('This file holds no poses: choose one that was exported from “My poses”.');
  const { version, poses } = raw as { version?: unknown; poses?: unknown };
  if (typeof version !== 'number' || !Number.isInteger(version) || version < 1) {
    throw new Error('This pose file has no version: it is damaged.');
  }
  if (version > POSE_FILE_VERSION) {
    throw new Error('These poses were saved by a newer Posebeat: reload the page to get the newest version.');
  }
  if (!Array.isArray(poses)) throw new Error('This pose file is damaged: it has no list of poses.');
  if (poses.length > MAX_POSES)
    throw new Error(`This file has ${poses.length} poses: at most ${MAX_POSES} can be read.`);
  const read: NamedPose[] = [];
  for (const entry of poses) {
    const parsed = v.safeParse(poseSchema, entry);
    if (parsed.success) read.push({ name: poseName(parsed.output.name) || 'Pose', rotations: parsed.output.rotations });
  }
  if (read.length === 0 && poses.length > 0)
    throw new Error('None of the poses in this file can be read: it is damaged.');
  return { poses: read, broken: poses.length - read.length };
}

/** A name that is not taken yet: “Turn”, “Turn 2”, “Turn 3”. */
export function freeName(name: string, taken: ReadonlySet<string>): string {
  if (!taken.has(name)) return name;
  const stem = name.replace(/ \d+$/, '');
  for (let i = 2; ; i++) {
    const next = `${stem} ${i}`;
    if (!taken.has(next)) return next;
  }
}

/** Two poses this close (radians, each number) are one: exporting and importing rounds nothing, other programs may. */
const SAME = 1e-5;

/** True for poses that differ by rounding only. */
export function samePose(a: readonly number[], b: readonly number[]): boolean {
  return a.every((value, i) => Math.abs(value - b[i]) < SAME);
}

/**
 * Poses of a file that a library does not have yet. Equal poses of equal name are duplicates; an equal name alone gets a number.
 * @returns the poses to add, in the file's order, and how many were duplicates
 */
export function newPoses(
  library: readonly NamedPose[],
  incoming: readonly NamedPose[],
): { added: NamedPose[]; duplicates: number } {
  const all = [...library];
  const names = new Set(all.map((pose) => pose.name));
  const added: NamedPose[] = [];
  // “Turn 2” is what a colliding “Turn” became in an earlier import of the same file.
  const stem = (name: string) => name.replace(/ \d+$/, '');
  for (const pose of incoming) {
    if (all.some((own) => stem(own.name) === stem(pose.name) && samePose(own.rotations, pose.rotations))) continue;
    const named = { name: freeName(pose.name, names), rotations: [...pose.rotations] };
    names.add(named.name);
    all.push(named);
    added.push(named);
  }
  return { added, duplicates: incoming.length - added.length };
}
