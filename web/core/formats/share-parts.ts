/**
 * The parts of a link, version 1, before they are packed. Numbers, text and times are as in `byte-pack.ts`; in this order:
 *
 * 1. flags, 1 byte: which parts there are ({@link FLAGS}), then the model's name (text);
 * 2. song: name (text), hash (1 and 32 bytes of SHA-256, or 0 and text), length (number);
 * 3. trim: start, end (numbers);
 * 4. grid: tempo (number), beats a bar (byte), beats (times), bars (0 and every so many beats from an index; or 1 and times);
 * 5. dials: key strength, variation (numbers), seed (whole), starting clip (text);
 * 6. key poses: how many (whole); their times (0 and times; or, on the grid, 1 and steps in half beats); their ids; for each 1 byte
 *    (1 locked, 2 strength, 4 name, 8 suggested) with what it announces; which of the different poses each one is (whole; a new one takes the
 *    next number); the different poses, 72 signed bytes each, pose by pose or number by number;
 * 7. ranges: how many; ids; each with start, end (numbers), takes (how many, ids, seed and variation each), chosen take (0 = none);
 * 8. changed curves as JSON (text), engine (byte), figure (text).
 *
 * Ids: 0 and the numbers in k1, k2..., or 1 and texts.
 */
import {
  DEFAULT_AVATAR,
  DOCUMENT_VERSION,
  MAX_KEY_POSES,
  MAX_RANGES,
  POSE_SIZE,
  type EngineName,
  type ProjectDocument,
} from '../document';
import { MAX_TAKES } from '../document-schema';
import { axisAngleToQuaternion, quaternionToAxisAngle } from '../rotation';
import type { BeatGrid, KeyPose } from '../types';
import { DamagedBytes, type ByteReader, type ByteWriter } from './byte-pack';

/** Half a turn in as many steps as a signed byte has. */
const STEPS = 127;
/** Radians between neighbouring numbers of a rounded rotation: 1.42 degrees, so that none is off by more than 0.71. */
export const POSE_STEP = Math.PI / STEPS;
/** A little more than half a turn: what a link gave is never turned the other way round when it is shared again. */
const HALF_TURN = Math.PI + 1e-3;
/** Rounded rotations are written with so many decimals, as those of the library are. */
const DECIMALS = 1e4;
const MAX_BEATS = 100_000;
const SHA256 = 32;
const ENGINES: readonly EngineName[] = ['light', 'curves'];

const FLAGS = {
  song: 1,
  trim: 2,
  grid: 4,
  ranges: 8,
  curveEdits: 16,
  engine: 32,
  avatar: 64,
  byJoint: 128,
} as const;

/** Writes a project. `byJoint` puts the same number of all poses side by side. */
export function writeParts(out: ByteWriter, document: ProjectDocument, model: string, byJoint: boolean): void {
  const { song, trim, grid, keyPoses, ranges, dials, engine, curveEdits, avatar } = document;
  const has = {
    song,
    trim,
    grid,
    ranges: ranges.length > 0,
    curveEdits: curveEdits && curveEdits.length > 0,
    engine,
    avatar: avatar !== DEFAULT_AVATAR,
    byJoint,
  };
  out.byte(flagsOf(FLAGS, has));
  out.text(model);
  if (song) {
    out.text(song.name);
    writeHash(out, song.hash);
    out.number(song.duration);
  }
  if (trim) {
    out.number(trim.start);
    out.number(trim.end);
  }
  if (grid) writeGrid(out, grid);
  out.number(dials.keyStrength);
  out.number(dials.variation);
  out.whole(dials.seed);
  out.text(dials.seedClip);
  writeKeys(out, keyPoses, grid, byJoint);
  if (has.ranges) writeRanges(out, ranges);
  if (has.curveEdits) out.text(JSON.stringify(curveEdits));
  if (engine) out.byte(ENGINES.indexOf(engine));
  if (has.avatar) out.text(avatar);
}

/** The sum of the bits of all that is there. */
function flagsOf<Name extends string>(bits: Record<Name, number>, has: Record<Name, unknown>): number {
  return (Object.keys(bits) as Name[]).reduce((sum, name) => sum + (has[name] ? bits[name] : 0), 0);
}

/**
 * Reads a project; the document is as it was written, unchecked.
 * @throws DamagedBytes
 */
