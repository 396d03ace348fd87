/**
 * The last step of a dance, apart from the network: through the key poses as firmly as the dial says, and feet on the floor. A dance that
 * keeps its uncorrected form can be finished again for another strength in no time.
 */
import { cleanContacts, LOOKAHEAD, type ContactState } from './contact';
import { correctToKeys, keysOnFrames, type FrameKey } from './correction';
import { heldAround, keysWithin, type FrameRange } from './excerpt';
import { alignSigns, copyFrames, emptyMotion, sliceMotion } from './motion';
import { withLayer, type RangeLayer } from './range-layer';
import { spec } from './spec';
import type { KeyPose, Motion } from './types';

/** A correction and the smoothing reach this far at most, frames; only what nothing later can reach is cleaned and shown. */
export const SETTLE = Math.ceil(0.7 * spec.fps) + 6;

/** A dance before key poses and floor had their say. */
export interface UncorrectedDance {
  /** What the network gave, with whatever does not depend on the key strength already done to it. */
  motion: Motion;
  /** How many frames were there each time a stretch was cleaned; the same stretches again give the same dance again. */
  stretches: readonly number[];
  /** Ranges made anew, later ones over earlier ones; their frames count in `motion`. */
  layers?: readonly RangeLayer[];
  /** Where in a longer song this lies: `motion` begins on frame `from`, and the song has `frames` frames. */
  place?: { from: number; frames: number };
}

/** How the feet are cleaned. */
export interface CleaningOptions {
  /** Frames of the key poses. */
  keys: readonly number[];
  cleanFeet: boolean;
}

/** Cleans a dance stretch by stretch; what is cleaned never changes again. */
export interface Cleaner {
  /**
   * Goes on with what is there now.
   * @param corrected the dance moved through its keys, final up to `stable` minus SETTLE
   * @param last nothing comes after `stable`
   */
  clean(corrected: Motion, stable: number, last: boolean): void;
  /** Frames cleaned so far. */
  readonly done: number;
  /** A copy of all that is cleaned so far. */
  result(): Motion;
}

/** @param frames length of the whole dance */
export function createCleaner(frames: number, { keys, cleanFeet }: CleaningOptions): Cleaner {
  const output = emptyMotion(frames);
  let state: ContactState | undefined;
  let done = 0;
  return {
    get done() {
      return done;
    },
    clean(corrected, stable, last) {
      const to = last ? frames : Math.max(done, stable - SETTLE - LOOKAHEAD);
      if (to > done) {
        const view: Motion = { ...corrected, frames: last ? frames : stable - SETTLE };
        if (cleanFeet) state = cleanContacts(view, output, done, to, { keys, state });
        else copyFrames(corrected, done, to, output, done);
        done = to;
      }
    },
    result: () => alignSigns(sliceMotion(output, 0, done)),
  };
}

/**
 * Finishes an uncorrected dance. The same dance, keys and strength always give the same motion: the one that `generateMotion` gives for
 * that strength.
 * @param uncorrected as `GenerationHooks.onUncorrected` hands it out; left as it is
 * @param keyPoses the visitor's key poses; those outside the dance do not count
 * @param strength 0 = the network alone .. 1 = every key pose exactly; times the strength of each key pose
 */
export function finishDance(
  { motion, stretches, layers, place }: UncorrectedDance,
  keyPoses: readonly KeyPose[],
  strength: number,
  cleanFeet = true,
): Motion {
  const { frames, fps } = motion;
  const inside = place ? keysWithin(keyPoses, place.from, place.from + frames) : keyPoses;
  const keys = keysOnFrames(inside, fps, frames);
  const corrected = sliceMotion(motion, 0, frames);
  correctToKeys(corrected, keys, strength);
  const cleaner = createCleaner(frames, { keys: keys.map((key) => key.frame), cleanFeet });
  for (const stable of stretches) cleaner.clean(corrected, stable, false);
  cleaner.clean(corrected, frames, true);
  const whole = cleaner.result();
  const done = (layers ?? []).reduce((below, layer) => finishLayer(below, layer, keys, strength, cleanFeet), whole);
  return place ? heldAround(done, place.from, place.frames) : done;
}

/**
 * Lays a range made anew onto a finished dance. Rotations and places outside the range stay as they are.
 * @param below left as it is
 * @param keys of the whole dance
 * @param strength key strength, 0..1
 * @returns the whole dance
 */
export function finishLayer(
  below: Motion,
  layer: RangeLayer,
  keys: readonly FrameKey[],
  strength: number,
  cleanFeet = true,
): Motion {
  const { from, to } = layer;
  const made = withLayer(below, layer);
  const inside = keys.filter((key) => key.frame >= from && key.frame < to);
  correctToKeys(made, inside, strength, { from, to });
  const output = sliceMotion(below, 0, below.frames);
  if (cleanFeet) {
    const fixedAfter = to < below.frames;
    cleanContacts(made, output, from, to, { keys: inside.map((key) => key.frame), fixedAfter });
  } else {
    copyFrames(made, from, to, output, from);
  }
  return alignSigns(output);
}

/** The part of its song that a dance is for; null = all of it. */
export function partOf({ motion, place }: UncorrectedDance): FrameRange | null {
  return place ? { from: place.from, to: place.from + motion.frames } : null;
}

/** An uncorrected dance with its layers laid on, as the network of the next range sees it. */
export function flattened({ motion, layers }: UncorrectedDance): Motion {
  return (layers ?? []).reduce(withLayer, motion);
}
