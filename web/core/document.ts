/** The project document: what a visitor made, as plain JSON. The song's sound and the dance itself are not part of it. */
import * as v from 'valibot';
import type { CurveEdit } from './curves-edit';
import { rotationsSchema, unit } from './document-schema';
import type { FigureLook } from './figure-look';
import { FIRST_TAKE } from './filler';
import spec from './spec.json';
import type { BeatGrid, KeyPose, SeedClip } from './types';

export { POSE_SIZE } from './document-schema';

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

/** A stretch of the song, seconds; start < end. */
export interface TimeRange {
  start: number;
  end: number;
}

/** One way to dance a range: the same take of the same project is always the same dance. */
export interface Take {
  /** t1, t2... inside its range. */
  id: string;
  seed: number;
  /** 0..1 */
  variation: number;
}

/** A range that was made anew on its own, with all its takes; later ranges lie over earlier ones. */
export interface TakeRange extends TimeRange {
  /** r1, r2... */
  id: string;
  takes: Take[];
  /** Id of the take on stage; null = the range as the whole dance has it. */
  chosen: string | null;
}

/** What makes a dance: `light` gives frames, `curves` gives curves between key poses that can be edited. */
export type EngineName = 'light' | 'curves';

/** Where the visitor looks from, metres; while the camera follows, x and z are counted from the dancer. */
export interface CameraView {
  /** The camera goes along with the dancer. */
  follows: boolean;
  position: [number, number, number];
  target: [number, number, number];
}

/** A whole project. Treat it as immutable: every change makes a new one. */
export interface ProjectDocument {
  format: 'posebeat';
  version: 2;
  song: SongReference | null;
  /** The part of the song to dance to; null = all of it. */
  trim: TimeRange | null;
  /** The visitor's corrections of the beat grid; null = as analysed. */
  grid: BeatGrid | null;
  /** Ascending in time, never two on one frame. */
  keyPoses: KeyPose[];
  ranges: TakeRange[];
  dials: Dials;
  /** A starting clip out of a file of the visitor's; `dials.seedClip` may name it. */
  ownSeed?: SeedClip;
  /** Missing = light. */
  engine?: EngineName;
  /** Changes to the curves of the engine `curves`. */
  curveEdits?: readonly CurveEdit[];
  /** Id of the figure that dances. */
  avatar: string;
  /** What our own figure wears; missing = `DEFAULT_LOOK`. */
  look?: FigureLook;
  /** null = the opening view. Not part of undo: `History.amend`. */
  camera: CameraView | null;
}

/** The newest version that this code writes and reads. */
export const DOCUMENT_VERSION = 2;
/** The figure of a new project: our own. */
export const DEFAULT_AVATAR = 'posebeat';
/** More ranges, or takes of one, than this is no project of a person. */
export const MAX_RANGES = 200;
/** More key poses than this is no project of a person. */
export const MAX_KEY_POSES = 5000;
/** More edited curves than this is no project of a person. */
export const MAX_CURVE_EDITS = 5000;

/** The dials of a new project: exact keys, a little life. */
export const DEFAULT_DIALS: Readonly<Dials> = { keyStrength: 1, ...FIRST_TAKE, seedClip: '' };

/** An empty project. */
export function createDocument(
  song: SongReference | null = null,
  dials: Readonly<Dials> = DEFAULT_DIALS,
): ProjectDocument {
  return {
    format: 'posebeat',
    version: DOCUMENT_VERSION,
    song,
    trim: null,
    grid: null,
    keyPoses: [],
    ranges: [],
    dials: { ...dials },
    avatar: DEFAULT_AVATAR,
    camera: null,
  };
}

/** The frame that a time falls on. */
export function frameOf(time: number): number {
  return Math.round(time * spec.fps);
}

/** The first id of the form k1, k2... that no key pose has; the same edits always give the same ids. */
export function nextKeyId(keys: readonly Pick<KeyPose, 'id'>[]): string {
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
    const { time, rotations, name, id, locked, strength, suggested } = entry as Record<string, unknown>;
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
    if (locked === true) key.locked = true;
    if (suggested === true) key.suggested = true;
    if (strength !== undefined) {
      if (!v.is(unit, strength)) throw new Error(`${where}: strength must be a number from 0 to 1.`);
      key.strength = strength;
    }
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
