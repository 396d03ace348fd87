/** Feet of a dance of curves: what is shown, edited and exported is the curves, so it is their knots that make a foot stand. */
import { cleanContacts } from './contact';
import { keepAboveFloor } from './contact-floor';
import { sampleCurves, type CurveDance } from './curves';
import { followMotion } from './curves-fit';
import { copyFrames, sliceMotion } from './motion';
import { spec } from './spec';
import type { Motion } from './types';

/**
 * Four knots do not quite follow a foot that is put down: what is left of its slide is cleaned again, and followed again. After three
 * rounds feet slide no more than in the dance of frames (tests/bench/feet.ts); further ones change little.
 */
const ROUNDS = 3;
/** Then the body is lifted where the curves dip below the floor. */
const LIFTS = 2;

/**
 * Feet on the floor and still where they carry: the curves follow the cleaned dance, in place. The rotations of the visitor's key poses
 * stay exactly as they are.
 * @param frames length of the dance, frames
 * @param from the part that is danced, frames [from, to)
 */
export function plantCurves(curves: CurveDance, frames: number, from: number, to: number): void {
  const own = curves.anchors.map((anchor) => typeof anchor === 'string');
  const frameOfKey = (k: number) => Math.round(curves.times[k] * spec.fps);
  const keys = own.flatMap((is, k) => (is ? [frameOfKey(k) - from] : []));
  const follow = (change: (danced: Motion) => Motion) => {
    const whole = sampleCurves(curves, spec.fps, frames);
    copyFrames(change(sliceMotion(whole, from, to)), 0, to - from, whole, from);
    followMotion(curves, whole, own);
  };
  for (let round = 0; round < ROUNDS; round++) {
    follow((danced) => {
      const clean = sliceMotion(danced, 0, danced.frames);
      cleanContacts(danced, clean, 0, danced.frames, { keys });
      return clean;
    });
  }
  for (let round = 0; round < LIFTS; round++) {
    follow((danced) => {
      keepAboveFloor(danced);
      return danced;
    });
  }
}
