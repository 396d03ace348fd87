/** Curves through samples and the small shapes that fades and bumps are made of. */

/** 0 at t <= 0, 1 at t >= 1, with zero slope and curvature at both ends (Perlin's quintic: no step in acceleration). */
export function smoothstep(t: number): number {
  const x = Math.min(1, Math.max(0, t));
  return x * x * x * (x * (6 * x - 15) + 10);
}

/** 1 at 0, exactly 0 from |x| = 1 on, twice continuously differentiable: (1 - x^2)^3. */
export function bump(x: number): number {
  const rest = 1 - x * x;
  return rest > 0 ? rest * rest * rest : 0;
}

/** Cubic Hermite value between p0 and p1 with slopes m0 and m1 per unit of t. */
export function hermite(p0: number, m0: number, p1: number, m1: number, t: number): number {
  const t2 = t * t;
  const t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * p0 + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * p1 + (t3 - t2) * m1;
}

/** Weights of the four samples around a Catmull-Rom segment at t in 0..1. */
export function catmullRomWeights(t: number): [number, number, number, number] {
  const t2 = t * t;
  const t3 = t2 * t;
  return [(2 * t2 - t3 - t) / 2, (3 * t3 - 5 * t2 + 2) / 2, (4 * t2 - 3 * t3 + t) / 2, (t3 - t2) / 2];
}

/** Angle in -pi..pi that is the same direction. */
export function wrapAngle(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}

/** Gaussian smoothing along time of `channels` interleaved series; the ends are held. `sigma` in samples. */
export function gaussianSmooth(series: Float64Array, channels: number, sigma: number): Float64Array {
  const radius = Math.max(1, Math.ceil(3 * sigma));
  const kernel = Float64Array.from({ length: 2 * radius + 1 }, (_, i) => Math.exp(-(((i - radius) / sigma) ** 2) / 2));
  const total = kernel.reduce((sum, k) => sum + k, 0);
  const count = series.length / channels;
  const out = new Float64Array(series.length);
  for (let i = 0; i < count; i++) {
    for (let k = -radius; k <= radius; k++) {
      const source = Math.min(count - 1, Math.max(0, i + k)) * channels;
      const weight = kernel[k + radius] / total;
      for (let c = 0; c < channels; c++) out[i * channels + c] += weight * series[source + c];
    }
  }
  return out;
}

/**
 * @param values any order
 * @param share 0..1
 * @returns the value below which that share of the values lies (linear interpolation); 0 for none
 */
export function percentile(values: ArrayLike<number>, share: number): number {
  const sorted = Float64Array.from(values).sort();
  if (sorted.length === 0) return 0;
  const position = share * (sorted.length - 1);
  const below = Math.floor(position);
  const above = Math.min(sorted.length - 1, below + 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (position - below);
}
