/** The parts of a project document, each checked on its own so that one damaged part does not cost the others. */
import * as v from 'valibot';
import { FIGURE_COLOURS, FIGURE_STYLES } from './figure-look';
import spec from './spec.json';

/** Numbers in a pose: three per joint. */
export const POSE_SIZE = spec.skeleton.joints.length * 3;
/** Two full turns; a larger number is almost surely degrees. */
const MAX_RADIANS = 4 * Math.PI;
const MAX_SEED = 2 ** 31 - 1;
/** More takes of one range than this is no project of a person. */
export const MAX_TAKES = 100;

/** A dial: 0..1. */
export const unit = v.pipe(v.number(), v.minValue(0), v.maxValue(1));
const seconds = v.pipe(v.number(), v.finite(), v.minValue(0));
/** A pose: 24 x 3 axis-angle, radians. */
export const rotationsSchema = v.pipe(
  v.array(v.pipe(v.number('must be a number'), v.finite('must be a finite number'))),
  v.length(POSE_SIZE, `must hold ${POSE_SIZE} numbers (24 joints x 3, axis-angle in radians)`),
  v.check(
    (list) => list.every((value) => Math.abs(value) <= MAX_RADIANS),
    'looks like degrees: give axis-angle in radians',
  ),
);
/** A key pose. */
export const keyPoseSchema = v.object({
  id: v.pipe(v.string(), v.nonEmpty(), v.maxLength(64)),
  time: seconds,
  rotations: rotationsSchema,
  name: v.optional(v.pipe(v.string(), v.maxLength(200))),
  locked: v.optional(v.literal(true)),
  strength: v.optional(unit),
  suggested: v.optional(v.literal(true)),
});
/** A beat grid, its order unchecked. */
export const gridSchema = v.object({
  tempo: v.pipe(v.number(), v.finite(), v.minValue(20), v.maxValue(400)),
  beatsPerBar: v.picklist([3, 4]),
  beats: v.pipe(v.array(seconds), v.maxLength(100_000)),
  downbeats: v.pipe(v.array(seconds), v.maxLength(100_000)),
});
/** The reference of a song. */
export const songSchema = v.object({
  name: v.pipe(v.string(), v.maxLength(500)),
  hash: v.pipe(v.string(), v.maxLength(128)),
  duration: seconds,
  url: v.optional(v.pipe(v.string(), v.maxLength(2000))),
});
/** Each dial by its name. */
export const dialSchemas = {
  keyStrength: unit,
  variation: unit,
  seed: v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(MAX_SEED)),
  seedClip: v.pipe(v.string(), v.maxLength(100)),
};
const range = { start: seconds, end: seconds };
const ordered = (value: { start: number; end: number }) => value.end > value.start;
const place = v.pipe(v.number(), v.finite(), v.minValue(-1000), v.maxValue(1000));
const id = v.pipe(v.string(), v.nonEmpty(), v.maxLength(64));
/** A stretch of a song. */
export const timeRangeSchema = v.pipe(v.object(range), v.check(ordered));
/** A range with its takes. */
export const takeRangeSchema = v.pipe(
  v.object({
    ...range,
    id,
    takes: v.pipe(
      v.array(v.object({ id, seed: dialSchemas.seed, variation: unit })),
      v.minLength(1),
      v.maxLength(MAX_TAKES),
    ),
    chosen: v.nullable(id),
  }),
  v.check((value) => ordered(value)),
  v.check(({ takes }) => new Set(takes.map((take) => take.id)).size === takes.length),
  v.check(({ chosen, takes }) => chosen === null || takes.some((take) => take.id === chosen)),
);
/** A camera's place and what it looks at. */
export const cameraSchema = v.object({
  follows: v.boolean(),
  position: v.tuple([place, place, place]),
  target: v.tuple([place, place, place]),
});
/** A starting clip: as many poses and places as its beats and rate say. */
export const seedClipSchema = v.pipe(
  v.object({
    id: v.pipe(v.string(), v.regex(/^own-[0-9a-f]{1,40}$/)),
    name: v.pipe(v.string(), v.maxLength(100)),
    description: v.pipe(v.string(), v.maxLength(300)),
    beats: v.pipe(v.number(), v.integer(), v.minValue(1), v.maxValue(32)),
    rate: v.pipe(v.number(), v.integer(), v.minValue(1), v.maxValue(16)),
    poses: v.pipe(v.array(rotationsSchema), v.maxLength(512)),
    root: v.pipe(v.array(v.tuple([place, place, place])), v.maxLength(512)),
  }),
  v.check(({ beats, rate, poses, root }) => poses.length === beats * rate && root.length === beats * rate),
);
/** What our own figure wears. */
export const lookSchema = v.object({
  style: v.picklist(FIGURE_STYLES),
  colours: v.picklist(FIGURE_COLOURS.map(({ id }) => id)),
});
/** What makes a dance. */
export const engineSchema = v.picklist(['light', 'curves']);
const anchor = v.union([id, v.pipe(v.number(), v.minValue(-100_000), v.maxValue(100_000))]);
const signed = v.optional(v.pipe(v.number(), v.minValue(-1), v.maxValue(1)));
const amount = v.pipe(v.number(), v.minValue(-100), v.maxValue(100));
const triple = v.tuple([amount, amount, amount]);
/** A change to one curve; turns in radians, ways in metres. */
export const curveEditSchema = v.object({
  from: anchor,
  to: anchor,
  track: v.picklist(['root', ...spec.skeleton.joints]),
  knots: v.optional(v.tuple([triple, triple])),
  tension: signed,
  continuity: signed,
  bias: signed,
});
