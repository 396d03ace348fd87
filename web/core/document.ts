/** The project document: what a visitor made, as plain JSON. The song's sound and the dance itself are not part of it. */
import * as v from 'valibot';
import { FIRST_TAKE } from './filler';
import spec from './spec.json';
import type { BeatGrid, KeyPose } from './types';

/** The song that a document belongs to. */
export interface SongReference {
  name: string;
  /** SHA-256 of the file's bytes, hex; tells whether a dropped song is the same one. */
  hash: string;
  /** Seconds. */
  duration: number;
  /** Where the song was loaded from, when that was an address. */
  url?: string;
}

/** Settings of the next dance. */
export interface Dials {
  /** 0 = the network alone, 1 = key poses are hit exactly. */
  keyStrength: number;
  /** 0..1: how far the dance may stray from the plain one. */
  variation: number;
  /** Whole number; the same seed gives the same dance. */
  seed: number;
  /** Id of the starting clip. */
  seedClip: string;
}

/** A whole project, version 1. Treat it as immutable: every change makes a new one. */
export interface ProjectDocument {
  format: 'posebeat';
  version: 1;
  song: SongReference | null;
  /** The visitor's corrections of the beat grid; null = as analysed. */
  grid: BeatGrid | null;
  /** Ascending in time, never two on one frame. */
  keyPoses: KeyPose[];
  dials: Dials;
}

/** The newest version that this code writes and reads. */
export const DOCUMENT_VERSION = 1;
/** More key poses than this is no project of a person. */
export const MAX_KEY_POSES = 5000;
/** Numbers in a pose: three per joint. */
export const POSE_SIZE = spec.skeleton.joints.length * 3;
/** Two full turns; a larger number is almost surely degrees. */
const MAX_RADIANS = 4 * Math.PI;
const MAX_SEED = 2 ** 31 - 1;

const unit = v.pipe(v.number(), v.minValue(0), v.maxValue(1));
const seconds = v.pipe(v.number(), v.finite(), v.minValue(0));
const rotationsSchema = v.pipe(
  v.array(v.pipe(v.number('must be a number'), v.finite('must be a finite number'))),
  v.length(POSE_SIZE, `must hold ${POSE_SIZE} numbers (24 joints x 3, axis-angle in radians)`),
  v.check(
    (list) => list.every((value) => Math.abs(value) <= MAX_RADIANS),
    'looks like degrees: give axis-angle in radians',
  ),
);
const keyPoseSchema = v.object({
  id: v.pipe(v.string(), v.nonEmpty(), v.maxLength(64)),
  time: seconds,
  rotations: rotationsSchema,
  name: v.optional(v.pipe(v.string(), v.maxLength(200))),
});
const gridSchema = v.object({
  tempo: v.pipe(v.number(), v.finite(), v.minValue(20), v.maxValue(400)),
  beatsPerBar: v.picklist([3, 4]),
  beats: v.pipe(v.array(seconds), v.maxLength(100_000)),
  downbeats: v.pipe(v.array(seconds), v.maxLength(100_000)),
});
const songSchema = v.object({
  name: v.pipe(v.string(), v.maxLength(500)),
  hash: v.pipe(v.string(), v.maxLength(128)),
  duration: seconds,
  url: v.optional(v.pipe(v.string(), v.maxLength(2000))),
});
const dialSchemas = {
  keyStrength: unit,
  variation: unit,
  seed: v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(MAX_SEED)),
  seedClip: v.pipe(v.string(), v.maxLength(100)),
};

/** The dials of a new project: exact keys, a little life. */
export const DEFAULT_DIALS: Readonly<Dials> = { keyStrength: 1, ...FIRST_TAKE, seedClip: '' };

/** An empty project. */
export function createDocument(
  song: SongReference | null = null,
  dials: Readonly<Dials> = DEFAULT_DIALS,
): ProjectDocument {
  return { format: 'posebeat', version: DOCUMENT_VERSION, song, grid: null, keyPoses: [], dials: { ...dials } };
}

/** The frame that a time falls on. */
export function frameOf(time: number): number {
  return Math.round(time * spec.fps);
}

/** The first id of the form k1, k2... that no key pose has; the same edits always give the same ids. */
export function nextKeyId(keys: readonly KeyPose[]): string {
  const highest = keys.reduce((most, key) => Math.max(most, Number(/^k(\d{1,9})$/.exec(key.id)?.[1] ?? 0)), 0);
  return `k${highest + 1}`;
}

/** Key poses in order of time; of two on one frame the later one in the list stays. */
export function sortKeys(keys: readonly KeyPose[]): KeyPose[] {
  const byFrame = new Map<number, KeyPose>();
  for (const key of keys) byFrame.set(frameOf(key.time), key);
  return [...byFrame.values()].sort((a, b) => a.time - b.time);
}

/**
 * Checks key poses from outside (the automation API).
 *
 * @param input - A list of {time, rotations, name?, id?}.
 * @param duration - Length of the song in seconds; Infinity when there is none.
 * @returns Key poses with ids, in order of time.
 * @throws Error that names the entry, what is wrong with it and what to do.
 */
