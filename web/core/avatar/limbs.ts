/** Where the joints are in a chain of bones, by the lengths that human limbs have. */
import { dot, minus, norm, distance, type Vector } from '../vector';

/** A foot or hand may be this long against the whole limb, a collar bone against the upper arm. */
const LONGEST_FOOT = 0.45;
const LONGEST_COLLAR = 0.8;
/** Cosine of 30 degrees: where a leg turns by more, the foot begins. */
const FOOT_TURN = 0.87;
/** What a bone in the middle of a limb costs: few have more than two. */
const SKIPPED = 0.25;

/** Length along the chain up to each bone. */
function lengths(places: readonly Vector[]): number[] {
  const sums = [0];
  for (let i = 1; i < places.length; i++) sums.push(sums[i - 1] + distance(places[i - 1], places[i]));
  return sums;
}

/** The three bones, in order, with the lowest cost. */
function bestThree(
  count: number,
  cost: (first: number, second: number, third: number) => number,
): [number, number, number] {
  let best: [number, number, number] = [0, 1, 2];
  let least = Infinity;
  for (let a = 0; a < count - 2; a++) {
    for (let b = a + 1; b < count - 1; b++) {
      for (let c = b + 1; c < count; c++) {
        const value = cost(a, b, c) + SKIPPED * (c - a - 2);
        if (value < least) [least, best] = [value, [a, b, c]];
      }
    }
  }
  return best;
}

/**
 * Hip, knee, ankle and toes of a leg: thigh and shin alike long, a foot that turns away from them.
 * @param chain three bones or more, from the pelvis down
 * @param places where they are
 * @param up of the body
 */
export function splitLeg(chain: readonly number[], places: readonly Vector[], up: Vector) {
  const sum = lengths(places);
  const total = sum[sum.length - 1];
  const turnsAt = (i: number) => {
    const foot = minus(places[i + 1], places[i]);
    return -dot(foot, up) < FOOT_TURN * norm(foot) * norm(up);
  };
  const [hip, knee, ankle] = bestThree(chain.length, (h, k, a) => {
    const [thigh, shin, foot] = [sum[k] - sum[h], sum[a] - sum[k], (total - sum[a]) / total];
    const last = a === chain.length - 1;
    // What lies level at the end of a leg is a foot, not a shin.
    const end = last ? 0.3 + (turnsAt(a - 1) ? 0.5 : 0) : 4 * Math.max(0, foot - LONGEST_FOOT) + (turnsAt(a) ? 0 : 0.3);
    return 4 * Math.log(thigh / shin) ** 2 + 3 * (sum[h] / total) + end + 1 - (thigh + shin) / total;
  });
  return {
    hip: chain[hip],
    knee: chain[knee],
    ankle: chain[ankle],
    toe: chain[ankle + 1] as number | undefined,
    tip: chain[chain.length - 1],
  };
}

/**
 * Collar, shoulder, elbow and wrist of an arm: upper arm and forearm alike long, a shorter collar bone before them.
 * @param chain three bones or more, from the chest on
 * @param ends true when the last bone is surely the wrist
 */
export function splitArm(chain: readonly number[], places: readonly Vector[], ends: boolean) {
  const sum = lengths(places);
  const total = sum[sum.length - 1];
  const [shoulder, elbow, wrist] = bestThree(chain.length, (s, e, w) => {
    if (ends && w !== chain.length - 1) return Infinity;
    const [upper, fore, hand] = [sum[e] - sum[s], sum[w] - sum[e], total - sum[w]];
    const collar = s === 0 ? 0.3 : 3 * Math.max(0, sum[s] / upper - LONGEST_COLLAR);
    const tail = 3 * Math.max(0, hand / fore - LONGEST_COLLAR);
    return 4 * Math.log(upper / fore) ** 2 + collar + tail + 1 - (upper + fore) / total;
  });
  return {
    collar: shoulder > 0 ? chain[shoulder - 1] : undefined,
    shoulder: chain[shoulder],
    elbow: chain[elbow],
    wrist: chain[wrist],
  };
}
