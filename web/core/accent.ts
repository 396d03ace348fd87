/** Beats made visible: a dancer arrives on the beat and leaves it again, so the motion slows there and hurries in between. */
import type { BeatPhase } from './beat-phase';
import { bump } from './interpolate';
import { emptyMotion, framePose, frameView } from './motion';
import type { Motion } from './types';

/** By how much the dance is slower on a beat than on average; it is that much faster half-way between two beats. */
const DEPTH = 0.35;
/** Towards a key pose the bending fades out from this many frames on: the dance comes to the pose when the network says. */
const KEY_REACH = 8;

/**
 * A dance with its time bent around the beats. Beats stay where they are; in between, no frame moves by more than DEPTH / (2 pi) of a beat
 * (28 ms at 120 beats a minute), and what is on a key's frame does not move at all.
 * @param phase beats of the song
 * @param keys frames of the song that have a key pose
 * @param start frame of the song at which the dance begins
 */
export function accentBeats(motion: Motion, phase: BeatPhase, keys: readonly number[] = [], start = 0): Motion {
  const bent = emptyMotion(motion.frames);
  const step = 1 / motion.fps;
  const held = new Float64Array(motion.frames);
  for (const key of keys) {
    for (let t = Math.max(0, key - start - KEY_REACH); t <= Math.min(motion.frames - 1, key - start + KEY_REACH); t++) {
      held[t] = Math.max(held[t], bump((t - (key - start)) / KEY_REACH));
    }
  }
  for (let t = 0; t < motion.frames; t++) {
    const seconds = (start + t) * step;
    const rate = Math.max(0.2, (phase.at(seconds + step) - phase.at(seconds - step)) / (2 * step));
    const shift = ((1 - held[t]) * DEPTH * Math.sin(2 * Math.PI * phase.at(seconds))) / (2 * Math.PI * rate);
    framePose(motion, t * step - shift, frameView(bent, t));
  }
  return bent;
}
