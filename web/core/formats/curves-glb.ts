/** A dance of curves as a GLB animation: cubic splines with keys at the key poses and the inner knots, so that they stay editable. */
import { channelsOf } from '../curves-edit';
import { allTracks, knotTimes, knotTrack, type CurveDance, type CurveTrack, type KnotTrack } from '../curves';
import { hermite } from '../interpolate';
import { REST } from '../rest';
import { JOINT_COUNT, PARENTS } from '../skeleton';
import { writeGlb, type GlbFigure, type GlbSampler } from './glb-write';
import type { MotionOrigin } from './motion-origin';

/**
 * Blender's importer keeps the keys and drops the tangents: it lays its own smooth spline through the keys. Where that would carry a
 * joint farther off than this, metres, a key more is put on the curve. Errors of a chain of joints add up, so it is well below a
 * centimetre.
 */
const LEEWAY = 0.004;
/** Rounds of looking again after keys were put in. */
const ROUNDS = 4;
/** Where between two keys it is looked, shares of the way. */
const PLACES = [0.25, 0.5, 0.75];
/** What hangs on a joint that has no other below it, metres. */
const LEAF = 0.1;

/**
 * One CUBICSPLINE sampler for the place of the pelvis and one for every joint's rotation. A Kochanek-Bartels curve is a cubic Hermite
 * curve, and so is glTF's, with tangents per second (specification 2.0, appendix C), so nothing is lost. Keys are at the key poses and
 * the inner knots, and, few, on the curve between them where programs that drop tangents would bend it (see {@link LEEWAY}).
 * @throws Error when there are no two key poses to draw curves between
 */
export function curveSamplers(curves: CurveDance): GlbSampler[] {
  if (curves.times.length < 2) throw new Error('Curves need two key poses at least: place another one.');
  const times = knotTimes(curves);
  // Joints without further keys share one array: it is written once.
  const shared = Float32Array.from(times);
  return allTracks().map((track) => {
    const { first, count } = channelsOf(track);
    const knots = Array.from({ length: count }, (_, c) => knotTrack(curves, first + c, times));
    const channels = withFurtherKeys(knots, track);
    const keys = channels[0].times;
    const values = new Float32Array(keys.length * count * 3);
    channels.forEach(({ arriving, values: numbers, leaving }, c) => {
      for (let i = 0; i < keys.length; i++) {
        const at = i * count * 3 + c;
        values[at] = arriving[i];
        values[at + count] = numbers[i];
        values[at + count * 2] = leaving[i];
      }
    });
    return {
      joint: track === 'root' ? 0 : track,
      path: track === 'root' ? 'translation' : 'rotation',
      times: keys.length === times.length ? shared : Float32Array.from(keys),
      values,
      interpolation: 'CUBICSPLINE',
    };
  });
}

/** What a file of curves may hold beside them. */
export interface CurvesGlbExtras {
  /** Where the dance comes from. */
  origin?: MotionOrigin | null;
  /** Missing: the skeleton alone. */
  figure?: GlbFigure;
  /** How the figure's helper bones move. */
  helpers?: readonly GlbSampler[];
}

/**
 * A GLB file of the curves.
 * @param name of the animation
 */
export function writeCurvesGlb(
  curves: CurveDance,
  name: string,
  { origin, figure, helpers = [] }: CurvesGlbExtras = {},
): Uint8Array<ArrayBuffer> {
  return writeGlb({
    name,
    samplers: [...curveSamplers(curves), ...helpers],
    ...(figure ? { figure } : {}),
    ...(origin ? { extras: { posebeat: origin } } : {}),
  });
}

