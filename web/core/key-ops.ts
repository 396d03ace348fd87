/**
 * What can be done with the key poses of a timeline, as pure functions: they take and give lists in order of time with one key
 * pose a frame, never lose a moved or a locked one, and give the same list back when nothing changes.
 */
import { BEAT_NOISE, beatCount, stepBeat } from './beat-count';
import { frameOf, nextKeyId } from './document';
import { gridTimes, nearestIndex } from './snap';
import { spec } from './spec';
import type { BeatGrid, KeyPose, Snap } from './types';

/** Where key poses live. */
export interface KeySpace {
  /** Seconds. */
  duration: number;
  grid: BeatGrid | null;
  /** Ids besides those of the key poses that a copy must not get. */
  takenIds?: readonly string[];
}

type Keys = readonly KeyPose[];
type Ids = ReadonlySet<string>;

const FRAME = 1 / spec.fps;
/** The last moment that a key pose can have, seconds. */
export function lastKeyTime(duration: number): number {
  return Math.max(0, duration - FRAME);
}

/**
 * Gives the entries of a list from outside ids before it is checked, where they bring none: that of the key pose that they are already
 * (same frame, same rotations), else one that none of these key poses has. What hangs on an id, such as changed curves, then never
 * passes to another pose.
 * @param before the key poses that the list takes the place of
 * @param alsoTaken further ids that are not free
 */
export function withIds(input: unknown, before: Keys, alsoTaken: Iterable<unknown> = []): unknown {
  if (!Array.isArray(input)) return input;
  const given = new Set<unknown>(input.map((entry: Partial<KeyPose> | null) => entry?.id));
  const taken = [...before.map(({ id }) => id), ...alsoTaken, ...given].filter((id) => typeof id === 'string');
  let number = Number(nextKeyId(taken.map((id) => ({ id }))).slice(1));
  return input.map((entry: Partial<KeyPose> | null) => {
    if (typeof entry !== 'object' || entry === null || entry.id !== undefined) return entry;
    const { time, rotations } = entry;
    const same = before.find(
      (key) =>
        !given.has(key.id) &&
        typeof time === 'number' &&
        frameOf(key.time) === frameOf(time) &&
        key.rotations.length === rotations?.length &&
        key.rotations.every((angle, i) => angle === rotations[i]),
    );
    if (same) given.add(same.id);
    return { ...entry, id: same?.id ?? `k${number++}` };
  });
}

const tidy = (beats: number) => Math.round(beats / BEAT_NOISE) * BEAT_NOISE;
const inside = (time: number, duration: number) => Math.min(Math.max(time, 0), lastKeyTime(duration));
const byTime = (a: KeyPose, b: KeyPose) => a.time - b.time;
const movable = (keys: Keys, ids: Ids) => keys.filter((key) => ids.has(key.id) && !key.locked);
const others = (keys: Keys, moved: Keys) => {
  const gone = new Set(moved);
  return keys.filter((key) => !gone.has(key));
};

/**
 * Puts key poses among others. They replace what is on their frame, but never a locked key pose or each other: then they go to the
 * nearest free frame.
 *
 * @param still - Key poses that stay where they are.
 * @param placed - Key poses with their new times; outside the song they go to its nearest end.
 * @param duration - Length of the song, seconds.
 */
export function settleKeys(still: Keys, placed: Keys, duration: number): KeyPose[] {
  const held = new Set(still.filter((key) => key.locked).map((key) => frameOf(key.time)));
  const used = new Set(still.map((key) => frameOf(key.time)));
  const lastFrame = Math.floor(lastKeyTime(duration) * spec.fps + 1e-6);
  const settled: KeyPose[] = [];
  for (const key of [...placed].sort(byTime)) {
    let time = inside(key.time, duration);
    if (held.has(frameOf(time))) {
      const free = freeFrame(frameOf(time), lastFrame, used, held);
      if (free < 0) continue; // the song has no frame left
      time = free / spec.fps;
    }
    held.add(frameOf(time));
    used.add(frameOf(time));
    settled.push(time === key.time ? key : { ...key, time });
  }
  const kept = still.filter((key) => key.locked || !held.has(frameOf(key.time)));
  return [...kept, ...settled].sort(byTime);
}

/** The frame nearest to one that nothing is on; where there is none, one that only holds what may be replaced; else -1. */
function freeFrame(frame: number, last: number, used: ReadonlySet<number>, held: ReadonlySet<number>): number {
  for (const taken of [used, held]) {
    for (let away = 1; away <= last + 1; away += 1) {
      for (const next of [frame + away, frame - away]) if (next >= 0 && next <= last && !taken.has(next)) return next;
    }
  }
  return -1;
}