export function readParts(from: ByteReader): { document: unknown; model: string } {
  const flags = from.byte();
  const has = (name: keyof typeof FLAGS): boolean => (flags & FLAGS[name]) !== 0;
  const model = from.text();
  const song = has('song') ? { name: from.text(), hash: readHash(from), duration: from.number() } : null;
  const trim = has('trim') ? { start: from.number(), end: from.number() } : null;
  const grid = has('grid') ? readGrid(from) : null;
  const dials = {
    keyStrength: from.number(),
    variation: from.number(),
    seed: from.whole(),
    seedClip: from.text(),
  };
  const keyPoses = readKeys(from, grid, has('byJoint'));
  const ranges = has('ranges') ? readRanges(from) : [];
  const curveEdits = has('curveEdits') ? readJson(from) : undefined;
  const engine = has('engine') ? ENGINES[from.byte()] : undefined;
  const avatar = has('avatar') ? from.text() : DEFAULT_AVATAR;
  if (!from.done) throw new DamagedBytes('There is more than a project.');
  const document = {
    format: 'posebeat',
    version: DOCUMENT_VERSION,
    song,
    trim,
    grid,
    keyPoses,
    ranges,
    dials,
    ...(engine ? { engine } : {}),
    ...(curveEdits === undefined ? {} : { curveEdits }),
    avatar,
    camera: null,
  };
  return { document, model };
}

function readJson(from: ByteReader): unknown {
  try {
    return JSON.parse(from.text());
  } catch {
    throw new DamagedBytes('The changed curves are no JSON.');
  }
}

function writeHash(out: ByteWriter, hash: string): void {
  const pairs = /^[0-9a-f]{64}$/.test(hash) ? hash.match(/../g)! : null;
  out.byte(pairs ? 1 : 0);
  if (!pairs) out.text(hash);
  else for (const pair of pairs) out.byte(parseInt(pair, 16));
}

function readHash(from: ByteReader): string {
  if (from.byte() === 0) return from.text();
  return Array.from({ length: SHA256 }, () => from.byte().toString(16).padStart(2, '0')).join('');
}

/** Index of the beat that bars are counted from, where the bars are every so many beats. */
function evenBars({ beats, beatsPerBar, downbeats }: BeatGrid): number | null {
  const first = beats.indexOf(downbeats[0]);
  if (first < 0 || first >= beatsPerBar) return null;
  const even = barsFrom(beats, beatsPerBar, first);
  return even.length === downbeats.length && even.every((time, i) => time === downbeats[i]) ? first : null;
}

const barsFrom = (beats: readonly number[], beatsPerBar: number, first: number): number[] =>
  beats.filter((_, i) => i >= first && (i - first) % beatsPerBar === 0);

function writeGrid(out: ByteWriter, grid: BeatGrid): void {
  out.number(grid.tempo);
  out.byte(grid.beatsPerBar);
  out.times(grid.beats);
  const first = evenBars(grid);
  out.byte(first === null ? 1 : 0);
  if (first === null) out.times(grid.downbeats);
  else out.whole(first);
}

function readGrid(from: ByteReader) {
  const tempo = from.number();
  const beatsPerBar = from.byte();
  const beats = from.times(MAX_BEATS);
  const even = from.byte() === 0;
  const downbeats = even ? barsFrom(beats, beatsPerBar || 1, from.whole()) : from.times(MAX_BEATS);
  return { tempo, beatsPerBar, beats, downbeats };
}

function writeIds(out: ByteWriter, ids: readonly string[], letter: string): void {
  const counted = ids.every((id) => /^(0|[1-9]\d{0,8})$/.test(id.slice(1)) && id[0] === letter);
  out.byte(counted ? 0 : 1);
  for (const id of ids) {
    if (counted) out.whole(Number(id.slice(1)));
    else out.text(id);
  }
}

function readIds(from: ByteReader, count: number, letter: string): string[] {
  const counted = from.byte() === 0;
  return Array.from({ length: count }, () => (counted ? `${letter}${from.whole()}` : from.text()));
}

/** The time of a half beat; between two beats it is what key poses snap to. */
const halfBeat = (beats: readonly number[], half: number): number => {
  const i = Math.floor(half / 2);
  return half % 2 === 0 ? beats[i] : (beats[i] + beats[i + 1]) / 2;
};

/** The half beats that all times lie on, or null where one does not. */
function onBeats(times: readonly number[], grid: BeatGrid | null): number[] | null {
  if (!grid) return null;
  const halves = new Map<number, number>();
  for (let half = 0; half < 2 * grid.beats.length - 1; half += 1) halves.set(halfBeat(grid.beats, half), half);
  const found = times.map((time) => halves.get(time) ?? -1);
  return found.includes(-1) ? null : found;
}

const EXTRAS = { locked: 1, strength: 2, name: 4, suggested: 8 } as const;