export function checkKeyPoses(input: unknown, duration: number): KeyPose[] {
  if (!Array.isArray(input)) throw new Error('Key poses must be a list of {time, rotations}.');
  if (input.length > MAX_KEY_POSES) throw new Error(`Too many key poses (${input.length}): at most ${MAX_KEY_POSES}.`);
  const taken = new Set<string>();
  const keys: KeyPose[] = [];
  input.forEach((entry: unknown, index) => {
    const where = `Key pose ${index + 1}`;
    if (typeof entry !== 'object' || entry === null) throw new Error(`${where} must be an object {time, rotations}.`);
    const { time, rotations, name, id } = entry as Record<string, unknown>;
    if (typeof time !== 'number' || !Number.isFinite(time))
      throw new Error(`${where}: time must be a number of seconds.`);
    if (time < 0 || time > duration) {
      throw new Error(`${where}: time ${time} s is outside the song (0 to ${duration.toFixed(2)} s).`);
    }
    const plain = ArrayBuffer.isView(rotations) ? Array.from(rotations as Float32Array) : rotations;
    const parsed = v.safeParse(rotationsSchema, plain);
    if (!parsed.success) throw new Error(`${where}: rotations ${parsed.issues[0].message}.`);
    let own = typeof id === 'string' && id !== '' && id.length <= 64 && !taken.has(id) ? id : '';
    if (!own) {
      let number = index + 1;
      while (taken.has(`k${number}`)) number += 1;
      own = `k${number}`;
    }
    taken.add(own);
    const key: KeyPose = { id: own, time, rotations: [...parsed.output] };
    if (typeof name === 'string' && name !== '') key.name = name.slice(0, 200);
    keys.push(key);
  });
  keys.sort((a, b) => a.time - b.time);
  for (let i = 1; i < keys.length; i += 1) {
    if (frameOf(keys[i].time) === frameOf(keys[i - 1].time)) {
      throw new Error(
        `Two key poses share the frame at ${keys[i].time.toFixed(2)} s: move one by at least ${(1 / spec.fps).toFixed(3)} s.`,
      );
    }
  }
  return keys;
}

/**
 * Reads a document from outside, repairing what can be repaired.
 *
 * @param input - The parsed JSON.
 * @returns The document, and a sentence for each repair.
 * @throws Error with a clear message when it is no Posebeat project, or one of a newer version.
 */
export function parseDocument(input: unknown): { document: ProjectDocument; repairs: string[] } {
  if (typeof input !== 'object' || input === null || Array.isArray(input)) {
    throw new Error('This is not a Posebeat project: choose a file that Posebeat saved.');
  }
  const raw = input as Record<string, unknown>;
  if (raw.format !== 'posebeat') throw new Error('This is not a Posebeat project: choose a file that Posebeat saved.');
  if (typeof raw.version !== 'number' || !Number.isInteger(raw.version) || raw.version < 1) {
    throw new Error('This project has no version: the file is damaged.');
  }
  if (raw.version > DOCUMENT_VERSION) {
    throw new Error('This project was made by a newer Posebeat: reload the page to get the newest version.');
  }
  const repairs: string[] = [];
  const song = repairPart(songSchema, raw.song, 'The song’s reference was damaged and left out.', repairs);
  const grid = repairGrid(raw.grid, repairs);
  return {
    document: {
      format: 'posebeat',
      version: DOCUMENT_VERSION,
      song,
      grid,
      keyPoses: repairKeys(raw.keyPoses, song?.duration ?? Infinity, repairs),
      dials: repairDials(raw.dials, repairs),
    },
    repairs,
  };
}

function repairPart<S extends v.GenericSchema>(
  schema: S,
  value: unknown,
  message: string,
  repairs: string[],
): v.InferOutput<S> | null {
  if (value === null || value === undefined) return null;
  const parsed = v.safeParse(schema, value);
  if (parsed.success) return parsed.output;
  repairs.push(message);
  return null;
}

function repairGrid(value: unknown, repairs: string[]): BeatGrid | null {
  const message = 'The edited beats were damaged: the song’s own beats are used.';
  const grid = repairPart(gridSchema, value, message, repairs);
  if (!grid) return null;
  const ascending = (list: number[]) => list.every((time, i) => i === 0 || time > list[i - 1]);
  if (ascending(grid.beats) && ascending(grid.downbeats)) return grid;
  repairs.push(message);
  return null;
}

function repairDials(value: unknown, repairs: string[]): Dials {
  const raw = (typeof value === 'object' && value !== null ? value : {}) as Record<string, unknown>;
  const dials: Dials = { ...DEFAULT_DIALS };
  const read = <K extends keyof Dials>(name: K): void => {
    if (raw[name] === undefined) return;
    const parsed = v.safeParse(dialSchemas[name], raw[name]);
    if (parsed.success) dials[name] = parsed.output as Dials[K];
    else repairs.push(`The setting “${name}” was out of range and set back.`);
  };
  read('keyStrength');
  read('variation');
  read('seed');
  read('seedClip');
  return dials;
}

function repairKeys(value: unknown, duration: number, repairs: string[]): KeyPose[] {
  if (value === undefined) return [];
  if (!Array.isArray(value)) {
    repairs.push('The key poses were damaged and left out.');
    return [];
  }
  if (value.length > MAX_KEY_POSES)
    throw new Error(`This project has ${value.length} key poses: at most ${MAX_KEY_POSES}.`);
  const kept: KeyPose[] = [];
  const ids = new Set<string>();
  let broken = 0;
  for (const entry of value) {
    const named = typeof entry === 'object' && entry !== null ? { id: nextKeyId(kept), ...entry } : entry;
    const parsed = v.safeParse(keyPoseSchema, named);
    if (!parsed.success || parsed.output.time > duration) {
      broken += 1;
      continue;
    }
    const id = ids.has(parsed.output.id) ? nextKeyId(kept) : parsed.output.id;
    ids.add(id);
    kept.push({ ...parsed.output, id });
  }
  if (broken > 0) repairs.push(`${broken} damaged key pose${broken === 1 ? ' was' : 's were'} left out.`);
  const sorted = sortKeys(kept);
  const doubled = kept.length - sorted.length;
  if (doubled > 0)
    repairs.push(`${doubled} key pose${doubled === 1 ? '' : 's'} shared a frame with another and gave way.`);
  return sorted;
}
