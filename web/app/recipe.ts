/** What a dance is made from: the parts of the document that count, and the steps of the network that they ask for. */
import {
  frameOf,
  type Dials,
  type EngineName,
  type ProjectDocument,
  type TakeRange,
  type TimeRange,
} from '../core/document';
import type { FrameRange } from '../core/excerpt';
import type { BeatGrid, KeyPose } from '../core/types';

/** The parts of a document that its dance is made from. */
export interface DanceInputs {
  keyPoses: readonly KeyPose[];
  grid: BeatGrid | null;
  dials: Dials;
  ranges: readonly TakeRange[];
  trim: TimeRange | null;
  /** Missing = light. */
  engine?: EngineName;
}

/** A range to be made anew, on frames of the song. */
export interface RangeStep extends FrameRange {
  seed: number;
  variation: number;
}

/** The steps of a dance, in order: first the whole, then each range on top of what is there. */
export interface Recipe {
  /** The part of the song to dance to; null = all of it. */
  trim: FrameRange | null;
  base: { seed: number; variation: number };
  ranges: RangeStep[];
}

/** A range shorter than this is not worth a run of the network, frames. */
export const SHORTEST_RANGE = 8;

/** What the dance of a document is made from. */
export function inputsOf({ keyPoses, grid, dials, ranges, trim, engine }: ProjectDocument): DanceInputs {
  return { keyPoses, grid, dials, ranges, trim, ...(engine ? { engine } : {}) };
}

/** The frames of a trim; null when it leaves the whole song or nothing. */
export function trimFrames(trim: TimeRange | null, frames: number): FrameRange | null {
  if (!trim) return null;
  const from = Math.min(frames, Math.max(0, frameOf(trim.start)));
  const to = Math.min(frames, frameOf(trim.end));
  return to - from < 2 || to - from === frames ? null : { from, to };
}

/**
 * The steps of a dance. A range that covers all that is danced takes the place of everything below it; one outside is left out.
 * @param frames length of the song
 */
export function recipeOf({ dials, ranges, trim }: DanceInputs, frames: number): Recipe {
  const part = trimFrames(trim, frames);
  const { from: first, to: last } = part ?? { from: 0, to: frames };
  const recipe: Recipe = { trim: part, base: { seed: dials.seed, variation: dials.variation }, ranges: [] };
  for (const { start, end, takes, chosen } of ranges) {
    const take = takes.find(({ id }) => id === chosen);
    if (!take) continue;
    const { seed, variation } = take;
    const from = Math.max(first, frameOf(start));
    const to = Math.min(last, frameOf(end));
    if (to - from < SHORTEST_RANGE) continue;
    if (from === first && to === last) {
      recipe.base = { seed, variation };
      recipe.ranges = [];
    } else {
      recipe.ranges.push({ from, to, seed, variation });
    }
  }
  return recipe;
}

/** True when the network would be asked the same but for seeds and ranges. */
export function sameGround(a: DanceInputs, b: DanceInputs, frames: number): boolean {
  const [first, second] = [trimFrames(a.trim, frames), trimFrames(b.trim, frames)];
  return (
    (a.engine ?? 'light') === (b.engine ?? 'light') &&
    a.dials.seedClip === b.dials.seedClip &&
    first?.from === second?.from &&
    first?.to === second?.to &&
    samePoses(a.keyPoses, b.keyPoses) &&
    sameGrid(a.grid, b.grid)
  );
}

/**
 * True when a dance made from `inputs` is what `wanted` asks for.
 * @param tunable the dance follows the strengths of dial and key poses by itself
 */
export function madeFrom(inputs: DanceInputs, wanted: DanceInputs, tunable: boolean, frames: number): boolean {
  if (!sameGround(inputs, wanted, frames)) return false;
  // Curves run through every key pose, whatever the strengths say.
  const follows = tunable || inputs.engine === 'curves';
  if (!follows && inputs.dials.keyStrength !== wanted.dials.keyStrength) return false;
  if (!follows && !sameStrengths(inputs.keyPoses, wanted.keyPoses)) return false;
  const [a, b] = [recipeOf(inputs, frames), recipeOf(wanted, frames)];
  return (
    a.base.seed === b.base.seed &&
    a.base.variation === b.base.variation &&
    a.ranges.length === b.ranges.length &&
    a.ranges.every((step, i) => sameStep(step, b.ranges[i]))
  );
}

/** True when two steps are the same. */
function sameStep(a: RangeStep, b: RangeStep): boolean {
  return a.from === b.from && a.to === b.to && a.seed === b.seed && a.variation === b.variation;
}

/** True when all key poses have the same strengths of their own. */
export function sameStrengths(a: readonly KeyPose[], b: readonly KeyPose[]): boolean {
  return a === b || (a.length === b.length && a.every((key, i) => (key.strength ?? 1) === (b[i].strength ?? 1)));
}

/** The same poses on the same frames; names, locks and strengths do not count. */
function samePoses(a: readonly KeyPose[], b: readonly KeyPose[]): boolean {
  if (a === b) return true;
  return (
    a.length === b.length &&
    a.every((key, i) => frameOf(key.time) === frameOf(b[i].time) && sameNumbers(key.rotations, b[i].rotations))
  );
}

function sameGrid(a: BeatGrid | null, b: BeatGrid | null): boolean {
  if (a === b || !a || !b) return a === b;
  return (
    a.tempo === b.tempo &&
    a.beatsPerBar === b.beatsPerBar &&
    sameNumbers(a.beats, b.beats) &&
    sameNumbers(a.downbeats, b.downbeats)
  );
}

function sameNumbers(a: readonly number[], b: readonly number[]): boolean {
  return a === b || (a.length === b.length && a.every((value, i) => value === b[i]));
}