function writeKeys(out: ByteWriter, keys: readonly KeyPose[], grid: BeatGrid | null, byJoint: boolean): void {
  out.whole(keys.length);
  const times = keys.map(({ time }) => time);
  const halves = onBeats(times, grid);
  out.byte(halves ? 1 : 0);
  if (halves) halves.forEach((half, i) => out.signed(half - (halves[i - 1] ?? 0)));
  else out.times(times);
  const ids = keys.map(({ id }) => id);
  writeIds(out, ids, 'k');
  for (const { locked, strength, name, suggested } of keys) {
    const has = { locked, strength: strength !== undefined, name: name !== undefined, suggested };
    out.byte(flagsOf(EXTRAS, has));
    if (strength !== undefined) out.number(strength);
    if (name !== undefined) out.text(name);
  }
  const different = new Map<string, { index: number; steps: number[] }>();
  for (const { rotations } of keys) {
    const steps = rounded(rotations);
    const known = different.get(String(steps));
    if (!known) different.set(String(steps), { index: different.size, steps });
    out.whole(known ? known.index : different.size - 1);
  }
  const poses = [...different.values()].map(({ steps }) => steps);
  if (byJoint) for (let i = 0; i < POSE_SIZE; i += 1) for (const pose of poses) out.byte(pose[i]);
  else for (const pose of poses) for (const step of pose) out.byte(step);
}

function readKeys(from: ByteReader, grid: BeatGrid | null | { beats: number[] }, byJoint: boolean) {
  const count = from.count(MAX_KEY_POSES);
  let times: number[];
  if (from.byte() === 0) times = from.times(MAX_KEY_POSES);
  else {
    let half = 0;
    times = Array.from({ length: count }, () => halfBeat(grid?.beats ?? [], (half += from.signed())));
  }
  if (times.length !== count) throw new DamagedBytes('There are fewer times than key poses.');
  const ids = readIds(from, count, 'k');
  const extras = ids.map(() => {
    const flags = from.byte();
    return {
      ...(flags & EXTRAS.locked ? { locked: true } : {}),
      ...(flags & EXTRAS.strength ? { strength: from.number() } : {}),
      ...(flags & EXTRAS.name ? { name: from.text() } : {}),
      ...(flags & EXTRAS.suggested ? { suggested: true } : {}),
    };
  });
  let size = 0;
  const which = ids.map(() => {
    const index = from.whole();
    if (index > size) throw new DamagedBytes('A pose is missing.');
    size = Math.max(size, index + 1);
    return index;
  });
  const poses = Array.from({ length: size }, () => new Array<number>(POSE_SIZE).fill(0));
  if (byJoint) for (let i = 0; i < POSE_SIZE; i += 1) for (const pose of poses) pose[i] = radians(from.small());
  else for (const pose of poses) for (let i = 0; i < POSE_SIZE; i += 1) pose[i] = radians(from.small());
  return ids.map((id, i) => ({ id, time: times[i], rotations: [...poses[which[i]]], ...extras[i] }));
}

/** A pose in whole steps; turns that a signed byte cannot hold are taken the other way round first. */
function rounded(rotations: readonly number[]): number[] {
  const steps: number[] = [];
  for (let i = 0; i < rotations.length; i += 3) {
    let turn = [rotations[i], rotations[i + 1], rotations[i + 2]];
    if (turn.some((value) => Math.abs(value) > HALF_TURN)) turn = quaternionToAxisAngle(axisAngleToQuaternion(turn));
    for (const value of turn) steps.push(Math.round(value / POSE_STEP) + 0);
  }
  return steps;
}

const radians = (step: number): number => Math.round(step * POSE_STEP * DECIMALS) / DECIMALS;

function writeRanges(out: ByteWriter, ranges: ProjectDocument['ranges']): void {
  out.whole(ranges.length);
  const ids = ranges.map(({ id }) => id);
  writeIds(out, ids, 'r');
  for (const { start, end, takes, chosen } of ranges) {
    out.number(start);
    out.number(end);
    out.whole(takes.length);
    const names = takes.map(({ id }) => id);
    writeIds(out, names, 't');
    for (const { seed, variation } of takes) {
      out.whole(seed);
      out.number(variation);
    }
    out.whole(names.indexOf(chosen ?? '') + 1);
  }
}

function readRanges(from: ByteReader) {
  const ids = readIds(from, from.count(MAX_RANGES), 'r');
  return ids.map((id) => {
    const start = from.number();
    const end = from.number();
    const names = readIds(from, from.count(MAX_TAKES), 't');
    const takes = names.map((name) => ({ id: name, seed: from.whole(), variation: from.number() }));
    const chosen = names[from.whole() - 1] ?? null;
    return { id, start, end, takes, chosen };
  });
}
