/** What real dance measures: the yardstick of every number in the report, with its source. */

/**
 * Real dance on the validation clips (Dance with Melody and AIST++), measured by export/evaluate.py: export/results/light.md,
 * "all", keys every 1 s, row "real".
 */
export const REAL_DANCE = {
  /** Where the numbers come from, for people. */
  source: 'dancers in the validation clips (see the model card)',
  /** Share of beats with a motion beat within 1..5 frames. */
  beatHitRate: [0.28, 0.52, 0.675, 0.758, 0.836],
  /** S_cv, paper A eq. 16. */
  smoothness: 864,
  /** From calm clips to wild ones, of those that move, m/s^3. */
  jerk: [55, 305],
  /** The same of the speed of toes on the floor, m/s: not zero, because people turn on them. */
  footSkate: [0.16, 0.36],
} as const;

/** A standstill longer than this looks like a fault while the music plays, seconds. */
export const LONGEST_STANDSTILL = 1;

/** Frames within which a move counts as on the beat wherever one number has to do: 3 frames are a tenth of a second. */
export const ON_BEAT_FRAMES = 3;

/** E_c below which every key pose counts as hit: rotations then differ by rounding alone. */
export const EXACT_ERROR = 1e-6;

/** E_c up to which a pose looks like the key pose: 0.1 is about 3 degrees a joint. */
export const CLOSE_ERROR = 0.1;

/**
 * What a squared distance over the 144 rotation numbers means: how far each of the 24 joints is turned if all are off alike, degrees.
 * A turn by a small angle a moves two of a rotation's three columns, on average over its axes, by 4/3 a^2 squared.
 */
export function degreesPerJoint(error: number): number {
  return (Math.sqrt(error / (24 * (4 / 3))) * 180) / Math.PI;
}
