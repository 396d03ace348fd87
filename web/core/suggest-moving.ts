/** Keeps a suggested dance from standing still: a key pose that is nearly the one before it is stepped again. */
import { poseDistance, poseOfRow, ROW_SIZE } from './suggest-pose';
import { TEMPERATURES, type StepContext } from './suggest-step';
import type { StepRunner } from './suggest';

/** Two poses whose joints are less apart than this look the same, metres, mean over the joints. */
export const VISIBLE_DISTANCE = 0.06;
/** Between poses this near in time that distance counts in full, seconds; nearer ones need to move as much less. */
const FULL_SECONDS = 0.8;
/** Poses that are tried on one beat; the one that moves most is taken where none moves enough. */
export const MOST_TRIES = 8;
/** Each try is this much bolder: a network that is sure of a pose is sure of its neighbours too. */
const BOLDER = 1.15;
/** And not bolder than the dial can make it: the network's poses stay plausible up to here. */
const BOLDEST = TEMPERATURES[1];
/** Noise that rules a code out. */
export const FORBIDDEN = -1e9;

/** A key pose next to the beat at hand. */
export interface Neighbour {
  /** Seconds. */
  time: number;
  /** 24 x 3 axis-angle, radians. */
  rotations: readonly number[];
}

/**
 * How much a pose moves from its neighbours, 1 where it just looks like another pose; infinite without any.
 * @param time of the pose, seconds
 */
export function movement(rotations: readonly number[], time: number, neighbours: readonly Neighbour[]): number {
  return Math.min(
    ...neighbours.map((other) => {
      const needed = VISIBLE_DISTANCE * Math.min(1, Math.abs(time - other.time) / FULL_SECONDS);
      return needed > 0 ? poseDistance(rotations, other.rotations) / needed : Infinity;
    }),
  );
}

/**
 * Steps a beat until its pose moves from the key poses next to it. Every try rules out the codes of those before it and keeps their noise,
 * so codes come in the order of a draw without replacement (Gumbel top-k; Kool et al. 2019) and the same noise gives the same pose.
 * @param noise 512 numbers, changed: the codes tried are forbidden in it
 * @param neighbours the key poses that this one must not repeat; none: the first step is taken
 * @returns the network's pose, 147 numbers
 */
export async function stepMoving(
  context: StepContext,
  beat: number,
  temperature: number,
  noise: Float32Array,
  time: number,
  neighbours: readonly Neighbour[],
  run: StepRunner,
): Promise<Float32Array> {
  let best: { row: Float32Array; moves: number } | undefined;
  for (let tried = 0; tried < MOST_TRIES; tried++) {
    const { poses, codes } = await run(context.inputs(beat, Math.min(BOLDEST, temperature * BOLDER ** tried), [noise]));
    const row = poses.slice(0, ROW_SIZE);
    const moves = movement(poseOfRow(row), time, neighbours);
    if (!best || moves > best.moves) best = { row, moves };
    if (moves >= 1) break;
    noise[codes[0]] = FORBIDDEN;
  }
  return best!.row;
}
