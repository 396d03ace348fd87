/** A second dance to a stretch of the song, from another starting clip: for the picture of two dances (paper A, figure 8). */
import { effect } from '@preact/signals';
import { excerpt } from '../../core/excerpt';
import { sliceMotion } from '../../core/motion';
import spec from '../../core/spec.json';
import type { Motion } from '../../core/types';
import { onGrid, type Context } from '../context';
import { documentOnStage } from '../on-stage';
import type { DanceActions } from './dance';

/** Seconds that the second dance has to find into the key poses before the stretch, and that it goes on after it. */
const LEAD = 4;
const TAIL = 1;

/** Actions for the picture. */
export function pictureActions(context: Context, dances: DanceActions) {
  const { state, services } = context;

  /** Fires when the visitor wants a dance: one at a time, and theirs comes first. */
  function interruption(): { signal: AbortSignal; stop: () => void } {
    const controller = new AbortController();
    const stop = effect(() => {
      if (state.generation.value.status !== 'idle')
        controller.abort(new Error('The picture was stopped for the new dance: save it when the dance is ready.'));
    });
    return { signal: controller.signal, stop };
  }

  return {
    /**
     * Dances a stretch from another starting clip, with the key poses and dials of the dance on stage; document and dance stay as they are.
     * @param range seconds
     * @param clipId of the starting clip
     * @returns the frames of the stretch
     * @throws Error with a message for people; AbortError when the signal fires
     */
    async secondDance(
      range: { start: number; end: number },
      clipId: string,
      onProgress: (fraction: number) => void,
      signal: AbortSignal,
    ): Promise<Motion> {
      const seedClip = state.seeds.value.find((clip) => clip.id === clipId);
      if (!seedClip) throw new Error('This starting clip could not be loaded: reload the page.');
      const interrupted = interruption();
      try {
        const both = AbortSignal.any([signal, interrupted.signal]);
        both.throwIfAborted();
        await dances.loadModel();
        const heard = await context.analysed();
        both.throwIfAborted();
        const { keyPoses, dials, grid } = documentOnStage(state);
        const { fps } = spec;
        const first = Math.floor(range.start * fps);
        const last = Math.min(state.frames.value, Math.ceil(range.end * fps));
        const from = Math.max(0, first - LEAD * fps);
        const whole = { ...onGrid(heard, grid), keyPoses };
        const { keyStrength, variation, seed } = dials;
        const result = await services.engine.generate(
          {
            ...excerpt(whole, from, Math.min(state.frames.value, last + TAIL * fps)),
            seedClip,
            otherClips: state.seeds.value,
            options: { keyStrength, variation, seed, cleanFeet: true },
          },
          (_, fraction) => onProgress(fraction),
          both,
        );
        both.throwIfAborted();
        return sliceMotion(result.motion, first - from, last - from);
      } catch (error) {
        throw interrupted.signal.aborted ? (interrupted.signal.reason as Error) : error;
      } finally {
        interrupted.stop();
      }
    },
  };
}

/** Actions for the picture. */
export type PictureActions = ReturnType<typeof pictureActions>;
