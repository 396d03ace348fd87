/** Extremes of a long curve at every scale, so that drawing costs what is in sight and not how long the song is. */

/** Lowest and highest values of a curve in buckets that double from level to level. */
export interface Pyramid {
  levels: readonly { min: Float32Array; max: Float32Array }[];
}

/** Builds the levels above a curve's own buckets. */
export function buildPyramid(min: Float32Array, max: Float32Array): Pyramid {
  const levels = [{ min, max }];
  for (let below = levels[0]; below.max.length > 1; below = levels[levels.length - 1]) {
    const length = Math.ceil(below.max.length / 2);
    const [low, high] = [new Float32Array(length), new Float32Array(length)];
    for (let i = 0; i < length; i += 1) {
      const [a, b] = [2 * i, Math.min(2 * i + 1, below.max.length - 1)];
      low[i] = Math.min(below.min[a], below.min[b]);
      high[i] = Math.max(below.max[a], below.max[b]);
    }
    levels.push({ min: low, max: high });
  }
  return { levels };
}

/**
 * Lowest and highest value of each of `count` columns.
 *
 * @param perColumn - Buckets of the curve that a column covers.
 * @param first - Number of the first column, counted from the curve's start: the same column has the same extremes however far the
 * view has moved, so that panning does not make the curve shimmer.
 * @param reach - Gets column, lowest and highest; columns outside the curve are left out.
 */
export function forEachColumn(
  { levels }: Pyramid,
  perColumn: number,
  first: number,
  count: number,
  reach: (column: number, low: number, high: number) => void,
): void {
  // One to two buckets a column: a column then looks at three at most.
  const level = Math.min(levels.length - 1, Math.max(0, Math.floor(Math.log2(Math.max(1, perColumn)))));
  const { min, max } = levels[level];
  const step = perColumn / 2 ** level;
  const last = Math.min(count, Math.ceil(max.length / step) - first);
  for (let column = Math.max(0, -first); column < last; column += 1) {
    const from = Math.floor((column + first) * step);
    const to = Math.min(max.length, Math.max(from + 1, Math.floor((column + first + 1) * step)));
    let low = Infinity;
    let high = -Infinity;
    for (let i = from; i < to; i += 1) {
      if (min[i] < low) low = min[i];
      if (max[i] > high) high = max[i];
    }
    if (high >= low) reach(column, low, high);
  }
}
