/**
 * A dance of curves (paper B, stage 2): key poses in, one curve of four knots a channel between every two of them out. The network is
 * handed in, so this runs anywhere. Long gaps get poses of the starting clip on their beats first; in the end the feet have their say,
 * and the curves follow what they said, so that what is shown, edited and exported is one and the same.
 */
import { beatCount } from './beat-count';
import { FRAME_FEATURE_SIZE, frameFeatures } from './beat-features';
import { keysOnFrames, type FrameKey } from './correction';
import {
  alignKnots,
  CHANNELS,
  emptyCurves,
  INNER_KNOTS,
  rotationChannel,
  sampleCurves,
  SHAPE_SIZE,
  type CurveAnchor,
  type CurveDance,
} from './curves';
import { tidyBeat } from './curves-edit';
import { plantCurves } from './curves-feet';
import { fillerPoses, headingCurve, KEY_DISTANCE, LONGEST_GAP } from './filler';
import { headingOf } from './localframe';
import { turned } from './motion-blend';
import { slerp } from './rotation';
import { seedMotion } from './seed';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { BeatGrid, Features, KeyPose, Motion, SeedClip } from './types';

const POSE = JOINT_COUNT * 4;
/** Moments of the music that the network hears in an interval. */
export const MOMENTS = spec.danceformer.curve.intervalSteps;
/** Numbers that it gives a channel: tension, continuity, bias, two inner knots. */
export const CURVE_SIZE = SHAPE_SIZE + INNER_KNOTS;
/**
 * Longer gaps between two key poses get poses of the starting clip on their beats, seconds: four knots are few for so much dance. With
 * key poses 1 s apart and nothing between them no more beats are hit than by SLERP.
 */
const LONGEST_INTERVAL = 0.9;
/** Between two key poses that are not far apart such a pose goes only this share of the way from their straight line to the clip's. */
const LEAN = 0.5;
/** Intervals in one run of the network: small enough that cancelling is quick. */
const BATCH = 48;

/** A range of the dance with a take of its own, frames of the song. */
export interface CurveTake {
  from: number;
  to: number;
  seed: number;
  variation: number;
}

/** What a dance of curves is made from. */
export interface CurveRequest {
  features: Features;
  grid: BeatGrid;
  /** ceil(duration x fps) */
  frames: number;
  keyPoses: readonly KeyPose[];
  seedClip: SeedClip;
  otherClips?: readonly SeedClip[];
  options: { variation: number; seed: number; cleanFeet: boolean };
  /** The part of the song to dance to. */
  trim?: { from: number; to: number };
  /** Later ones over earlier ones. */
  takes?: readonly CurveTake[];
}

/** Inputs of the network for B intervals; shapes in brackets. */
export interface IntervalInputs {
  intervals: number;
  /** [B, 4, 24, 4]: the key pose before, the first, the last, the one after. */
  keys: Float32Array;
  /** [B, 2]: 1 where there is one before, and one after. */
  keyMask: Float32Array;
  /** [B, 3]: seconds from the one before, from first to last, to the one after; 0 = none. */
  seconds: Float32Array;
  /** [B, 8, 53] */
  music: Float32Array;
}

/** What the network gives for B intervals. */
export interface IntervalOutputs {
  /** [B, 99, 5]: tension, continuity, bias, both inner knots; the root's off the straight line between its ends, metres. */
  curves: Float32Array;
  /** [B, 2, 3]: the root at the first key pose (x = z = 0) and at the last, counted from there. */
  root: Float32Array;
}

/** Runs the network on some intervals. */
export type RunIntervals = (inputs: IntervalInputs) => Promise<IntervalOutputs>;

/** How the caller follows a generation. */
export interface CurveHooks {
  /** The share that is done, and the intervals so far. */
  onProgress?(fraction: number, intervals: number): void;
  signal?: AbortSignal;
}

/** A key knot before the network: a pose on a frame. */
interface PlacedKey extends FrameKey {
  anchor: CurveAnchor;
}

/**
 * Makes a dance of curves.
 * @returns the curves, which hit every key pose exactly, and the same dance at the spec's rate
 * @throws Error when there is no song; the signal's reason when it is aborted
 */
