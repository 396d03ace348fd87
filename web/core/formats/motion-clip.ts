/** Dances that left Posebeat as JSON, frames or curves, as animations that poses are taken from. */
import { sampleCurves } from '../curves';
import { spec } from '../spec';
import type { Motion } from '../types';
import { readCurvesJson } from './curves-json';
import { looksLikeMotionJson, readMotionJson } from './motion-json';
import { frameStep, MAX_FRAMES, requireFinite, type PoseClips, type PoseSequence } from './pose-sequence';

/** Kinds of JSON that Posebeat writes beside projects. */
export type JsonKind = 'motion' | 'curves' | 'poses';

/** What JSON says that it is in its first few thousand characters; null for projects and for what is not ours. */
export function jsonKind(head: string): JsonKind | null {
  return (/"format"\s*:\s*"posebeat-(motion|curves|poses)"/.exec(head)?.[1] as JsonKind | undefined) ?? null;
}

/**
 * Reads a dance of either kind; its key poses are the frames that it points out.
 * @throws Error with a sentence for the visitor when it is damaged, of a newer version or of another skeleton
 */
export function readMotionClip(text: string): PoseClips {
  const clip = looksLikeMotionJson(text) ? fromFrames(text) : fromCurves(text);
  requireFinite(clip.quaternions, 'A rotation');
  return { kind: 'Posebeat', clips: [clip] };
}

function fromFrames(text: string): PoseSequence {
  const { motion, song, keyPoses = [] } = readMotionJson(text);
  const times = keyPoses.map(({ time }) => time);
  return thinned(motion, song?.name ?? '', times);
}

function fromCurves(text: string): PoseSequence {
  const curves = readCurvesJson(text);
  // A long dance is sampled more coarsely at once: the file's own length is not to be trusted with memory.
  const last = Math.max(curves.duration, curves.times[curves.times.length - 1]);
  const fps = Math.min(spec.fps, (MAX_FRAMES - 1) / Math.max(last, 1e-6));
  const motion = sampleCurves(curves, fps, Math.max(1, Math.round(last * fps) + 1));
  const own = [...curves.times].filter((_, k) => typeof curves.anchors[k] === 'string');
  return thinned(motion, '', own);
}

/** At most MAX_FRAMES of a dance, with the frames at some times (seconds) pointed out. */
function thinned({ frames, fps, quaternions }: Motion, name: string, times: readonly number[]): PoseSequence {
  const step = frameStep(frames);
  const width = quaternions.length / frames;
  const kept = Math.ceil(frames / step);
  const out = step === 1 ? quaternions : new Float32Array(kept * width);
  if (step > 1) {
    for (let i = 0; i < kept; i++) out.set(quaternions.subarray(i * step * width, (i * step + 1) * width), i * width);
  }
  const rate = fps / step;
  const marks = times.map((time) => Math.round(time * rate)).filter((frame) => frame >= 0 && frame < kept);
  return { name, fps: rate, frames: kept, quaternions: out, ...(marks.length > 0 ? { marks } : {}) };
}
