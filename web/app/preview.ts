/** A whole dance in slices, so that no slice blocks the page. */
import { copyFrames, emptyMotion } from '../core/motion';
import type { Motion } from '../core/types';
import { breathe } from './context';

/** Frames made between two breaths: some 10 ms of work. */
const SLICE = 300;

/**
 * @param make - Makes `count` frames that start at `startTime` seconds.
 * @param frames - Length of the whole.
 * @returns The dance, or null when `signal` fired.
 */
export async function previewDance(
  make: (count: number, startTime: number) => Motion,
  frames: number,
  signal: AbortSignal,
): Promise<Motion | null> {
  const whole = emptyMotion(frames);
  for (let at = 0; at < frames; at += SLICE) {
    if (signal.aborted) return null;
    const count = Math.min(SLICE, frames - at);
    copyFrames(make(count, at / whole.fps), 0, count, whole, at);
    await breathe();
  }
  return whole;
}
