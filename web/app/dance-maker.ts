/** Makes the dance of a document step by step: the whole, then each range on top; what was made before is taken from the cache. */
import type { FrameRange } from '../core/excerpt';
import { NO_EDITS } from '../core/curves-edit';
import type { UncorrectedDance } from '../core/finish';
import type { Motion, SeedClip } from '../core/types';
import type { DanceRequest } from '../workers/protocol';
import { isAbort, onGrid, type Context } from './context';
import type { DanceCache } from './dance-cache';
import type { DanceResult } from './ports';
import { recipeOf, type DanceInputs, type RangeStep } from './recipe';
import type { Reporter } from './report-client';
import type { Dance } from './state';

/** A dance to be made. */
export interface MakeWish {
  inputs: DanceInputs;
  /** In place of the dials. */
  dials: { keyStrength: number; variation: number; seed: number };
  seedClip: SeedClip;
  /** Takes what was made before from the cache. */
  reuse: boolean;
  /** Called before the first step that needs the network. */
  ready(): Promise<unknown>;
  /** The dance so far (null: what is shown may stay), the share of all steps that is done, the windows run, and the step's range. */
  onProgress(motion: Motion | null, fraction: number, windows: number, range?: FrameRange): void;
  signal: AbortSignal;
}

/** A dance that was made. */
export type MadeDance = Pick<Dance, 'motion' | 'uncorrected' | 'keyStrength' | 'result' | 'curves' | 'curveEdits'>;

