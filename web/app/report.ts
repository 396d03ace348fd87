/** How good a dance is, in numbers. */
import {
  beatHitRate,
  consistencyError,
  footSkate,
  jointSpeed,
  meanJerk,
  motionBeats,
  smoothness,
} from '../core/metrics';
import { beatConsistency, longestFreeze } from '../core/dance-metrics';
import { consistencyPerKey, type KeyError } from '../core/report-curves';
import { dancedPart, type FrameRange } from '../core/excerpt';
import type { BeatGrid, KeyPose, Motion } from '../core/types';

/** Measures of a dance; see core/metrics for each definition. */
export interface DanceReport {
  /** Paper A, eq. 13: squared distance over the 144 rotation numbers, mean over the key poses; NaN without any. */
  consistencyError: number;
  /** The same of every key pose. */
  consistencyPerKey: KeyError[];
  /** Paper A, eq. 16. */
  smoothness: number;
  /** Mean over joints and frames, m/s^3. */
  jerk: number;
  /** Share of the beats that have a motion beat within 1, 2, 3, 4, 5 frames. */
  beatHitRate: number[];
  /** BC, paper B eq. 1: 0..1, how near the motion beats are to the music's. */
  beatConsistency: number;
  /** Longest stretch without visible motion, seconds. */
  longestFreeze: number;
  /** Mean speed of feet on the floor, m/s. */
  footSkate: number;
  /** Kinetic velocity: mean joint speed between each frame and the next, the pelvis held still, m/s; frames - 1 values. */
  speed: Float32Array;
  /** Its mean, m/s. */
  meanSpeed: number;
  /** Motion beats: the local minima of the kinetic velocity, seconds. */
  motionBeats: number[];
}

/**
 * Measures a dance. Takes some 100 ms for a long one, so the page asks the report worker.
 * @param part what is danced of a trimmed song: only this is measured, yet all times and the speed are those of the whole song
 */
export function measureDance(
  whole: Motion,
  allKeys: readonly KeyPose[],
  grid: BeatGrid | null,
  part: FrameRange | null = null,
): DanceReport {
  const { motion, keyPoses } = dancedPart(whole, allKeys, part);
  const start = (part?.from ?? 0) / motion.fps;
  const end = motion.frames / motion.fps;
  const beats = (grid?.beats ?? []).map((beat) => beat - start).filter((beat) => beat >= 0 && beat < end);
  const speed = jointSpeed(motion);
  const times = new Map(allKeys.map((key) => [key.id, key.time]));
  return {
    consistencyError: consistencyError(motion, keyPoses),
    consistencyPerKey: consistencyPerKey(motion, keyPoses).map((each) => ({ ...each, time: times.get(each.id)! })),
    smoothness: smoothness(motion),
    jerk: meanJerk(motion),
    beatHitRate: [1, 2, 3, 4, 5].map((delta) => beatHitRate(motion, beats, delta)),
    beatConsistency: beatConsistency(motion, beats),
    longestFreeze: longestFreeze(motion),
    footSkate: footSkate(motion),
    speed: part ? jointSpeed(whole) : speed,
    meanSpeed: speed.length ? speed.reduce((sum, value) => sum + value, 0) / speed.length : NaN,
    motionBeats: motionBeats(motion).map((beat) => beat + start),
  };
}
