/** A source of numbers in [0, 1). */
export type Random = () => number;

/**
 * Seeded numbers that are the same on every machine: mulberry32, 32-bit integer arithmetic only.
 * @param seed any integer; others are truncated
 */
export function seededRandom(seed: number): Random {
  // The golden-ratio step keeps neighbouring seeds from starting with neighbouring numbers.
  let state = Math.imul(Math.trunc(seed) | 0, 0x9e3779b1) ^ 0x85ebca6b;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/**
 * One index by weight.
 * @param weights at least one, none negative; all zero means the first
 */
export function chooseWeighted(weights: readonly number[], random: Random): number {
  let rest = random() * weights.reduce((sum, weight) => sum + weight, 0);
  for (let i = 0; i < weights.length; i++) {
    rest -= weights[i];
    if (rest < 0) return i;
  }
  return 0;
}