/** Makes dances with the engine, the report worker and the cache. */
export function createMaker({ state, services, analysed }: Context, reporter: Reporter, cache: DanceCache) {
  const hash = () => state.song.value?.reference.hash ?? '';

  /** As much of a dance as the cache has, from the bottom up. */
  function known(inputs: DanceInputs) {
    const { ranges } = recipeOf(inputs, state.frames.value);
    const base = cache.base(hash(), inputs);
    if (!base) return null;
    let { uncorrected } = base;
    let done = 0;
    for (const step of ranges) {
      const next = laidOn(inputs, uncorrected, step);
      if (!next) break;
      uncorrected = next;
      done += 1;
    }
    return { uncorrected, result: base.result, left: ranges.slice(done) };
  }

  function laidOn(inputs: DanceInputs, below: UncorrectedDance, step: RangeStep): UncorrectedDance | null {
    const layer = cache.layer(hash(), inputs, below, step);
    return layer && { ...below, layers: [...(below.layers ?? []), layer] };
  }

  /** Finishes a dance that was put together from the cache. */
  async function finished(
    uncorrected: UncorrectedDance,
    inputs: DanceInputs,
    strength: number,
    signal: AbortSignal,
  ): Promise<Motion> {
    for (;;) {
      try {
        const dance = { uncorrected, motion: uncorrected.motion, keyPoses: inputs.keyPoses };
        return (await reporter.finish(dance, { strength, grid: null })).motion;
      } catch (error) {
        // Another wish took the worker: this one asks again, unless nobody wants it any more.
        signal.throwIfAborted();
        if (!isAbort(error)) throw error;
      }
    }
  }

  /**
   * Curves are made in one go, ranges with takes of their own included.
   * @param extra one range more, which the document does not know of
   */
  async function makeCurves(wish: MakeWish, extra?: RangeStep): Promise<MadeDance> {
    const { inputs, dials, seedClip, ready, onProgress, signal } = wish;
    const recipe = recipeOf({ ...inputs, dials: { ...inputs.dials, ...dials } }, state.frames.value);
    await ready();
    const music = onGrid(await analysed(), inputs.grid);
    signal.throwIfAborted();
    const { motion, curves, ...result } = await services.engine.generate(
      {
        ...music,
        frames: state.frames.value,
        keyPoses: [...inputs.keyPoses],
        seedClip,
        otherClips: state.seeds.value,
        ...(recipe.trim ? { trim: recipe.trim } : {}),
        engine: 'curves',
        takes: [...recipe.ranges, ...(extra ? [extra] : [])],
        options: { keyStrength: 1, ...recipe.base, cleanFeet: true },
      },
      (_, fraction, windows) => {
        if (!signal.aborted) onProgress(null, fraction, windows);
      },
      signal,
    );
    signal.throwIfAborted();
    if (!curves) throw new Error('The curves model gave no curves: reload the page.');
    return { motion, curves, curveEdits: NO_EDITS, result };
  }

  async function make(wish: MakeWish): Promise<MadeDance> {
    if (wish.inputs.engine === 'curves') return makeCurves(wish);
    const { inputs, dials, seedClip, reuse, signal } = wish;
    const { keyStrength } = dials;
    const frames = state.frames.value;
    const recipe = recipeOf({ ...inputs, dials: { ...inputs.dials, ...dials } }, frames);
    const lengths = [recipe.trim ? recipe.trim.to - recipe.trim.from : frames];
    for (const { from, to } of recipe.ranges) lengths.push(to - from);
    const total = lengths.reduce((sum, length) => sum + length, 0);

    let music: ReturnType<typeof onGrid> | null = null;
    let windows = 0;
    let milliseconds = 0;
    const run = async (index: number, request: Pick<DanceRequest, 'options'> & Partial<DanceRequest>) => {
      if (!music) {
        await wish.ready();
        music = onGrid(await analysed(), inputs.grid);
        signal.throwIfAborted();
      }
      const before = lengths.slice(0, index).reduce((sum, length) => sum + length, 0);
      const result = await services.engine.generate(
        {
          ...music,
          frames,
          keyPoses: [...inputs.keyPoses],
          seedClip,
          otherClips: state.seeds.value,
          ...(recipe.trim ? { trim: recipe.trim } : {}),
          ...request,
        },
        (motion, fraction, count) => {
          if (signal.aborted) return;
          wish.onProgress(motion, (before + fraction * lengths[index]) / total, windows + count, request.range);
        },
        signal,
      );
      signal.throwIfAborted();
      windows += result.windows;
      milliseconds += result.milliseconds;
      return result;
    };
    const options = (take: { seed: number; variation: number }) => {
      const { seed, variation } = take;
      return { keyStrength, seed, variation, cleanFeet: true };
    };

    const start = reuse ? known(inputs) : null;
    let uncorrected: UncorrectedDance | undefined = start?.uncorrected;
    let motion: Motion | null = null;
    let result: DanceResult | null = null;
    if (!start) {
      result = await run(0, { options: options(recipe.base) });
      ({ uncorrected, motion } = result);
    }
    for (const [i, step] of recipe.ranges.entries()) {
      if (start && i < recipe.ranges.length - start.left.length) continue;
      const layered = reuse && uncorrected ? laidOn(inputs, uncorrected, step) : null;
      if (layered) {
        uncorrected = layered;
        motion = null;
        continue;
      }
      const { from, to } = step;
      const before = lengths.slice(0, i + 1).reduce((sum, length) => sum + length, 0);
      wish.onProgress(motion, before / total, windows, { from, to });
      const below = uncorrected ? { previousUncorrected: uncorrected } : { previous: motion ?? undefined };
      result = await run(i + 1, { options: options(step), range: { from, to }, ...below });
      motion = result.motion;
      const layer = result.uncorrected?.layers?.at(-1);
      // The parts below stay the ones at hand, so that all takes share them in memory.
      uncorrected = layer && uncorrected && { ...uncorrected, layers: [...(uncorrected.layers ?? []), layer] };
    }
    motion ??= await finished(uncorrected!, inputs, keyStrength, signal);
    const rest = result ? { ...withoutDance(result), windows, milliseconds } : (start?.result ?? null);
    return { motion, uncorrected, keyStrength, result: rest };
  }

  return {
    make,
    makeCurves,
    /** True when the cache has all that a dance is made of. */
    isKnown: (inputs: DanceInputs) => known(inputs)?.left.length === 0,
  };
}

function withoutDance({ backend, model, windows, milliseconds }: DanceResult): NonNullable<Dance['result']> {
  return { backend, model, windows, milliseconds };
}