export async function generateCurves(
  request: CurveRequest,
  run: RunIntervals,
  hooks: CurveHooks = {},
): Promise<{ curves: CurveDance; motion: Motion }> {
  const { frames, features } = request;
  const { from, to } = request.trim ?? { from: 0, to: frames };
  if (!(frames >= 1)) throw new Error('There is no song to dance to: drop a song first.');
  if (!(from >= 0 && to <= frames && to - from >= 2)) {
    throw new Error('The part of the song to dance to is empty or outside the song: trim it anew.');
  }
  const placed = placeKeys(request, from, to);
  const curves = emptyCurves(
    placed.map(({ frame }) => frame / spec.fps),
    frames / spec.fps,
    placed.map(({ anchor }) => anchor),
  );
  placed.forEach(({ quaternions }, k) => curves.keys.set(quaternions, k * CHANNELS + rotationChannel(0)));
  alignKnots(curves);
  const rows = placed.length > 1 ? frameFeatures(features) : new Float32Array(0);
  const ways: Float32Array[] = [];
  const intervals = placed.length - 1;
  for (let at = 0; at < intervals; at += BATCH) {
    hooks.signal?.throwIfAborted();
    const count = Math.min(BATCH, intervals - at);
    const given = await run(intervalInputs(curves, rows, at, count));
    hooks.signal?.throwIfAborted();
    if (given.curves.length !== count * CHANNELS * CURVE_SIZE || given.root.length !== count * 6) {
      throw new Error('The curves model gave numbers of another size: reload the page.');
    }
    takeIn(curves, given, at, count);
    for (let i = 0; i < count; i++) ways.push(given.root.slice(i * 6, i * 6 + 6));
    hooks.onProgress?.((at + count) / intervals, at + count);
  }
  walk(curves, ways);
  alignKnots(curves);
  if (request.options.cleanFeet) plantCurves(curves, frames, from, to);
  return { curves, motion: sampleCurves(curves, spec.fps, frames) };
}

/** All key knots of a dance: the visitor's, fillers on the beats of long gaps, and a pose of the clip at open ends. */
function placeKeys(request: CurveRequest, from: number, to: number): PlacedKey[] {
  const { grid, frames, seedClip, options } = request;
  const count = beatCount(grid);
  const ids = new Map(
    request.keyPoses.map((key) => [Math.min(Math.round(key.time * spec.fps), frames - 1), key.id] as const),
  );
  const own: PlacedKey[] = keysOnFrames(request.keyPoses, spec.fps, frames)
    .filter(({ frame }) => frame >= from && frame < to)
    .map((key) => ({ ...key, anchor: ids.get(key.frame) ?? `f${key.frame}` }));
  const heading = headingCurve(own);
  const fill = (seed: number, variation: number): FrameKey[] =>
    fillerPoses(
      {
        clip: seedClip,
        others: request.otherClips,
        grid,
        keys: own,
        from,
        to,
        variation,
        seed,
        longestGap: LONGEST_INTERVAL,
      },
      heading,
    ).map((filler) => leaned(filler, own));
  let fillers = fill(options.seed, options.variation);
  for (const take of request.takes ?? []) {
    const inside = ({ frame }: FrameKey) => frame >= take.from && frame < take.to;
    fillers = [...fillers.filter((key) => !inside(key)), ...fill(take.seed, take.variation).filter(inside)];
  }
  const anchored = (key: FrameKey): PlacedKey => ({
    ...key,
    anchor: tidyBeat(nearBeat(count.of(key.frame / spec.fps))),
  });
  const keys = [...own, ...fillers.map(anchored)].sort((a, b) => a.frame - b.frame);
  // A dance neither begins nor ends frozen: at an end without a key pose near it the clip says where it comes from and goes.
  const clear = KEY_DISTANCE * spec.fps;
  const clipAt = (frame: number) => anchored({ frame, quaternions: clipPose(request, frame, heading(frame)) });
  if (!keys.length || keys[0].frame - from >= clear) keys.unshift(clipAt(from));
  if (to - 1 - keys[keys.length - 1].frame >= clear) keys.push(clipAt(to - 1));
  return keys;
}

/** A filler between two near key poses, part of the way from the straight line between them; any other as it is. */
function leaned(filler: FrameKey, own: readonly PlacedKey[]): FrameKey {
  const before = own.findLast((key) => key.frame < filler.frame);
  const after = own.find((key) => key.frame > filler.frame);
  if (!before || !after || after.frame - before.frame > LONGEST_GAP * spec.fps) return filler;
  const share = (filler.frame - before.frame) / (after.frame - before.frame);
  const quaternions = filler.quaternions.slice();
  for (let j = 0; j < POSE; j += 4) {
    const straight = slerp(before.quaternions.subarray(j, j + 4), after.quaternions.subarray(j, j + 4), share);
    slerp(straight, quaternions.subarray(j, j + 4), LEAN, quaternions.subarray(j, j + 4));
  }
  return { ...filler, quaternions };
}

