/** How good a dance is, in numbers. */
import { beatHitRate, consistencyError, footSkate, meanJerk, smoothness } from '../core/metrics';
import type { BeatGrid, KeyPose, Motion } from '../core/types';

/** Measures of a dance; see core/metrics for each definition. */
export interface DanceReport {
  /** Paper A, eq. 13: squared distance over the 144 rotation numbers, mean over the key poses; NaN without any. */
  consistencyError: number;
  /** Paper A, eq. 16. */
  smoothness: number;
  /** Mean over joints and frames, m/s^3. */
  jerk: number;
  /** Share of the beats that have a motion beat within 1, 2, 3, 4, 5 frames. */
  beatHitRate: number[];
  /** Mean speed of feet on the floor, m/s. */
  footSkate: number;
}

/** Measures a dance. Takes some 100 ms for a long one, so the page asks the report worker. */
export function measureDance(motion: Motion, keyPoses: readonly KeyPose[], grid: BeatGrid | null): DanceReport {
  const end = motion.frames / motion.fps;
  const beats = (grid?.beats ?? []).filter((beat) => beat < end);
  return {
    consistencyError: consistencyError(motion, keyPoses),
    smoothness: smoothness(motion),
    jerk: meanJerk(motion),
    beatHitRate: [1, 2, 3, 4, 5].map((delta) => beatHitRate(motion, beats, delta)),
    footSkate: footSkate(motion),
  };
}
