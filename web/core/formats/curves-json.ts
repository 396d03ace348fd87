/**
 * A dance of curves as JSON, for programs that draw Kochanek-Bartels curves themselves. Version 1:
 * ```
 * { "format": "posebeat-curves", "version": 1,
 *   "duration": 12.5,                       seconds; before the first and after the last key the figure holds still
 *   "joints": ["pelvis", ...], "parents": [-1, ...], "offsets": [[0, 0, 0], ...],   rest T-pose, metres from the parent
 *   "channels": ["root.x", "root.y", "root.z", "pelvis.x", "pelvis.y", "pelvis.z", "pelvis.w", ...],   99: root in metres, unit quaternions
 *   "keys": [{"time": 0.5, "pose": "k1" or "beat": 4, "values": [99 numbers]}, ...],   ascending; a key pose of the visitor, or one on a beat
 *   "intervals": [{"shares": [0.333, 0.667],   one less than keys: where the two inner knots are between its two keys
 *     "knots": [[99 numbers], [99 numbers]], "tension": [99], "continuity": [99], "bias": [99]}, ...],
 *   "origin": {"motionHash", "frames", ...} }   optional; what the dance was made from (`motion-origin.ts`)
 * ```
 * With p the knot, a and b the ways from the knot before and to the knot after (over both keys and inner knots), h the time from the knot
 * before to the knot after, and t, c, s tension, continuity and bias, a channel arrives at p with the velocity
 * ((1-t)(1-c)(1+s) a + (1-t)(1+c)(1-s) b) / h and leaves it with ((1-t)(1+c)(1+s) a + (1-t)(1-c)(1-s) b) / h. At a key between two
 * intervals t, c, s are the mean of both. At the ends of the dance the velocity is (1-t) times that of the straight way. In between runs
 * the cubic Hermite curve; quaternions are made unit after it.
 */
import * as v from 'valibot';
import { CHANNELS, emptyCurves, INNER_KNOTS, SHAPE_SIZE, type CurveAnchor, type CurveDance } from '../curves';
import { SHAPE_NAMES } from '../curves-edit';
import { JOINT_COUNT, JOINTS, OFFSETS, PARENTS } from '../skeleton';
import type { MotionOrigin } from './motion-origin';

const VERSION = 1;
const MAX_KEYS = 100_000;
const DIGITS = 6;

const row = v.custom<number[]>(
  (value) => Array.isArray(value) && value.length === CHANNELS && value.every((each) => Number.isFinite(each)),
);
const signed = v.pipe(
  row,
  v.check((values) => values.every((value) => Math.abs(value) <= 1)),
);
const share = v.pipe(v.number(), v.gtValue(0), v.ltValue(1));
const key = v.object({
  time: v.pipe(v.number(), v.finite(), v.minValue(0)),
  pose: v.optional(v.pipe(v.string(), v.nonEmpty(), v.maxLength(64))),
  beat: v.optional(v.pipe(v.number(), v.finite())),
  values: row,
});
const interval = v.object({
  shares: v.pipe(
    v.tuple([share, share]),
    v.check(([a, b]) => a < b),
  ),
  knots: v.tuple([row, row]),
  tension: signed,
  continuity: signed,
  bias: signed,
});
const schema = v.object({
  format: v.literal('posebeat-curves'),
  version: v.pipe(v.number(), v.integer(), v.minValue(1)),
  duration: v.pipe(v.number(), v.finite(), v.minValue(0)),
  joints: v.array(v.string()),
  keys: v.pipe(v.array(key), v.minLength(1), v.maxLength(MAX_KEYS)),
  intervals: v.pipe(v.array(interval), v.maxLength(MAX_KEYS)),
});

/** The names of the 99 channels in their order. */
export function channelNames(): string[] {
  const parts = (name: string, axes: string) => [...axes].map((axis) => `${name}.${axis}`);
  return [...parts('root', 'xyz'), ...JOINTS.flatMap((joint) => parts(joint, 'xyzw'))];
}