/** Puts keys on the curve of a track, in the middle between two others, until a spline through all of them is near it everywhere. */
function withFurtherKeys(channels: KnotTrack[], track: CurveTrack): KnotTrack[] {
  // Half the angle is what a quaternion's numbers tell.
  const scale = track === 'root' ? 1 : 2 * LEVERS[track];
  for (let round = 0; round < ROUNDS; round++) {
    const slopes = channels.map(({ times, values }) => smoothSlopes(times, values));
    const { times } = channels[0];
    const far = Array.from({ length: times.length - 1 }, (_, i) => {
      const span = times[i + 1] - times[i];
      return PLACES.some((s) => {
        const off = channels.map(({ leaving, arriving }, c) => {
          const [a, b] = [(leaving[i] - slopes[c][i]) * span, (arriving[i + 1] - slopes[c][i + 1]) * span];
          return hermite(0, a, 0, b, s);
        });
        return Math.hypot(...off) * scale > LEEWAY;
      });
    });
    if (!far.includes(true)) break;
    channels = split(channels, far);
  }
  return channels;
}

/** Adds a key in the middle of the marked stretches; the curve stays, and rotations' keys are unit quaternions. */
function split(channels: readonly KnotTrack[], marked: readonly boolean[]): KnotTrack[] {
  const made = channels.map(() => [[], [], [], []] as [number[], number[], number[], number[]]);
  const put = (c: number, time: number, value: number, arriving: number, leaving: number) =>
    [time, value, arriving, leaving].forEach((number, n) => made[c][n].push(number));
  const { times } = channels[0];
  for (let i = 0; i < times.length; i++) {
    channels.forEach(({ values, arriving, leaving }, c) => put(c, times[i], values[i], arriving[i], leaving[i]));
    if (!marked[i]) continue;
    const span = times[i + 1] - times[i];
    const ends = channels.map(({ values, arriving, leaving }) => [
      values[i],
      leaving[i] * span,
      values[i + 1],
      arriving[i + 1] * span,
    ]);
    const middle = ends.map(([p0, m0, p1, m1]) => hermite(p0, m0, p1, m1, 0.5));
    const length = channels.length === 4 ? Math.hypot(...middle) : 1;
    ends.forEach(([p0, m0, p1, m1], c) => {
      const slope = (1.5 * (p1 - p0) - 0.25 * (m0 + m1)) / span / length;
      put(c, times[i] + span / 2, middle[c] / length, slope, slope);
    });
  }
  return made.map(([at, values, arriving, leaving]) => ({
    times: Float64Array.from(at),
    values: Float64Array.from(values),
    arriving: Float64Array.from(arriving),
    leaving: Float64Array.from(leaving),
  }));
}

/**
 * Slopes of the spline that Blender lays through keys without tangents (handles "Auto", smoothed by "Continuous Acceleration"): the cubic
 * spline whose second derivative is continuous, level at both ends.
 */
export function smoothSlopes(times: Float64Array, values: Float64Array): Float64Array {
  const n = times.length;
  const slopes = new Float64Array(n);
  // Thomas' algorithm on the n - 2 inner equations.
  const upper = new Float64Array(n);
  for (let i = 1; i < n - 1; i++) {
    const [a, b] = [times[i] - times[i - 1], times[i + 1] - times[i]];
    const right = 3 * ((b * (values[i] - values[i - 1])) / a + (a * (values[i + 1] - values[i])) / b);
    const pivot = 2 * (a + b) - b * upper[i - 1];
    upper[i] = a / pivot;
    slopes[i] = (right - b * slopes[i - 1]) / pivot;
  }
  for (let i = n - 3; i > 0; i--) slopes[i] -= upper[i] * slopes[i + 1];
  return slopes;
}

/** How far the farthest joint is that a joint carries, metres. */
const LEVERS = Array.from({ length: JOINT_COUNT }, (_, joint) => {
  let most = LEAF;
  for (let other = joint + 1; other < JOINT_COUNT; other++) {
    let above = other;
    while (above > joint) above = PARENTS[above];
    if (above !== joint) continue;
    most = Math.max(most, Math.hypot(...[0, 1, 2].map((k) => REST[other * 3 + k] - REST[joint * 3 + k])));
  }
  return most;
});
