/**
 * Where a motion file comes from, in the file itself, as far as its format has room: GLB under `asset.extras.posebeat`, npz as the text
 * `posebeat` (JSON), JSON and curves as the member `origin`. BVH and FBX have no place for it that other programs leave alone.
 */
import * as v from 'valibot';

const text = (most: number) => v.pipe(v.string(), v.maxLength(most));
const amount = v.pipe(v.number(), v.minValue(0), v.maxValue(1));
const count = v.pipe(v.number(), v.integer(), v.minValue(0));

/** For files that are read. */
export const originSchema = v.object({
  /** Of the whole dance as it was made, whatever part of it is in the file and at which rate: SHA-256 of `motion-quantised.ts`. */
  motionHash: text(128),
  /** How many frames that dance has, and which of them, [from, to), are in the file. */
  frames: count,
  from: count,
  to: count,
  /** SHA-256 of the project's JSON without its camera; an equal one is the same project. */
  projectHash: v.optional(text(128)),
  engine: v.optional(text(50)),
  model: v.optional(text(200)),
  backend: v.optional(text(50)),
  seed: v.optional(count),
  variation: v.optional(amount),
  keyStrength: v.optional(amount),
  seedClip: v.optional(text(100)),
});

/** What a dance was made from, and the hash that tells whether another one is the same. */
export type MotionOrigin = v.InferOutput<typeof originSchema>;
