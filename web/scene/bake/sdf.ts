/** Signed distance shapes for modelling the figure: negative inside, metres, blended by smooth unions (Quilez, "smooth minimum"). */

export type Vector = readonly [number, number, number];
/** Signed distance (approximate away from the surface) of a point. */
export type Shape = (x: number, y: number, z: number) => number;

/** Cross-section of a loft: half-widths along its two side axes, metres, at a fraction `t` of its length. */
export interface Ring {
  t: number;
  u: number;
  v: number;
  /** Shift of the section's centre along the side axes, metres. */
  du?: number;
  dv?: number;
}

/** Smooth union; surfaces closer than about `k` metres flow into each other. */
export function blend(k: number, ...shapes: Shape[]): Shape {
  return (x, y, z) => {
    let a = shapes[0](x, y, z);
    for (let i = 1; i < shapes.length; i++) a = smoothMinimum(a, shapes[i](x, y, z), k);
    return a;
  };
}

/** Smooth intersection: what lies in every shape, with edges rounded over about `k` metres. */
export function common(k: number, ...shapes: Shape[]): Shape {
  return (x, y, z) => {
    let a = shapes[0](x, y, z);
    for (let i = 1; i < shapes.length; i++) a = -smoothMinimum(-a, -shapes[i](x, y, z), k);
    return a;
  };
}

function smoothMinimum(a: number, b: number, k: number): number {
  const h = Math.max(k - Math.abs(a - b), 0) / k;
  return Math.min(a, b) - h * h * k * 0.25;
}

/** The shape grown by `distance` metres. */
export function grow(shape: Shape, distance: number): Shape {
  return (x, y, z) => shape(x, y, z) - distance;
}

/** A left-side shape together with its mirror image, flowing into each other at the middle. */
export function both(shape: Shape, k: number): Shape {
  return (x, y, z) => smoothMinimum(shape(x, y, z), shape(-x, y, z), k);
}

/** Half-space of the points below a plane: dot(point - at, normal) <= 0. `normal` need not be unit length. */
export function below(at: Vector, normal: Vector): Shape {
  const length = Math.hypot(...normal);
  return (x, y, z) => ((x - at[0]) * normal[0] + (y - at[1]) * normal[1] + (z - at[2]) * normal[2]) / length;
}

/** Axis-aligned ellipsoid. */
export function ellipsoid(centre: Vector, radii: Vector): Shape {
  return (x, y, z) => {
    const a = (x - centre[0]) / radii[0];
    const b = (y - centre[1]) / radii[1];
    const c = (z - centre[2]) / radii[2];
    const k0 = Math.hypot(a, b, c);
    const k1 = Math.hypot(a / radii[0], b / radii[1], c / radii[2]);
    return k1 < 1e-9 ? -Math.min(...radii) : (k0 * (k0 - 1)) / k1;
  };
}

/** Cone from a to b with round ends. */
export function limb(a: Vector, b: Vector, ra: number, rb: number): Shape {
  const axis = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const length2 = axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2;
  return (x, y, z) => {
    const px = x - a[0];
    const py = y - a[1];
    const pz = z - a[2];
    const t = Math.min(Math.max((px * axis[0] + py * axis[1] + pz * axis[2]) / length2, 0), 1);
    return Math.hypot(px - t * axis[0], py - t * axis[1], pz - t * axis[2]) - (ra + t * (rb - ra));
  };
}

/**
 * A tube with changing elliptic sections, closed by half ellipsoids.
 * @param side direction of the sections' u axis; made perpendicular to the tube
 * @param rings sections in ascending t; between them the sizes follow a cubic spline
 * @param caps length of the two rounded ends, metres
 * @param power 2 for ellipses, larger for boxier sections
 */
export function loft(from: Vector, to: Vector, side: Vector, rings: Ring[], caps: [number, number], power = 2): Shape {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  const w: Vector = [(to[0] - from[0]) / length, (to[1] - from[1]) / length, (to[2] - from[2]) / length];
  const along = side[0] * w[0] + side[1] * w[1] + side[2] * w[2];
  const flat = [side[0] - along * w[0], side[1] - along * w[1], side[2] - along * w[2]];
  const scale = 1 / Math.hypot(flat[0], flat[1], flat[2]);
  const u = [flat[0] * scale, flat[1] * scale, flat[2] * scale];
  const v = [w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]];
  const [first, last] = [rings[0].t, rings[rings.length - 1].t];
  const curves = [(r: Ring) => r.u, (r: Ring) => r.v, (r: Ring) => r.du ?? 0, (r: Ring) => r.dv ?? 0].map((value) =>
    smoothCurve(
      rings.map((r) => r.t),
      rings.map(value),
    ),
  );
  const widest = Math.max(...rings.map((r) => Math.max(r.u + Math.abs(r.du ?? 0), r.v + Math.abs(r.dv ?? 0))));
  return (x, y, z) => {
    const p = [x - from[0], y - from[1], z - from[2]];
    const t = (p[0] * w[0] + p[1] * w[1] + p[2] * w[2]) / length;
    const clamped = Math.min(Math.max(t, first), last);
    const off = clamped * length;
    // Far away a lower bound will do: nothing blends over more than a few centimetres.
    const far = Math.hypot(p[0] - off * w[0], p[1] - off * w[1], p[2] - off * w[2]) - widest;
    if (far > 0.12) return far;
    const [ru, rv, du, dv] = curves.map((curve) => curve(clamped));
    const cap = t < first ? caps[0] : caps[1];
    const a = (p[0] * u[0] + p[1] * u[1] + p[2] * u[2] - du) / ru;
    const b = (p[0] * v[0] + p[1] * v[1] + p[2] * v[2] - dv) / rv;
    const c = ((t - clamped) * length) / cap;
    const k0 = Math.hypot((Math.abs(a) ** power + Math.abs(b) ** power) ** (1 / power), c);
    const k1 = Math.hypot(a / ru, b / rv, c / cap);
    return k1 < 1e-9 ? -Math.min(ru, rv) : (k0 * (k0 - 1)) / k1;
  };
}

/** Natural cubic spline through (xs, ys): continuous curvature, so highlights run along a limb without a kink. */
function smoothCurve(xs: number[], ys: number[]): (x: number) => number {
  const n = xs.length;
  const h = xs.slice(1).map((x, i) => x - xs[i]);
  const second = new Array<number>(n).fill(0);
  const diagonal = new Array<number>(n).fill(1);
  // Thomas algorithm for the inner knots' second derivatives; the end knots' are zero.
  for (let i = 1; i < n - 1; i++) {
    const right = 6 * ((ys[i + 1] - ys[i]) / h[i] - (ys[i] - ys[i - 1]) / h[i - 1]);
    const below = i > 1 ? h[i - 1] / diagonal[i - 1] : 0;
    diagonal[i] = 2 * (h[i - 1] + h[i]) - below * (i > 1 ? h[i - 1] : 0);
    second[i] = right - below * second[i - 1];
  }
  for (let i = n - 2; i > 0; i--) second[i] = (second[i] - h[i] * second[i + 1]) / diagonal[i];
  return (x) => {
    let i = 0;
    while (i < n - 2 && x > xs[i + 1]) i++;
    const [a, b] = [(xs[i + 1] - x) / h[i], (x - xs[i]) / h[i]];
    return a * ys[i] + b * ys[i + 1] + (((a ** 3 - a) * second[i] + (b ** 3 - b) * second[i + 1]) * h[i] ** 2) / 6;
  };
}
