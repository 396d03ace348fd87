/**
 * The beats of a link. Regular ones are exact and cost next to nothing (`byte-pack.ts`). Beats that a person played or tapped differ from
 * any rule by some hundredths of a second, and to keep these to the microsecond would take most of the link: they are rounded to a
 * millisecond, and what is written is how far each one is from where the beats before it let one expect it.
 */
import type { BeatGrid } from '../types';
import { ByteWriter, DamagedBytes, type ByteReader } from './byte-pack';

const MAX_BEATS = 100_000;
/** Parts of a second that played beats are rounded to. */
const PARTS = 1000;
/** More bytes a beat than this, and the beats are played. */
const REGULAR = 1.5;
/** Fewer beats than this are not worth a rounding. */
const FEW = 16;
/** Played beats that are closer together stay as they are, seconds: rounding must not make a document that needs repair. */
const CLOSE = 0.02;
/**
 * How the next beat is foreseen: an alpha-beta filter (Kalata 1984), whose place follows what was played by the first share and whose
 * pace by the second. The best for the beats at hand is written with them. Append only.
 */
const GAINS = [
  [1, 0],
  [0.1, 0.005],
  [0.2, 0.02],
  [0.35, 0.05],
  [0.5, 0.1],
  [0.6, 0.2],
  [0.8, 0.4],
  [1, 1],
] as const;

/** True for beats that a link rounds to a millisecond. */
export function isPlayed({ beats, downbeats }: BeatGrid): boolean {
  if (beats.length < FEW || beats.some((time, i) => i > 0 && time - beats[i - 1] < CLOSE)) return false;
  const exact = new ByteWriter();
  exact.times(beats);
  const known = new Set(beats);
  return exact.bytes.length > REGULAR * beats.length + FEW && downbeats.every((time) => known.has(time));
}

/** The grid as a link has it. */
export function sharedGrid(grid: BeatGrid): BeatGrid {
  if (!isPlayed(grid)) return grid;
  const round = (time: number) => Math.round(time * PARTS) / PARTS;
  return { ...grid, beats: grid.beats.map(round), downbeats: grid.downbeats.map(round) };
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

/** Writes an exact grid: tempo (number), beats a bar (byte), beats (times), bars (0 and every so many beats from an index; or 1 and times). */
export function writeGrid(out: ByteWriter, grid: BeatGrid): void {
  out.number(grid.tempo);
  out.byte(grid.beatsPerBar);
  out.times(grid.beats);
  const first = evenBars(grid);
  out.byte(first === null ? 1 : 0);
  if (first === null) out.times(grid.downbeats);
  else out.whole(first);
}

/** Reads {@link writeGrid}; unchecked. */
export function readGrid(from: ByteReader) {
  const tempo = from.number();
  const beatsPerBar = from.byte();
  const beats = from.times(MAX_BEATS);
  const even = from.byte() === 0;
  const downbeats = even ? barsFrom(beats, beatsPerBar || 1, from.whole()) : from.times(MAX_BEATS);
  return { tempo, beatsPerBar, beats, downbeats };
}

/**
 * Writes a played grid that is rounded already: tempo (number), beats a bar (byte), number of beats (whole), gains (byte), first beat and
 * first gap (signed, milliseconds), then for each further beat how far it is from the one foreseen (signed); bars as above, or 1, how
 * many, and the steps between their beats' indices (whole).
 */
export function writePlayed(out: ByteWriter, grid: BeatGrid): void {
  const { beats, downbeats } = grid;
  out.number(grid.tempo);
  out.byte(grid.beatsPerBar);
  out.whole(beats.length);
  const ticks = beats.map((time) => Math.round(time * PARTS));
  const cost = (list: readonly number[]) => list.reduce((sum, off) => sum + Math.log2(1 + Math.abs(off)), 0);
  const ways = GAINS.map((_, gains) => surprises(ticks, gains));
  const best = ways.reduce((least, way, i) => (cost(way) < cost(ways[least]) ? i : least), 0);
  out.byte(best);
  out.signed(ticks[0]);
  out.signed(ticks[1] - ticks[0]);
  for (const off of ways[best]) out.signed(off);
  const first = evenBars(grid);
  out.byte(first === null ? 1 : 0);
  if (first !== null) out.whole(first);
  else {
    out.whole(downbeats.length);
    const indices = new Map(beats.map((time, i) => [time, i]));
    const places = downbeats.map((time) => indices.get(time)!);
    places.forEach((place, i) => out.whole(place - (places[i - 1] ?? 0)));
  }
}

/** Reads {@link writePlayed}; unchecked. */
export function readPlayed(from: ByteReader) {
  const tempo = from.number();
  const beatsPerBar = from.byte();
  const count = from.count(MAX_BEATS);
  const gains = GAINS[from.byte()];
  if (!gains || count < 2) throw new DamagedBytes('The beats are damaged.');
  const first = from.signed();
  const ticks = [first, first + from.signed()];
  const foresee = foreseer(ticks[0], ticks[1], gains);
  while (ticks.length < count) {
    const tick = foresee.next() + from.signed();
    foresee.saw(tick);
    ticks.push(tick);
  }
  const beats = ticks.map((tick) => tick / PARTS);
  if (from.byte() === 0)
    return { tempo, beatsPerBar, beats, downbeats: barsFrom(beats, beatsPerBar || 1, from.whole()) };
  let place = 0;
  const downbeats = Array.from({ length: from.count(MAX_BEATS) }, () => beats[(place += from.whole())]);
  return { tempo, beatsPerBar, beats, downbeats };
}

/** How far each beat from the third on is from the one foreseen. */
function surprises(ticks: readonly number[], gains: number): number[] {
  const foresee = foreseer(ticks[0], ticks[1], GAINS[gains]);
  return ticks.slice(2).map((tick) => {
    const off = tick - foresee.next();
    foresee.saw(tick);
    return off;
  });
}

/** Sums and products only, which are the same numbers in every browser. */
function foreseer(first: number, second: number, [follow, bend]: readonly [number, number]) {
  let place = second;
  let pace = second - first;
  return {
    next: () => Math.round(place + pace),
    saw(tick: number) {
      const off = tick - (place + pace);
      place += pace + follow * off;
      pace += bend * off;
    },
  };
}
