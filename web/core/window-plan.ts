/** How a long song is cut into windows, and what the network gets for one. */
import type { FrameKey } from './correction';
import { pelvisToLocal, toLocalRows, type LocalFrame } from './localframe';
import { quaternionsToSixD } from './rotation';
import { spec } from './spec';
import type { Features, Motion } from './types';

const { musicFrames, overlapFrames, rotationSize } = spec.model;

/** Frames [start, end) of a dance, made in one run of the network. */
export interface WindowSpan {
  start: number;
  end: number;
}

/**
 * Windows that cover [from, to). Each is at most musicFrames long and overlaps the one before by overlapFrames. A window ends right after
 * a key where there is one in its last third: the network only knows what to aim for up to its last key.
 * @param keyFrames ascending
 */
export function planWindows(from: number, to: number, keyFrames: readonly number[]): WindowSpan[] {
  const windows: WindowSpan[] = [];
  let start = from;
  for (;;) {
    const limit = start + musicFrames;
    if (limit >= to) {
      windows.push({ start, end: to });
      return windows;
    }
    const last = keyFrames.findLast((frame) => frame < limit && frame >= start + Math.round((musicFrames * 2) / 3));
    const end = last === undefined ? limit : last + 1;
    windows.push({ start, end });
    start = end - overlapFrames;
  }
}

/** What the network gets for one window; shapes in brackets, T = frames, S = seedFrames. */
export interface WindowInputs {
  frames: number;
  seedFrames: number;
  /** [T, 15] */
  music: Float32Array;
  /** [S, 147] */
  seed: Float32Array;
  /** [T, 144], zero where there is no key */
  keyPoses: Float32Array;
  /** [T], 1 at a key */
  keyMask: Float32Array;
  /** [T], frames back to the key at or before t; -1 = none */
  toPrevious: Float32Array;
  /** [T], frames on to the key at or after t; -1 = none */
  toNext: Float32Array;
}

/** Runs the network on one window: [T, 147] in the window's local frame. */
export type RunWindow = (inputs: WindowInputs) => Promise<Float32Array>;

/**
 * Music rows of a stretch of frames. Past the song's ends there is silence: the chroma of the nearest frame, no beats, no onset.
 * @returns frames x 15
 */
export function musicRows(features: Features, start: number, frames: number): Float32Array {
  const width = features.names.length;
  const tonal = features.names.filter((name) => name.startsWith('chroma')).length;
  const rows = new Float32Array(frames * width);
  if (features.frames === 0) return rows;
  for (let t = 0; t < frames; t++) {
    const source = Math.min(features.frames - 1, Math.max(0, start + t));
    const columns = source === start + t ? width : tonal;
    rows.set(features.data.subarray(source * width, source * width + columns), t * width);
  }
  return rows;
}

/**
 * The inputs of one window.
 * @param seed the frames of the dance just before the window, in the world
 * @param keys ascending; those outside the window are left out
 * @param frame the local frame that the network sees it in
 */
export function windowInputs(
  span: WindowSpan,
  features: Features,
  seed: Motion,
  keys: readonly FrameKey[],
  frame: LocalFrame,
): WindowInputs {
  const frames = span.end - span.start;
  const inside = keys.filter((key) => key.frame >= span.start && key.frame < span.end);
  const keyPoses = new Float32Array(frames * rotationSize);
  const keyMask = new Float32Array(frames);
  for (const key of inside) {
    const t = key.frame - span.start;
    const local = key.quaternions.slice();
    local.set(Array.from(pelvisToLocal(key.quaternions.subarray(0, 4), frame)), 0);
    keyPoses.set(quaternionsToSixD(local), t * rotationSize);
    keyMask[t] = 1;
  }
  const { toPrevious, toNext } = keyDistances(keyMask);
  return {
    frames,
    seedFrames: seed.frames,
    music: musicRows(features, span.start, frames),
    seed: toLocalRows(seed, 0, seed.frames, frame),
    keyPoses,
    keyMask,
    toPrevious,
    toNext,
  };
}

/** Frames from each frame back and on to the nearest key; 0 at a key, -1 where there is none (paper A, section 3.3.2). */
export function keyDistances(keyMask: Float32Array): { toPrevious: Float32Array; toNext: Float32Array } {
  const frames = keyMask.length;
  const toPrevious = new Float32Array(frames).fill(-1);
  const toNext = new Float32Array(frames).fill(-1);
  for (let t = 0, key = -1; t < frames; t++) {
    if (keyMask[t]) key = t;
    if (key >= 0) toPrevious[t] = t - key;
  }
  for (let t = frames - 1, key = -1; t >= 0; t--) {
    if (keyMask[t]) key = t;
    if (key >= 0) toNext[t] = key - t;
  }
  return { toPrevious, toNext };
}
