/** Documents from outside: checked, brought up to the newest version and repaired. */
import * as v from 'valibot';
import {
  DEFAULT_AVATAR,
  DEFAULT_DIALS,
  DOCUMENT_VERSION,
  MAX_CURVE_EDITS,
  MAX_KEY_POSES,
  MAX_RANGES,
  nextKeyId,
  sortKeys,
  type Dials,
  type ProjectDocument,
  type TakeRange,
} from './document';
import {
  cameraSchema,
  curveEditSchema,
  dialSchemas,
  engineSchema,
  gridSchema,
  keyPoseSchema,
  lookSchema,
  seedClipSchema,
  songSchema,
  takeRangeSchema,
  timeRangeSchema,
} from './document-schema';
import { withEdit, type CurveEdit } from './curves-edit';
import type { BeatGrid, KeyPose } from './types';

/** Beats closer than this, seconds, are no beats of a person: some 6000 a minute. */
const MIN_BEAT = 0.01;

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
  const duration = song?.duration ?? Infinity;
  return {
    document: {
      format: 'posebeat',
      version: DOCUMENT_VERSION,
      song,
      trim: repairPart(insideSong(duration), raw.trim, 'The trim was damaged: the whole song is used.', repairs),
      grid: repairGrid(raw.grid, repairs),
      keyPoses: repairKeys(raw.keyPoses, duration, repairs),
      ranges: repairRanges(raw.ranges, duration, repairs),
      dials: repairDials(raw.dials, repairs),
      ...ownSeedPart(raw, repairs),
      ...curvePart(raw, repairs),
      avatar: repairAvatar(raw.avatar, repairs),
      ...lookPart(raw, repairs),
      camera: repairPart(cameraSchema, raw.camera, 'The camera was damaged: the opening view is shown.', repairs),
    },
    repairs,
  };
}

/** The starting clip of the visitor's own; projects without one stay without. */
function ownSeedPart(raw: Record<string, unknown>, repairs: string[]): Pick<ProjectDocument, 'ownSeed'> {
  const message = 'The starting clip of your own was damaged and left out.';
  const ownSeed = repairPart(seedClipSchema, raw.ownSeed, message, repairs);
  return ownSeed ? { ownSeed } : {};
}

/** What the figure wears; projects that do not say stay so. */
function lookPart(raw: Record<string, unknown>, repairs: string[]): Pick<ProjectDocument, 'look'> {
  const look = repairPart(
    lookSchema,
    raw.look,
    'The figure’s look was damaged: it wears what it wears at first.',
    repairs,
  );
  return look ? { look } : {};
}

/** The engine and the edited curves; projects without them stay without. */
function curvePart(raw: Record<string, unknown>, repairs: string[]): Pick<ProjectDocument, 'engine' | 'curveEdits'> {
  const engine = repairPart(engineSchema, raw.engine, 'The engine was damaged: network frames are used.', repairs);
  const list: unknown[] = Array.isArray(raw.curveEdits) ? raw.curveEdits : [];
  let edits: readonly CurveEdit[] = [];
  for (const entry of list.slice(0, MAX_CURVE_EDITS)) {
    const parsed = v.safeParse(curveEditSchema, entry);
    if (parsed.success) edits = withEdit(edits, parsed.output);
  }
  if (edits.length < list.length || (raw.curveEdits !== undefined && !Array.isArray(raw.curveEdits))) {
    repairs.push('Some changes to the curves were damaged and left out.');
  }
  return { ...(engine ? { engine } : {}), ...(edits.length > 0 ? { curveEdits: edits } : {}) };
}

function repairAvatar(value: unknown, repairs: string[]): string {
  if (value === undefined) return DEFAULT_AVATAR;
  if (typeof value === 'string' && value !== '' && value.length <= 100) return value;
  repairs.push('The figure was damaged: Posebeat’s own dances.');
  return DEFAULT_AVATAR;
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

const insideSong = (duration: number) =>
  v.pipe(
    timeRangeSchema,
    v.check(({ end }) => end <= duration),
  );

function repairRanges(value: unknown, duration: number, repairs: string[]): TakeRange[] {
  if (value === undefined) return [];
  const list: unknown[] = Array.isArray(value) ? value.slice(0, MAX_RANGES) : [];
  const ids = new Set<string>();
  const kept = list.flatMap((entry) => {
    const parsed = v.safeParse(takeRangeSchema, entry);
    if (!parsed.success || parsed.output.end > duration || ids.has(parsed.output.id)) return [];
    ids.add(parsed.output.id);
    return [parsed.output];
  });
  if (!Array.isArray(value) || kept.length < value.length) {
    repairs.push('Some ranges with takes were damaged and left out.');
  }
  return kept;
}

function repairGrid(value: unknown, repairs: string[]): BeatGrid | null {
  const message = 'The edited beats were damaged: the song’s own beats are used.';
  const grid = repairPart(gridSchema, value, message, repairs);
  if (!grid) return null;
  const apart = (list: number[]) => list.every((time, i) => i === 0 || time - list[i - 1] >= MIN_BEAT);
  if (grid.beats.length === 0 || !apart(grid.beats) || !apart(grid.downbeats)) {
    repairs.push(message);
    return null;
  }
  const beats = new Set(grid.beats);
  const downbeats = grid.downbeats.filter((time) => beats.has(time));
  if (downbeats.length === grid.downbeats.length) return grid;
  repairs.push('Some bars of the edited beats began between two beats and were left out.');
  return { ...grid, downbeats };
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
  let trimmed = 0;
  for (const entry of value) {
    const plain = withoutBadExtras(entry);
    const named = typeof plain === 'object' && plain !== null ? { id: nextKeyId(kept), ...plain } : plain;
    const parsed = v.safeParse(keyPoseSchema, named);
    if (!parsed.success || parsed.output.time > duration) {
      broken += 1;
      continue;
    }
    if (plain !== entry) trimmed += 1;
    const id = ids.has(parsed.output.id) ? nextKeyId(kept) : parsed.output.id;
    ids.add(id);
    kept.push({ ...parsed.output, id });
  }
  if (broken > 0) repairs.push(`${broken} damaged key pose${broken === 1 ? ' was' : 's were'} left out.`);
  if (trimmed > 0) {
    repairs.push(
      `The name, lock or strength of ${trimmed} key pose${trimmed === 1 ? ' was' : 's were'} damaged and left out.`,
    );
  }
  const sorted = sortKeys(kept);
  const doubled = kept.length - sorted.length;
  if (doubled > 0)
    repairs.push(`${doubled} key pose${doubled === 1 ? '' : 's'} shared a frame with another and gave way.`);
  return sorted;
}

/** A damaged name, lock or strength is no reason to lose the pose: the entry without what is damaged, or the entry itself. */
function withoutBadExtras(entry: unknown): unknown {
  if (typeof entry !== 'object' || entry === null) return entry;
  const { entries } = keyPoseSchema;
  const raw = entry as Record<string, unknown>;
  const bad = (['name', 'locked', 'strength', 'suggested'] as const).filter(
    (name) => Object.hasOwn(raw, name) && !v.is(entries[name], raw[name]),
  );
  if (bad.length === 0) return entry;
  return Object.fromEntries(Object.entries(raw).filter(([name]) => !bad.some((each) => each === name)));
}
