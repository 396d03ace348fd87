/** What a dance is asked for with, and what it cost. */
import type { EngineName } from '../core/document';
import type { Motion } from '../core/types';
import type { Backend } from '../workers/protocol';
import { motionHash } from './hash';
import type { Dance } from './state';

/** Settings of one dance; what is left out comes from the document's dials. */
export interface GenerateCall {
  keyStrength?: number;
  variation?: number;
  seed?: number;
  /** Seconds; only this stretch is made anew. */
  range?: { start: number; end: number };
  /** Another one than the project's becomes the project's. */
  engine?: EngineName;
  backend?: Backend;
}

/** What a dance cost. */
export interface GenerateSummary {
  backend: Backend;
  model: string;
  frames: number;
  milliseconds: number;
  windows: number;
  /** SHA-256 of the dance (hash.ts): the same one elsewhere has the same. */
  motionHash: string;
}

/** Throws where a call cannot be followed; the message says what to write instead. */
export function checkCall(call: GenerateCall): void {
  if (call.engine !== undefined && call.engine !== 'light' && call.engine !== 'curves') {
    throw new Error(`There is no engine "${String(call.engine)}": use "light" or "curves".`);
  }
  if (call.backend !== undefined && call.backend !== 'webgpu' && call.backend !== 'wasm') {
    throw new Error(`There is no backend "${String(call.backend)}": use "webgpu" or "wasm".`);
  }
  for (const name of ['keyStrength', 'variation'] as const) {
    const value = call[name];
    if (value !== undefined && !(typeof value === 'number' && value >= 0 && value <= 1)) {
      throw new Error(`${name} must be a number from 0 to 1.`);
    }
  }
  if (call.seed !== undefined && !(Number.isInteger(call.seed) && call.seed >= 0 && call.seed < 2 ** 31)) {
    throw new Error('seed must be a whole number from 0 to 2147483647.');
  }
}

/** True when a dance made with these settings is what the document's own dials stand for. */
export function meansDials(used: Settings, dials: Settings): boolean {
  return used.keyStrength === dials.keyStrength && used.variation === dials.variation && used.seed === dials.seed;
}

type Settings = Required<Pick<GenerateCall, 'keyStrength' | 'variation' | 'seed'>>;

/** What the call of the automation API gives back. */
export async function summary(motion: Motion, result: Dance['result']): Promise<GenerateSummary> {
  const { backend, model, milliseconds, windows } = result!;
  return { backend, model, frames: motion.frames, milliseconds, windows, motionHash: await motionHash(motion) };
}

/** The members that are not undefined. */
export function defined(call: GenerateCall): GenerateCall {
  return Object.fromEntries(Object.entries(call).filter(([, value]) => value !== undefined));
}
