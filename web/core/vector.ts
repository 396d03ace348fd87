/** Points and directions as three numbers, for what is worked out once; what runs every frame is written out where it runs. */
import type { Numbers } from './rotation';

/** x y z; metres where it is a place, without a unit where it is a direction. */
export type Vector = [number, number, number];

/** Point number `index` of n x 3 numbers. */
export const pointOf = (values: Numbers, index: number): Vector => [
  values[index * 3],
  values[index * 3 + 1],
  values[index * 3 + 2],
];
/** Quaternion (x y z w) number `index` of n x 4 numbers. */
export const quaternionOf = (values: Numbers, index: number): number[] =>
  [0, 1, 2, 3].map((k) => values[index * 4 + k]);
/** a - b: the way from b to a. */
export const minus = (a: Numbers, b: Numbers): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** The point half-way. */
export const mean = (a: Numbers, b: Numbers): Vector => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2];
/** Scalar product of the first three numbers. */
export const dot = (a: Numbers, b: Numbers): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** Length of a vector. */
export const norm = (a: Numbers): number => Math.hypot(a[0], a[1], a[2]);
/** How far two points are apart. */
export const distance = (a: Numbers, b: Numbers): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
/** Cross product, right-handed. */
export const cross = (a: Numbers, b: Numbers): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
