/**
 * The parts of a link before they are packed. Numbers, text and times are as in `byte-pack.ts`; in this order:
 *
 * 1. flags, 1 byte: which parts there are ({@link FLAGS}), then the model's name (text); in version 2 then the further parts: how many
 *    (whole), each with its kind (byte, {@link KINDS}) and how many bytes it has (whole). One that is not known is left out;
 * 2. song: name (text), hash (1 and 32 bytes of SHA-256, or 0 and text), length (number);
 * 3. trim: start, end (numbers);
 * 4. grid (`share-grid.ts`), where it is no further part;
 * 5. dials: key strength, variation (numbers), seed (whole), starting clip (text; empty where it is a further part);
 * 6. key poses (`share-keys.ts`);
 * 7. ranges: how many; ids; each with start, end (numbers), takes (how many, ids, seed and variation each), chosen take (0 = none);
 * 8. changed curves as JSON (text), engine (byte), figure (text).
 */
import { DEFAULT_AVATAR, DOCUMENT_VERSION, MAX_RANGES, type EngineName, type ProjectDocument } from '../document';
import { MAX_TAKES } from '../document-schema';
import { lookByte, lookOfByte, type FigureLook } from '../figure-look';
import type { SeedClip } from '../types';
import { ByteWriter, DamagedBytes, type ByteReader } from './byte-pack';
import { isPlayed, readGrid, readPlayed, sharedGrid, writeGrid, writePlayed } from './share-grid';
import { flagsOf, readIds, readKeys, writeIds, writeKeys } from './share-keys';
import { readSeed, writeSeed } from './share-seed';

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

/** Further parts: a starting clip of the visitor's own (`share-seed.ts`), the figure's look (`figure-look.ts`), beats played by hand. */
const KINDS = { ownSeed: 1, look: 2, played: 3 } as const;

/** The further parts of a project; none, and the link is of version 1. */
export type FurtherParts = [kind: number, part: ByteWriter][];

/** Makes the further parts. What no dance of the project is made from (a clip of the visitor's that is not chosen) is not among them. */
export function furtherParts({ ownSeed, dials, look, grid }: ProjectDocument): FurtherParts {
  const parts: FurtherParts = [];
  const add = (kind: number, write: (out: ByteWriter) => void) => {
    const part = new ByteWriter();
    write(part);
    parts.push([kind, part]);
  };
  if (ownSeed && dials.seedClip === ownSeed.id) add(KINDS.ownSeed, (out) => writeSeed(out, ownSeed));
  if (look) add(KINDS.look, (out) => out.byte(lookByte(look)));
  if (grid && isPlayed(grid)) add(KINDS.played, (out) => writePlayed(out, sharedGrid(grid)));
  return parts;
}

/** Writes a project. `byJoint` puts the same number of all poses side by side. */
export function writeParts(
  out: ByteWriter,
  document: ProjectDocument,
  model: string,
  byJoint: boolean,
  further = furtherParts(document),
): void {
  const { song, trim, grid, keyPoses, ranges, dials, engine, curveEdits, avatar } = document;
  const apart = (kind: number) => further.some(([each]) => each === kind);
  const has = {
    song,
    trim,
    grid: grid && !apart(KINDS.played),
    ranges: ranges.length > 0,
    curveEdits: curveEdits && curveEdits.length > 0,
    engine,
    avatar: avatar !== DEFAULT_AVATAR,
    byJoint,
  };
  out.byte(flagsOf(FLAGS, has));
  out.text(model);
  if (further.length > 0) {
    out.whole(further.length);
    for (const [kind, part] of further) {
      out.byte(kind);
      out.part(part);
    }
  }
  if (song) {
    out.text(song.name);
    writeHash(out, song.hash);
    out.number(song.duration);
  }
  if (trim) {
    out.number(trim.start);
    out.number(trim.end);
  }
  if (grid && has.grid) writeGrid(out, grid);
  out.number(dials.keyStrength);
  out.number(dials.variation);
  out.whole(dials.seed);
  out.text(apart(KINDS.ownSeed) ? '' : dials.seedClip);
  writeKeys(out, keyPoses, grid, byJoint);
  if (has.ranges) writeRanges(out, ranges);
  if (has.curveEdits) out.text(JSON.stringify(curveEdits));
  if (engine) out.byte(ENGINES.indexOf(engine));
  if (has.avatar) out.text(avatar);
}

/**
 * Reads a project; the document is as it was written, unchecked.
 * @param version - Of the link.
 * @returns `unknown`: there were parts that a newer page wrote
 * @throws DamagedBytes
 */
export function readParts(from: ByteReader, version: number): { document: unknown; model: string; unknown: boolean } {
  const flags = from.byte();
  const has = (name: keyof typeof FLAGS): boolean => (flags & FLAGS[name]) !== 0;
  const model = from.text();
  const { ownSeed, look, played, unknown } = version > 1 ? readFurther(from) : NOTHING;
  const song = has('song') ? { name: from.text(), hash: readHash(from), duration: from.number() } : null;
  const trim = has('trim') ? { start: from.number(), end: from.number() } : null;
  const grid = played ?? (has('grid') ? readGrid(from) : null);
  const dials = {
    keyStrength: from.number(),
    variation: from.number(),
    seed: from.whole(),
    seedClip: from.text(),
  };
  if (ownSeed) dials.seedClip = ownSeed.id;
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
    ...(ownSeed ? { ownSeed } : {}),
    ...(engine ? { engine } : {}),
    ...(curveEdits === undefined ? {} : { curveEdits }),
    avatar,
    ...(look ? { look } : {}),
    camera: null,
  };
  return { document, model, unknown };
}

interface Further {
  ownSeed?: SeedClip;
  look?: FigureLook | null;
  played?: ReturnType<typeof readPlayed>;
  unknown: boolean;
}
const NOTHING: Further = { unknown: false };

function readFurther(from: ByteReader): Further {
  const read: Further = { unknown: false };
  for (let count = from.count(255); count > 0; count -= 1) {
    const kind = from.byte();
    const part = from.part();
    if (kind === KINDS.ownSeed) read.ownSeed = readSeed(part);
    else if (kind === KINDS.look) {
      read.look = lookOfByte(part.byte());
      read.unknown ||= read.look === null;
    } else if (kind === KINDS.played) read.played = readPlayed(part);
    else {
      read.unknown = true;
      continue;
    }
    if (!part.done) throw new DamagedBytes('A part is longer than it should be.');
  }
  return read;
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
