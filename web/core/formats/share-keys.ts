/**
 * The key poses of a link: how many (whole); their times (0 and times; or, on the grid, 1 and steps in half beats); their ids; for each 1
 * byte (1 locked, 2 strength, 4 name, 8 suggested) with what it announces; which of the different poses each one is (whole; a new one takes
 * the next number); the different poses, 72 signed bytes each, pose by pose or number by number. Ids: 0 and the numbers in k1, k2..., or 1
 * and texts.
 */
import { frameOf, MAX_KEY_POSES, POSE_SIZE } from '../document';
import type { BeatGrid, KeyPose } from '../types';
import { DamagedBytes, type ByteReader, type ByteWriter } from './byte-pack';
import { sharedGrid } from './share-grid';
import { radians, rounded } from './share-pose';

/** The sum of the bits of all that is there. */
export function flagsOf<Name extends string>(bits: Record<Name, number>, has: Record<Name, unknown>): number {
  return (Object.keys(bits) as Name[]).reduce((sum, name) => sum + (has[name] ? bits[name] : 0), 0);
}

/** Ids in few bytes where they are counted. */
export function writeIds(out: ByteWriter, ids: readonly string[], letter: string): void {
  const counted = ids.every((id) => /^(0|[1-9]\d{0,8})$/.test(id.slice(1)) && id[0] === letter);
  out.byte(counted ? 0 : 1);
  for (const id of ids) {
    if (counted) out.whole(Number(id.slice(1)));
    else out.text(id);
  }
}

/** Reads {@link writeIds}. */
export function readIds(from: ByteReader, count: number, letter: string): string[] {
  const counted = from.byte() === 0;
  return Array.from({ length: count }, () => (counted ? `${letter}${from.whole()}` : from.text()));
}

/** The time of a half beat; between two beats it is what key poses snap to. */
const halfBeat = (beats: readonly number[], half: number): number => {
  const i = Math.floor(half / 2);
  return half % 2 === 0 ? beats[i] : (beats[i] + beats[i + 1]) / 2;
};

/** The half beats that all times lie on, or null where one does not, or would come to lie on another frame with the beats as shared. */
function onBeats(times: readonly number[], grid: BeatGrid | null): number[] | null {
  if (!grid) return null;
  const shared = sharedGrid(grid).beats;
  const halves = new Map<number, number>();
  for (let half = 0; half < 2 * grid.beats.length - 1; half += 1) halves.set(halfBeat(grid.beats, half), half);
  const found = times.map((time) => halves.get(time) ?? -1);
  const same = (half: number, i: number) => half >= 0 && frameOf(halfBeat(shared, half)) === frameOf(times[i]);
  return found.every(same) ? found : null;
}

const EXTRAS = { locked: 1, strength: 2, name: 4, suggested: 8 } as const;

/** Writes key poses; `byJoint` puts the same number of all poses side by side. */
export function writeKeys(out: ByteWriter, keys: readonly KeyPose[], grid: BeatGrid | null, byJoint: boolean): void {
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

/** Reads {@link writeKeys}; unchecked. @param grid - As the link has it. */
export function readKeys(from: ByteReader, grid: BeatGrid | null | { beats: number[] }, byJoint: boolean) {
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
