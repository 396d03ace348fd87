/** Reads a file of curves by its description alone, as another program would. */

/** The file, as far as it is needed. */
export interface CurveFile {
  format: string;
  version: number;
  joints: string[];
  keys: { time: number; pose?: string; beat?: number; values: number[] }[];
  intervals: { shares: number[]; knots: number[][]; tension: number[]; continuity: number[]; bias: number[] }[];
}

/** All channels at a time inside the dance, quaternions as they come out of their curves. */
export function evaluate({ keys, intervals }: CurveFile, time: number): number[] {
  const knots = keys.flatMap((key, k) => {
    const after = intervals[k] as CurveFile['intervals'][number] | undefined;
    const own = { time: key.time, values: key.values, shapes: [intervals[k - 1], after].filter((each) => each) };
    if (!after) return [own];
    const inner = after.shares.map((share, n) => ({
      time: key.time + share * (keys[k + 1].time - key.time),
      values: after.knots[n],
      shapes: [after],
    }));
    return [own, ...inner];
  });
  const i = Math.max(
    0,
    knots.findLastIndex((knot, n) => n < knots.length - 1 && knot.time <= time),
  );
  return keys[0].values.map((_, channel) => {
    const velocity = (at: number, side: 1 | -1): number => {
      const { shapes } = knots[at];
      const mean = (name: 'tension' | 'continuity' | 'bias') =>
        shapes.reduce((sum, shape) => sum + shape![name][channel], 0) / shapes.length;
      const [t, c, s] = [mean('tension'), mean('continuity') * side, mean('bias')];
      const [before, here, after] = [knots[at - 1], knots[at], knots[at + 1]];
      const way = (a: typeof here, b: typeof here) => b.values[channel] - a.values[channel];
      if (!before) return ((1 - t) * way(here, after)) / (after.time - here.time);
      if (!after) return ((1 - t) * way(before, here)) / (here.time - before.time);
      const both = (1 + c) * (1 + s) * way(before, here) + (1 - c) * (1 - s) * way(here, after);
      return ((1 - t) * both) / (after.time - before.time);
    };
    const span = knots[i + 1].time - knots[i].time;
    const u = (time - knots[i].time) / span;
    const [p, q] = [knots[i].values[channel], knots[i + 1].values[channel]];
    const [m, n] = [velocity(i, 1) * span, velocity(i + 1, -1) * span];
    return (
      (2 * u ** 3 - 3 * u ** 2 + 1) * p +
      (u ** 3 - 2 * u ** 2 + u) * m +
      (3 * u ** 2 - 2 * u ** 3) * q +
      (u ** 3 - u ** 2) * n
    );
  });
}
