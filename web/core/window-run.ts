/** One window of a dance: what the network is fed, how it is run, and how what it gives is joined to the dance so far. */
import type { FrameKey } from './correction';
import { fillerPoses, headingCurve } from './filler';
import { fromLocalRows, headingOf, localFrameAt } from './localframe';
import { copyFrames, sliceMotion } from './motion';
import { blendInto, turned } from './motion-blend';
import { seedMotion } from './seed';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import { limitTurns } from './turn-limit';
import type { Features, Motion } from './types';
import { windowInputs, type RunWindow, type WindowSpan } from './window-plan';
import type { GenerationRequest } from './windows';

const POSE = JOINT_COUNT * 4;
const { seedFrames } = spec.model;
/** Frames that the network goes on past the song's end, so that the last beats have something to aim for. */
export const TAIL = spec.fps;

/**
 * All that is fed to the network: the user's keys and the fillers, ascending.
 * @param from first frame of what is danced
 * @param to the frame after its last
 * @param start where the dance goes on from: a frame, and the heading there in radians
 */
export function networkKeys(
  request: GenerationRequest,
  keys: FrameKey[],
  from: number,
  to: number,
  start?: { frame: number; heading: number },
): FrameKey[] {
  const { seedClip: clip, otherClips: others, grid, options } = request;
  if (options.fillers === false) return keys;
  const heading = headingCurve(keys, start);
  const fillers = fillerPoses(
    { clip, others, grid, keys, from, to, variation: options.variation, seed: options.seed },
    heading,
  );
  return [...keys, ...fillers].sort((a, b) => a.frame - b.frame);
}

/** The dance before frame 0: the given one as it stands, or the clip on the grid, facing where the dance begins. */
export function openingSeed(request: GenerationRequest, heading: number): Motion {
  if (request.opening) return request.opening;
  const seed = seedMotion(request.seedClip, request.grid, seedFrames, { startTime: -seedFrames / spec.fps });
  const last = seedFrames - 1;
  return turned(seed, heading - headingOf(seed.quaternions.subarray(last * POSE, last * POSE + 4)), last);
}

/** Runs one window and blends it into the raw dance. `offset` is where frame 0 of the song lies in `raw`. */
export async function addWindow(
  span: WindowSpan,
  before: WindowSpan | undefined,
  raw: Motion,
  offset: number,
  features: Features,
  keys: readonly FrameKey[],
  runWindow: RunWindow,
): Promise<void> {
  const start = span.start + offset;
  const seed = sliceMotion(raw, start - seedFrames, start);
  const frame = localFrameAt(seed, seedFrames - 1);
  const inputs = windowInputs(span, features, seed, keys, frame);
  const rows = await runWindow(inputs);
  const wanted = inputs.frames * spec.model.motionSize;
  if (rows.length !== wanted)
    throw new Error(`The model gave ${rows.length} numbers for a window instead of ${wanted}.`);
  const made = fromLocalRows(rows, frame);
  limitTurns(made);
  const overlap = before ? before.end - span.start : 0;
  blendInto(made, 0, raw, start, overlap);
  copyFrames(made, overlap, made.frames, raw, start + overlap);
}
