/**
 * Ranges that were made anew, as layers over a dance. A layer holds what the network gave for its range and is laid on before key poses
 * and floor have their say, so one stack of layers can be finished for any key strength.
 */
import { copyFrames, emptyMotion, sliceMotion } from './motion';
import { joinRange } from './motion-blend';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { Motion } from './types';

/** Frames after a range that its own frames can depend on: the pose to arrive at, and how far the bending of time around beats reaches. */
const SEEN_AFTER = 10;

/** A range made anew, as the network gave it. */
export interface RangeLayer {
  /** Frames [from, to) of the dance below. */
  from: number;
  to: number;
  seed: number;
  variation: number;
  /** The to - from frames; x and z of the root count from where the dance below is on the frame before (frame 0: from the origin). */
  motion: Motion;
  /** What it was made to fit: `rangeContext` of the dance below. */
  context: Motion;
}

/** The frames of a dance that a range in it is made to fit: the seed before it and what comes right after it. */
export function rangeContext(below: Motion, from: number, to: number): Motion {
  const first = Math.max(0, from - spec.model.seedFrames);
  const start = Math.max(1, from) - first;
  const last = Math.min(below.frames, to + SEEN_AFTER);
  const context = emptyMotion(start + Math.max(0, last - to));
  copyFrames(below, first, first + start, context, 0);
  copyFrames(below, to, Math.max(to, last), context, start);
  return context;
}

/**
 * Cuts a layer out of a dance.
 * @param made the dance with frames [from, to) as the network gave them
 * @param below the dance that they were made for
 */
export function cutLayer(
  made: Motion,
  below: Motion,
  { from, to }: { from: number; to: number },
  take: { seed: number; variation: number },
): RangeLayer {
  const motion = sliceMotion(made, from, to);
  shift(motion, below, from, -1);
  return { from, to, seed: take.seed, variation: take.variation, motion, context: rangeContext(below, from, to) };
}

/** A copy of a dance with a layer in its range; goes over smoothly at both ends, and its way over the floor ends where the old one goes on. */
export function withLayer(below: Motion, { from, to, motion }: RangeLayer): Motion {
  const made = sliceMotion(below, 0, below.frames);
  const part = sliceMotion(motion, 0, motion.frames);
  shift(part, below, from, 1);
  copyFrames(part, 0, to - from, made, from);
  joinRange(made, below, from, to);
  return made;
}

/** Moves a part of a dance by where the dance below is before it. */
function shift(part: Motion, below: Motion, from: number, sign: 1 | -1): void {
  if (from === 0) return;
  for (const k of [0, 2]) {
    const away = sign * below.root[(from - 1) * 3 + k];
    for (let t = 0; t < part.frames; t++) part.root[t * 3 + k] += away;
  }
}

/** True when two dances are the same to the last bit. */
export function sameMotion(a: Motion, b: Motion): boolean {
  if (a.frames !== b.frames || a.fps !== b.fps) return false;
  for (let i = 0; i < a.frames * 3; i++) if (a.root[i] !== b.root[i]) return false;
  for (let i = 0; i < a.frames * JOINT_COUNT * 4; i++) if (a.quaternions[i] !== b.quaternions[i]) return false;
  return true;
}
