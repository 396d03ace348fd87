/**
 * The last step of a dance, apart from the network: through the key poses as firmly as the dial says, and feet on the floor. A dance that
 * keeps its uncorrected form can be finished again for another strength in no time.
 */
import { cleanContacts, LOOKAHEAD, type ContactState } from './contact';
import { correctToKeys, keysOnFrames } from './correction';
import { alignSigns, copyFrames, emptyMotion, sliceMotion } from './motion';
import { joinRange } from './motion-blend';
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
}

/** How the feet are cleaned. */
export interface CleaningOptions {
  /** Frames of the key poses. */
  keys: readonly number[];
  keyStrength: number;
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
export function createCleaner(frames: number, { keys, keyStrength, cleanFeet }: CleaningOptions): Cleaner {
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
        if (cleanFeet) state = cleanContacts(view, output, done, to, { keys, keyStrength, state });
        else copyFrames(corrected, done, to, output, done);
        done = to;
      }
    },
    result: () => alignSigns(sliceMotion(output, 0, done)),
  };
}

/**
 * Finishes an uncorrected dance. The same dance, keys and strength always give the same motion: for a dance made in one go the one that
 * `generateMotion` gives for that strength.
 * @param uncorrected as `GenerationHooks.onUncorrected` hands it out; left as it is
 * @param keyPoses the visitor's key poses; those outside the dance do not count
 * @param strength 0 = the network alone .. 1 = every key pose exactly
 */
export function finishDance(
  { motion, stretches }: UncorrectedDance,
  keyPoses: readonly KeyPose[],
  strength: number,
  cleanFeet = true,
): Motion {
  const { frames, fps } = motion;
  const keys = keysOnFrames(keyPoses, fps, frames);
  const corrected = sliceMotion(motion, 0, frames);
  correctToKeys(corrected, keys, strength);
  const cleaner = createCleaner(frames, { keys: keys.map((key) => key.frame), keyStrength: strength, cleanFeet });
  for (const stable of stretches) cleaner.clean(corrected, stable, false);
  cleaner.clean(corrected, frames, true);
  return cleaner.result();
}

/**
 * A range made anew inside the uncorrected form of the dance around it, whose way over the floor may be another one.
 * @param made the dance with the range [from, to) as the network gave it
 * @param previous the finished dance that the range was made for
 * @param around the uncorrected form of `previous`; left as it is
 */
export function joinUncorrected(
  made: Motion,
  previous: Motion,
  { motion: around, stretches }: UncorrectedDance,
  from: number,
  to: number,
): UncorrectedDance {
  const motion = sliceMotion(around, 0, around.frames);
  copyFrames(made, from, to, motion, from);
  if (from > 0) {
    for (const k of [0, 2]) {
      const apart = around.root[(from - 1) * 3 + k] - previous.root[(from - 1) * 3 + k];
      for (let t = from; t < to; t++) motion.root[t * 3 + k] += apart;
    }
  }
  joinRange(motion, around, from, to);
  return { motion, stretches };
}
