/** Where the trade-off plot's points lie, and which strength a pointer means: pure geometry. */
import { tradeOffAt, type TradeOffPoint } from '../../core/report-curves';

/** The plot's drawing area, SVG units. */
export const PLOT = { width: 288, height: 150, left: 14, right: 14, top: 14, bottom: 18 } as const;
/** The jerk axis spans at least this share of its middle, so that a flat curve looks flat. */
const MIN_SPAN = 0.2;

/** Axes of one plot. */
export interface Axes {
  /** Largest consistency error. */
  error: number;
  /** Lowest and highest jerk. */
  jerk: readonly [number, number];
}

/** Axes that hold all points; the jerk axis never blows a small difference up. */
export function axesOf(points: readonly TradeOffPoint[]): Axes {
  const jerks = points.map((point) => point.jerk);
  const [low, high] = [Math.min(...jerks), Math.max(...jerks)];
  const middle = (low + high) / 2;
  const half = Math.max((high - low) / 2, (middle * MIN_SPAN) / 2, 1e-6);
  return { error: Math.max(1e-6, ...points.map((point) => point.error)), jerk: [middle - half, middle + half] };
}

/** A point on the plot: exact poses on the left, smooth motion below. The square root gives small errors room. */
export function place({ error, jerk }: Pick<TradeOffPoint, 'error' | 'jerk'>, axes: Axes): { x: number; y: number } {
  const across = Math.sqrt(Math.max(0, error) / axes.error);
  const up = (jerk - axes.jerk[0]) / (axes.jerk[1] - axes.jerk[0]);
  return {
    x: PLOT.left + across * (PLOT.width - PLOT.left - PLOT.right),
    y: PLOT.top + (1 - up) * (PLOT.height - PLOT.top - PLOT.bottom),
  };
}

/** The strength whose point on the curve is nearest to a place on the plot, in whole percents. */
export function strengthNear(points: readonly TradeOffPoint[], axes: Axes, x: number, y: number): number {
  let best = 1;
  let least = Infinity;
  for (let percent = 0; percent <= 100; percent++) {
    const point = tradeOffAt(points, percent / 100);
    if (!point) break;
    const at = place(point, axes);
    const distance = (at.x - x) ** 2 + (at.y - y) ** 2;
    if (distance < least) [best, least] = [percent / 100, distance];
  }
  return best;
}