/** Moves key poses by seconds, all by the same: those at an end of the song hold the others back. Locked ones stay. */
export function shiftKeys(keys: Keys, ids: Ids, seconds: number, duration: number): Keys {
  const moved = movable(keys, ids);
  return moveTo(keys, moved, shifted(moved, seconds, duration), duration);
}

/** Moves key poses by beats, so that they keep their places in the bar whatever the tempo does. Without beats by half seconds. */
export function shiftKeysByBeats(keys: Keys, ids: Ids, beats: number, space: KeySpace): Keys {
  const moved = movable(keys, ids);
  return moveTo(keys, moved, beatPlaces(moved, beats, space), space.duration);
}

/**
 * Moves key poses by one frame, or the first of them to its next beat and the others by as many beats. What is in the way is hopped
 * over: keys pressed again and again must not eat key poses.
 */
export function nudgeKeys(keys: Keys, ids: Ids, direction: -1 | 1, unit: 'beat' | 'frame', space: KeySpace): Keys {
  const moved = movable(keys, ids);
  if (moved.length === 0) return keys;
  const still = others(keys, moved);
  const taken = new Set(still.map((key) => frameOf(key.time)));
  const [lead] = moved;
  const count = beatCount(space.grid);
  const next = stepBeat(space.grid, lead.time, direction);
  for (let hops = 0; hops <= still.length; hops += 1) {
    const places =
      unit === 'frame'
        ? shifted(moved, (frameOf(lead.time) + direction * (hops + 1)) / spec.fps - lead.time, space.duration)
        : beatPlaces(moved, tidy(count.of(next) - count.of(lead.time)) + direction * hops, space);
    if ((places[0] - lead.time) * direction <= 0) return keys; // the end of the song
    if (places.some((time) => taken.has(frameOf(time)))) continue;
    return settleKeys(still, placedAt(moved, places), space.duration);
  }
  return keys;
}

/** Copies of key poses, moved by seconds or by beats; the originals stay, but for those that a copy lands on. */
export function copyKeysBy(keys: Keys, ids: Ids, by: { seconds: number } | { beats: number }, space: KeySpace): Added {
  const chosen = keys.filter((key) => ids.has(key.id));
  const places = 'beats' in by ? beatPlaces(chosen, by.beats, space) : shifted(chosen, by.seconds, space.duration);
  return addCopies(keys, placedAt(chosen, places), space);
}

/** Copies key poses by as many whole bars as they span, at least one. What goes past the end of the song is left out. */
export function duplicateKeys(keys: Keys, ids: Ids, space: KeySpace): Added {
  const chosen = keys.filter((key) => ids.has(key.id));
  if (chosen.length === 0) return { keys, added: [], left: 0 };
  const at = beatCount(space.grid);
  const bar = space.grid?.beatsPerBar ?? 4;
  const span = at.of(chosen[chosen.length - 1].time) - at.of(chosen[0].time);
  const step = (Math.floor(span / bar + BEAT_NOISE) + 1) * bar;
  return pasteKeys(keys, chosen, at.time(at.of(chosen[0].time) + step), space);
}

/** A list with copies in it. */
export interface Added {
  keys: Keys;
  /** Ids of the copies. */
  added: string[];
  /** How many copies found no room before the end of the song. */
  left: number;
}

/**
 * Puts copies of key poses so that the first is at a time and the others keep their distance in beats (in seconds without beats).
 * Copies are not locked. What would go past the end of the song is left out.
 *
 * @param copied - In order of time, as they are in their own song.
 * @param at - Seconds.
 */
export function pasteKeys(keys: Keys, copied: Keys, at: number, space: KeySpace): Added {
  if (copied.length === 0) return { keys, added: [], left: 0 };
  const count = beatCount(space.grid);
  const from = count.of(copied[0].time);
  const to = count.of(at);
  const placed = copied.map((key) => ({ ...key, time: count.time(to + count.of(key.time) - from) }));
  placed[0].time = at;
  const fitting = placed.filter((key) => key.time <= lastKeyTime(space.duration) + 1e-9);
  return { ...addCopies(keys, fitting, space), left: placed.length - fitting.length };
}

/**
 * Spreads key poses over the grid from the first to the last, each on the grid line that is nearest to even spacing; where there are
 * fewer lines than key poses, on lines that follow each other. Lines with other key poses on them are left out; locked ones stay.
 *
 * @param snap - Which lines; `off` means beats.
 */