/** A beat that a frame was rounded from. */
function nearBeat(beat: number): number {
  const whole = Math.round(beat);
  return Math.abs(beat - whole) < 0.1 ? whole : beat;
}

function clipPose({ seedClip, grid }: CurveRequest, frame: number, heading: number): Float32Array {
  const motion = seedMotion(seedClip, grid, 1, { startTime: frame / spec.fps });
  return turned(motion, heading - headingOf(motion.quaternions.subarray(0, 4)), 0).quaternions.slice(0, POSE);
}

/** What the network is fed for intervals [at, at + count). */
export function intervalInputs(curves: CurveDance, rows: Float32Array, at: number, count: number): IntervalInputs {
  const { times, keys } = curves;
  const last = times.length - 1;
  const inputs: IntervalInputs = {
    intervals: count,
    keys: new Float32Array(count * 4 * POSE),
    keyMask: new Float32Array(count * 2),
    seconds: new Float32Array(count * 3),
    music: new Float32Array(count * MOMENTS * FRAME_FEATURE_SIZE),
  };
  for (let i = 0; i < count; i++) {
    const k = at + i;
    [Math.max(0, k - 1), k, k + 1, Math.min(last, k + 2)].forEach((key, n) => {
      const row = key * CHANNELS + rotationChannel(0);
      inputs.keys.set(keys.subarray(row, row + POSE), (i * 4 + n) * POSE);
    });
    inputs.keyMask.set([k > 0 ? 1 : 0, k + 2 <= last ? 1 : 0], i * 2);
    const gap = (a: number) => (a >= 0 && a < last ? times[a + 1] - times[a] : 0);
    inputs.seconds.set([gap(k - 1), gap(k), gap(k + 1)], i * 3);
    for (let s = 0; s < MOMENTS; s++) {
      const time = times[k] + ((times[k + 1] - times[k]) * (s + 0.5)) / MOMENTS;
      const out = (i * MOMENTS + s) * FRAME_FEATURE_SIZE;
      rowAt(rows, time, inputs.music.subarray(out, out + FRAME_FEATURE_SIZE));
    }
  }
  return inputs;
}

/** The features at a moment, linearly between frames; past the ends those of the end. */
function rowAt(rows: Float32Array, time: number, out: Float32Array): void {
  const frames = rows.length / FRAME_FEATURE_SIZE;
  if (frames === 0) return;
  const position = Math.min(Math.max(time * spec.fps, 0), frames - 1);
  const a = Math.floor(position);
  const b = Math.min(a + 1, frames - 1);
  for (let c = 0; c < FRAME_FEATURE_SIZE; c++) {
    out[c] = (1 - position + a) * rows[a * FRAME_FEATURE_SIZE + c] + (position - a) * rows[b * FRAME_FEATURE_SIZE + c];
  }
}

/** Puts what the network gave for intervals [at, at + count) in its place; the root still off its straight lines. */
function takeIn(curves: CurveDance, given: IntervalOutputs, at: number, count: number): void {
  for (let i = 0; i < count; i++) {
    for (let channel = 0; channel < CHANNELS; channel++) {
      const source = (i * CHANNELS + channel) * CURVE_SIZE;
      for (let n = 0; n < SHAPE_SIZE; n++) {
        const value = Math.min(1, Math.max(-1, given.curves[source + n]));
        curves.shape[((at + i) * SHAPE_SIZE + n) * CHANNELS + channel] = value;
      }
      for (let n = 0; n < INNER_KNOTS; n++) {
        curves.inner[((at + i) * INNER_KNOTS + n) * CHANNELS + channel] = given.curves[source + SHAPE_SIZE + n];
      }
    }
  }
}

/** Lays the way of the root over the floor, interval by interval. */
function walk(curves: CurveDance, ways: readonly Float32Array[]): void {
  const { keys, inner, shares } = curves;
  ways.forEach((way, k) => {
    const [a, b] = [k * CHANNELS, (k + 1) * CHANNELS];
    if (k === 0) keys[1] = way[1];
    keys[b] = keys[a] + way[3];
    keys[b + 1] = way[4];
    keys[b + 2] = keys[a + 2] + way[5];
    for (let n = 0; n < INNER_KNOTS; n++) {
      const share = shares[k * INNER_KNOTS + n];
      const row = (k * INNER_KNOTS + n) * CHANNELS;
      for (let c = 0; c < 3; c++) inner[row + c] += (1 - share) * keys[a + c] + share * keys[b + c];
    }
  });
}
