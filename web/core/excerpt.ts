/** A stretch of a song as a song of its own, so that a dance to it takes only the windows of the stretch. */
import { copyFrames, emptyMotion, sliceMotion } from './motion';
import { spec } from './spec';
import type { BeatGrid, Features, KeyPose, Motion } from './types';

/** What a dance to a stretch is made from; all times count from its start. */
export interface Excerpt {
  features: Features;
  grid: BeatGrid;
  keyPoses: KeyPose[];
  frames: number;
}

/**
 * Cuts frames [from, to) out of a song.
 * @param whole features, beats and key poses of the song
 */
export function excerpt(
  whole: { features: Features; grid: BeatGrid; keyPoses: readonly KeyPose[] },
  from: number,
  to: number,
): Excerpt {
  const { features, grid } = whole;
  const columns = features.names.length;
  const start = from / features.fps;
  const shift = (times: readonly number[]) => times.map((time) => time - start);
  return {
    features: {
      ...features,
      frames: Math.max(0, Math.min(features.frames, to) - from),
      data: features.data.slice(from * columns, to * columns),
    },
    grid: { ...grid, beats: shift(grid.beats), downbeats: shift(grid.downbeats) },
    keyPoses: keysWithin(whole.keyPoses, from, to),
    frames: to - from,
  };
}

/** Key poses on frames [from, to) of a song, their times counted from there; one on frame `to` counts as on the very end. */
export function keysWithin(keyPoses: readonly KeyPose[], from: number, to: number): KeyPose[] {
  return keyPoses.flatMap((key) => {
    const frame = Math.round(key.time * spec.fps);
    // A time on its frame exactly, so that no rounding error of the difference moves it to the next.
    return frame >= from && frame <= to ? [{ ...key, time: (frame - from) / spec.fps }] : [];
  });
}

/** Frames [from, to). */
export interface FrameRange {
  from: number;
  to: number;
}

/** The danced part of a dance, without the stillness around it, and its key poses counted from there; all of it without a part. */
export function dancedPart(
  motion: Motion,
  keyPoses: readonly KeyPose[],
  part: FrameRange | null | undefined,
): { motion: Motion; keyPoses: readonly KeyPose[] } {
  if (!part) return { motion, keyPoses };
  return { motion: sliceMotion(motion, part.from, part.to), keyPoses: keysWithin(keyPoses, part.from, part.to) };
}

/**
 * A dance to a stretch of a song as a dance to the song: before and after it the figure holds its first and last pose.
 * @param part begins on frame `from`
 * @param frames of the whole song
 * @throws Error when the part has no frames or does not fit
 */
export function heldAround(part: Motion, from: number, frames: number): Motion {
  if (part.frames < 1 || from < 0 || from + part.frames > frames) {
    throw new Error(`A dance of ${part.frames} frames does not fit at frame ${from} of ${frames}.`);
  }
  const motion = emptyMotion(frames);
  const [first, last] = [sliceMotion(part, 0, 1), sliceMotion(part, part.frames - 1)];
  for (let t = 0; t < from; t++) copyFrames(first, 0, 1, motion, t);
  copyFrames(part, 0, part.frames, motion, from);
  for (let t = from + part.frames; t < frames; t++) copyFrames(last, 0, 1, motion, t);
  return motion;
}