const short = (value: number) => Number(value.toFixed(DIGITS)) + 0;

/**
 * Writes the file; numbers have six digits after the point.
 * @throws Error when there is no key pose
 */
export function writeCurvesJson(curves: CurveDance, origin?: MotionOrigin | null): string {
  const { duration, times, anchors, keys, inner, shares, shape } = curves;
  if (times.length === 0) throw new Error('The curves have no key pose: generate the dance again.');
  const line = (values: Float32Array, at: number) =>
    Array.from(values.subarray(at * CHANNELS, (at + 1) * CHANNELS), short);
  const anchorOf = (anchor: CurveAnchor) => (typeof anchor === 'string' ? { pose: anchor } : { beat: anchor });
  const keyLines = Array.from(times, (time, k) =>
    JSON.stringify({ time: short(time), ...anchorOf(anchors[k]), values: line(keys, k) }),
  );
  const intervalLines = Array.from({ length: times.length - 1 }, (_, k) =>
    JSON.stringify({
      shares: Array.from(shares.subarray(k * INNER_KNOTS, (k + 1) * INNER_KNOTS), short),
      knots: [0, 1].map((n) => line(inner, k * INNER_KNOTS + n)),
      ...Object.fromEntries(SHAPE_NAMES.map((name, n) => [name, line(shape, k * SHAPE_SIZE + n)])),
    }),
  );
  const head = {
    format: 'posebeat-curves',
    version: VERSION,
    duration: short(duration),
    joints: JOINTS,
    parents: PARENTS,
    offsets: OFFSETS,
    channels: channelNames(),
    ...(origin ? { origin } : {}),
  };
  const members = Object.entries(head).map(([name, value]) => `"${name}": ${JSON.stringify(value)}`);
  const list = (lines: string[]) => (lines.length > 0 ? `[\n${lines.join(',\n')}\n]` : '[]');
  return `{\n${[...members, `"keys": ${list(keyLines)}`, `"intervals": ${list(intervalLines)}`].join(',\n')}\n}\n`;
}

/**
 * Reads the file.
 * @throws Error with a sentence for the visitor when it is none, damaged, of a newer version or of another skeleton
 */
export function readCurvesJson(text: string): CurveDance {
  let raw: unknown;
  try {
    raw = JSON.parse(text);
  } catch {
    throw new Error('This file of curves is no JSON: it is damaged or cut off.');
  }
  const parsed = v.safeParse(schema, raw);
  if (!parsed.success) {
    const where = v.getDotPath(parsed.issues[0]) ?? 'the file';
    throw new Error(`This is no file of curves of Posebeat, or it is damaged: “${where}” is wrong.`);
  }
  const { version, duration, joints, keys, intervals } = parsed.output;
  if (version > VERSION) throw new Error('This file of curves was made by a newer Posebeat: reload the page.');
  if (joints.length !== JOINT_COUNT || joints.some((name, i) => name !== JOINTS[i])) {
    throw new Error('These curves are of another skeleton: 24 joints of SMPL are understood.');
  }
  if (intervals.length !== keys.length - 1) {
    throw new Error(`This file should have ${keys.length - 1} intervals between its keys but has ${intervals.length}.`);
  }
  const times = keys.map(({ time }) => time);
  if (times.some((time, k) => k > 0 && time <= times[k - 1]))
    throw new Error('The keys of these curves are not in order.');
  const made = emptyCurves(
    times,
    duration,
    keys.map(({ pose, beat }, k) => pose ?? beat ?? k),
  );
  keys.forEach(({ values }, k) => made.keys.set(values, k * CHANNELS));
  intervals.forEach((each, k) => {
    made.shares.set(each.shares, k * INNER_KNOTS);
    each.knots.forEach((values, n) => made.inner.set(values, (k * INNER_KNOTS + n) * CHANNELS));
    SHAPE_NAMES.forEach((name, n) => made.shape.set(each[name], (k * SHAPE_SIZE + n) * CHANNELS));
  });
  return made;
}
