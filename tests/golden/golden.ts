import { readFileSync } from 'node:fs';
import { expect } from 'vitest';

const file = (name: string) => new URL(name, import.meta.url);

/** A golden JSON file that the Python side wrote (export/golden.py). */
export function golden<T>(name: string): T {
  return JSON.parse(readFileSync(file(`${name}.json`), 'utf8')) as T;
}

/** A golden binary file. */
export function goldenBytes(name: string): Uint8Array<ArrayBuffer> {
  return new Uint8Array(readFileSync(file(name)));
}

/** All numbers agree within a tolerance. */
export function agree(actual: ArrayLike<number>, expected: ArrayLike<number>, tolerance: number): void {
  expect(actual.length).toBe(expected.length);
  let largest = 0;
  for (let i = 0; i < expected.length; i++) {
    const difference = Math.abs(actual[i] - expected[i]);
    largest = Math.max(largest, Number.isNaN(difference) ? Infinity : difference);
  }
  expect(largest).toBeLessThanOrEqual(tolerance);
}
