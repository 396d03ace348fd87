/** Keeps a suggested dance from standing still, and from whirling round: a key pose that would is stepped again. */
import { angleBetween, axisAngleToQuaternion } from './rotation';
import { poseDistance, poseOfRow, ROW_SIZE } from './suggest-pose';
import { TEMPERATURES, type StepContext } from './suggest-step';
import type { StepRunner } from './suggest';

/** Two poses whose joints are less apart than this look the same, metres, mean over the joints. */
export const VISIBLE_DISTANCE = 0.06;
/** Between poses this far apart in time that distance is enough, seconds; nearer ones need to move as much less, farther ones more. */
const FULL_SECONDS = 0.6;
/** But not more than this many times as much: the way from one to the other is a dance of its own then. */
const MOST_OF_IT = 2;
/** Steps to and fro within that distance look like standing still, too, when they go on for this long, seconds. */
const LINGER_SECONDS = 1;
/** Fastest turn of the body from key pose to key pose, radians a second: over half a second no AIST++ dance trained on turns faster. */
export const FASTEST_TURN = 4.75;
/** Poses that are tried on one beat; the best of them is taken where none moves as it should. */
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

/** The key poses that the one on a beat has to do with. */
export interface Neighbours {
  /** The one before and the one after, as far as they are known. */
  around: readonly Neighbour[];
  /** Those before it; only the last second counts. */
  recent: readonly Neighbour[];
}

/** Distance at which two poses that far apart in time look different, metres. */
const needed = (seconds: number) => VISIBLE_DISTANCE * Math.min(MOST_OF_IT, Math.abs(seconds) / FULL_SECONDS);

/**
 * How much a pose moves from its neighbours, 1 where it just looks like another pose; infinite without any.
 * @param time of the pose, seconds
 */
export function movement(rotations: readonly number[], time: number, { around, recent }: Neighbours): number {
  const shares = around.map((other) => poseDistance(rotations, other.rotations) / needed(time - other.time));
  const lingering = recent.filter((other) => time - other.time <= LINGER_SECONDS);
  if (lingering.length > 1) {
    const oldest = Math.max(...lingering.map((other) => time - other.time));
    const farthest = Math.max(...lingering.map((other) => poseDistance(rotations, other.rotations)));
    shares.push(farthest / Math.min(VISIBLE_DISTANCE, needed(oldest)));
  }
  return Math.min(Infinity, ...shares);
}

/**
 * How easily the body turns from its neighbours to a pose, 1 where it just can in the time that there is; infinite without any.
 * @param time of the pose, seconds
 */
export function turning(rotations: readonly number[], time: number, { around }: Pick<Neighbours, 'around'>): number {
  const pelvis = (of: readonly number[]) => axisAngleToQuaternion(of.slice(0, 3));
  return Math.min(
    Infinity,
    ...around.map((other) => {
      const angle = angleBetween(pelvis(rotations), pelvis(other.rotations));
      return (FASTEST_TURN * Math.abs(time - other.time)) / Math.max(1e-9, angle);
    }),
  );
}

/**
 * Steps a beat until its pose moves from the key poses next to it, and no faster than a body turns. Every try rules out the codes of
 * those before it and keeps their noise, so codes come in the order of a draw without replacement (Gumbel top-k; Kool et al. 2019) and the
 * same noise gives the same pose.
 * @param noise 512 numbers, changed: the codes tried are forbidden in it
 * @param neighbours the key poses that this one must not repeat; null: the first step is taken
 * @returns the network's pose, 147 numbers
 */
export async function stepMoving(
  context: StepContext,
  beat: number,
  temperature: number,
  noise: Float32Array,
  time: number,
  neighbours: Neighbours | null,
  run: StepRunner,
): Promise<Float32Array> {
  let best: { row: Float32Array; fits: number } | undefined;
  for (let tried = 0; tried < MOST_TRIES; tried++) {
    const { poses, codes } = await run(context.inputs(beat, Math.min(BOLDEST, temperature * BOLDER ** tried), [noise]));
    const row = poses.slice(0, ROW_SIZE);
    const pose = poseOfRow(row);
    const fits = neighbours ? Math.min(1, movement(pose, time, neighbours), turning(pose, time, neighbours)) : 1;
    if (!best || fits > best.fits) best = { row, fits };
    if (fits >= 1) break;
    for (const code of codes) noise[code] = FORBIDDEN;
  }
  return best!.row;
}
