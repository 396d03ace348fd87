/** Points and directions as three numbers, for what is worked out once; what runs every frame is written out where it runs. */
import type { Numbers } from './rotation';

export type Vector = [number, number, number];

export const pointOf = (values: Numbers, index: number): Vector => [
  values[index * 3],
  values[index * 3 + 1],
  values[index * 3 + 2],
];
export const quaternionOf = (values: Numbers, index: number): number[] =>
  [0, 1, 2, 3].map((k) => values[index * 4 + k]);
export const minus = (a: Numbers, b: Numbers): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const mean = (a: Numbers, b: Numbers): Vector => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2];
export const dot = (a: Numbers, b: Numbers): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const norm = (a: Numbers): number => Math.hypot(a[0], a[1], a[2]);
export const distance = (a: Numbers, b: Numbers): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
export const cross = (a: Numbers, b: Numbers): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
