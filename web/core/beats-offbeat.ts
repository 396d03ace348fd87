/** Beats or the points between them: hats and chords between the beats can be the stronger onsets, but the bass drum is on the beat. */

/** The bass must be this many times as strong between the beats before they are moved there. */
const CLEARLY = 3;
/** Onsets count as on a pulse within this time, seconds. */
const REACH = 0.05;

/**
 * Whether what was tracked are the points between the beats.
 * @param low onset strength of the bass at `rate` frames per second
 * @param positions tracked beats, frames, ascending
 * @returns true when the bass clearly falls between them, and does so nearly everywhere
 */
export function isBetweenBeats(low: ArrayLike<number>, positions: readonly number[], rate: number): boolean {
  if (positions.length < 4) return false;
  const reach = Math.round(REACH * rate);
  const strongest = (at: number): number => {
    let best = 0;
    for (let i = Math.round(at) - reach; i <= Math.round(at) + reach; i++) best = Math.max(best, low[i] ?? 0);
    return best;
  };
  const between = positions.slice(1).map((p, i) => strongest((positions[i] + p) / 2));
  const on = positions.slice(1).map((p, i) => (strongest(positions[i]) + strongest(p)) / 2);
  const sum = (values: number[]): number => values.reduce((total, value) => total + value, 0);
  const often = between.filter((value, i) => value > on[i]).length / between.length;
  return often > 0.8 && sum(between) > CLEARLY * sum(on);
}