export function distributeKeys(keys: Keys, ids: Ids, snap: Snap, space: KeySpace): Keys {
  const moved = movable(keys, ids);
  const held = new Set(others(keys, moved).map((key) => frameOf(key.time)));
  const lines = gridTimes(space.grid, snap === 'off' ? 'beat' : snap).filter(
    (time) => time <= lastKeyTime(space.duration) && !held.has(frameOf(time)),
  );
  const count = moved.length;
  if (count < 2 || lines.length < count) return keys;
  let first = nearestIndex(lines, moved[0].time);
  const last = Math.min(lines.length - 1, Math.max(nearestIndex(lines, moved[count - 1].time), first + count - 1));
  first = Math.min(first, last - count + 1);
  const times = moved.map((_, i) => lines[Math.round(first + (i * (last - first)) / (count - 1))]);
  return moveTo(keys, moved, times, space.duration);
}

/** Takes key poses out; locked ones stay. */
export function deleteKeys(keys: Keys, ids: Ids): Keys {
  const left = keys.filter((key) => key.locked || !ids.has(key.id));
  return left.length === keys.length ? keys : left;
}

/** A key pose that the visitor has had a hand in: no longer a mere suggestion. */
export function asOwn(key: KeyPose): KeyPose {
  if (!key.suggested) return key;
  const own = { ...key };
  delete own.suggested;
  return own;
}

/** Changes key poses that are not locked, in place; they are the visitor's own then. */
export function editKeys(keys: Keys, ids: Ids, edit: (key: KeyPose) => KeyPose): Keys {
  let changed = false;
  const next = keys.map((key) => {
    const edited = ids.has(key.id) && !key.locked ? edit(key) : key;
    if (edited === key) return key;
    changed = true;
    return asOwn(edited);
  });
  return changed ? next : keys;
}

/** How strongly the dance holds to key poses, 0..1; 1 is what a key pose without a number means. */
export function setStrength(keys: Keys, ids: Ids, value: number): Keys {
  const strength = Math.min(Math.max(value, 0), 1);
  return editKeys(keys, ids, (key) => {
    if ((key.strength ?? 1) === strength) return key;
    const edited = { ...key, strength };
    if (strength === 1) delete (edited as KeyPose).strength;
    return edited;
  });
}

/** Locks key poses; unlocks them when all of them are locked. */
export function toggleLock(keys: Keys, ids: Ids): Keys {
  const lock = keys.some((key) => ids.has(key.id) && !key.locked);
  let changed = false;
  const next = keys.map((key) => {
    if (!ids.has(key.id) || (key.locked ?? false) === lock) return key;
    changed = true;
    const edited: KeyPose = { ...asOwn(key), locked: true };
    if (!lock) delete edited.locked;
    return edited;
  });
  return changed ? next : keys;
}

const placedAt = (keys: Keys, times: readonly number[]): Keys =>
  keys.map((key, i) => ({ ...asOwn(key), time: times[i] }));

function moveTo(keys: Keys, moved: Keys, times: readonly number[], duration: number): Keys {
  if (times.every((time, i) => time === moved[i].time)) return keys;
  return settleKeys(others(keys, moved), placedAt(moved, times), duration);
}

/** Times after a shift by seconds, or by as much of it as all of them can go. */
function shifted(moved: Keys, seconds: number, duration: number): number[] {
  if (moved.length === 0) return [];
  const room = Math.max(0, lastKeyTime(duration) - moved[moved.length - 1].time);
  const shift = Math.min(Math.max(seconds, -moved[0].time), room);
  return moved.map((key) => key.time + shift);
}

/** Times of key poses after a shift by beats; where one has no room, all go only as many whole beats as it has. */
function beatPlaces(moved: Keys, beats: number, { grid, duration }: KeySpace): number[] {
  if (moved.length === 0 || beats === 0) return moved.map((key) => key.time);
  const count = beatCount(grid);
  const least = Math.ceil(count.of(0) - count.of(moved[0].time) - BEAT_NOISE);
  const most = Math.floor(count.of(lastKeyTime(duration)) - count.of(moved[moved.length - 1].time) + BEAT_NOISE);
  let shift = beats;
  if (shift < 0) shift = Math.max(shift, Math.min(0, least));
  else shift = Math.min(shift, Math.max(0, most));
  return moved.map((key) => (shift === 0 ? key.time : count.time(count.of(key.time) + shift)));
}

function addCopies(keys: Keys, copies: Keys, { duration, takenIds = [] }: KeySpace): Added {
  if (copies.length === 0) return { keys, added: [], left: 0 };
  const number = Number(nextKeyId([...keys, ...takenIds.map((id) => ({ id }))]).slice(1));
  const placed = copies.map((key, i) => {
    const copy: KeyPose = { ...asOwn(key), id: `k${number + i}` };
    delete copy.locked;
    return copy;
  });
  return { keys: settleKeys(keys, placed, duration), added: placed.map((key) => key.id), left: 0 };
}
