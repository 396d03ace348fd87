/** Height of the pelvis: the lowest point rests on the floor, except in a jump; nothing is ever below it. */
import { bodyTrack } from './contact-body';
import { bump, gaussianSmooth } from './interpolate';
import { spec } from './spec';
import type { Motion } from './types';

/** What counts as a jump: clear of the floor by `start`, above `peak` at its top, the pelvis up by `rise` (metres), for a time a person can be in the air. */
const JUMP = { start: 0.04, peak: 0.08, rise: 0.03, shortest: 0.1, longest: 0.8, highest: 0.6 };
/** Frames over which a lift fades on each side. */
const LIFT_REACH = 8;

/**
 * Height of each frame above the floor where the dance really jumps, else 0, metres: the feet are clear of the floor and the pelvis
 * rises (legs that are only drawn up belong on the floor).
 * @param ground pelvis height at which the lowest point touches the floor, metres
 * @param pelvis pelvis height, metres
 */
export function jumpHeights(ground: Float64Array, pelvis: Float64Array): Float64Array {
  const clearance = pelvis.map((y, i) => y - ground[i]);
  const heights = new Float64Array(clearance.length);
  for (let start = 0; start < clearance.length; start++) {
    if (clearance[start] <= JUMP.start) continue;
    let end = start;
    let peak = 0;
    let top = -Infinity;
    for (; end < clearance.length && clearance[end] > JUMP.start; end++) {
      peak = Math.max(peak, clearance[end]);
      top = Math.max(top, pelvis[end]);
    }
    const seconds = (end - start) / spec.fps;
    const cut = end === clearance.length || start === 0;
    const rises = top - Math.max(pelvis[start], pelvis[end - 1]) > JUMP.rise;
    if (!cut && rises && peak > JUMP.peak && seconds >= JUMP.shortest && seconds <= JUMP.longest) {
      const scale = Math.min(peak, JUMP.highest) / (peak - JUMP.start);
      for (let i = start; i < end; i++) heights[i] = (clearance[i] - JUMP.start) * scale;
    }
    start = end;
  }
  return heights;
}

/**
 * Pelvis heights that follow the floor and the jumps without kinks where the support changes.
 * @param ground the pelvis's height with the lowest point of the body on the floor, one a frame, metres
 * @param raw the pelvis's height as danced, one a frame, metres
 * @returns one a frame, metres
 */
export function pelvisHeights(ground: Float64Array, raw: Float64Array): Float64Array {
  const jumps = jumpHeights(ground, raw);
  return gaussianSmooth(
    ground.map((y, i) => y + jumps[i]),
    1,
    1.5,
  );
}

/** The smallest smooth-sided lift that is nowhere below `missing`, metres. */
export function liftEnvelope(missing: Float64Array): Float64Array {
  const lift = new Float64Array(missing.length);
  for (let i = 0; i < missing.length; i++) {
    if (!(missing[i] > 0)) continue;
    for (let k = Math.max(0, i - LIFT_REACH); k <= Math.min(missing.length - 1, i + LIFT_REACH); k++) {
      lift[k] = Math.max(lift[k], missing[i] * bump((k - i) / (LIFT_REACH + 1)));
    }
  }
  return lift;
}

/** Lifts a dance, in place, where any part of it would be below the floor. */
export function keepAboveFloor(motion: Motion): void {
  const { ground } = bodyTrack(motion);
  const lift = liftEnvelope(ground.map((y, t) => y - motion.root[t * 3 + 1]));
  for (let t = 0; t < motion.frames; t++) motion.root[t * 3 + 1] += lift[t];
}
