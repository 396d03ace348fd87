/** Making dances: loading the model, generating, cancelling, measuring. */
import { batch } from '@preact/signals';
import type { EngineName, ProjectDocument } from '../../core/document';
import type { FrameRange } from '../../core/excerpt';
import spec from '../../core/spec.json';
import type { BeatGrid, Features, Motion, SeedClip } from '../../core/types';
import type { Backend } from '../../workers/protocol';
import { isAbort, messageOf, onGrid, type Context } from '../context';
import { checkCall, defined, meansDials, summary, type GenerateCall, type GenerateSummary } from '../dance-call';
import type { DanceCache } from '../dance-cache';
import { createMaker } from '../dance-maker';
import type { ModelInfo, SavedDance } from '../ports';
import { inputsOf, madeFrom, trimFrames, type DanceInputs } from '../recipe';
import type { Reporter } from '../report-client';
import type { Dance } from '../state';
import { danceReport } from './dance-report';
import { modelLoader } from './model-loader';

export type { GenerateCall, GenerateSummary } from '../dance-call';

/** A whole song as it was heard. */
interface Heard {
  features: Features;
  grid: BeatGrid;
}

/** Actions on dances. */
export function danceActions(context: Context, reporter: Reporter, cache: DanceCache) {
  const { state, services } = context;
  const { measureShown, showReport, reportNow } = danceReport(context, reporter);
  const maker = createMaker(context, reporter, cache);
  const hash = () => state.song.value?.reference.hash ?? '';
  /** A dance that is being put together from parts. */
  let bringing: AbortController | null = null;
  let running: AbortController | null = null;
  const loadModel = modelLoader(context, () => running !== null);

  const cancel = (reason = 'Cancelled.') => {
    running?.abort(new DOMException(reason, 'AbortError'));
    running = null;
    state.partial.value = null;
    state.generation.value = { status: 'idle' };
  };

  /** What makes the dance: one step of undo; the other engine's dance comes back at once where it was made before. */
  const setEngine = (engine: EngineName): void => {
    context.change('Change engine', (document) => {
      if ((document.engine ?? 'light') === engine) return document;
      const next: ProjectDocument = { ...document, engine };
      if (engine === 'light') delete next.engine;
      return next;
    });
  };

  const frameRange = (range: GenerateCall['range']): { from: number; to: number } | undefined => {
    if (range === undefined) return undefined;
    const { start, end } = range;
    if (!(start >= 0 && end > start && start < state.duration.value)) {
      throw new Error(
        `range must be {start, end} in seconds inside the song (0 to ${state.duration.value.toFixed(2)}).`,
      );
    }
    if (!danceSoFar()) throw new Error('There is no dance yet to change a part of: generate the whole first.');
    return { from: Math.floor(start * spec.fps), to: Math.min(state.frames.value, Math.ceil(end * spec.fps)) };
  };

  const danceSoFar = (): Motion | undefined => {
    const dance = state.dance.value;
    return dance && dance.kind !== 'preview' && dance.motion.frames === state.frames.value ? dance.motion : undefined;
  };

  const seedClipNow = () => {
    if (!state.song.value) throw new Error('There is no song yet: drop one, or call loadSong first.');
    const seedClip = state.seedClip.value;
    if (!seedClip) throw new Error('The starting clips could not be loaded: reload the page.');
    return seedClip;
  };

  /** Runs a job of the generator; the newest wins. */
  async function work<T>(job: (signal: AbortSignal, ready: () => Promise<Heard>) => Promise<T>, backend?: Backend) {
    cancel('A newer dance was asked for.');
    const own = (running = new AbortController());
    const { signal } = own;
    const ready = async () => {
      const { engine } = state.document.value;
      await Promise.race([loadModel(backend ?? services.forcedBackend, engine), aborted(signal)]);
      const heard = await Promise.race([context.analysed(), aborted(signal)]);
      if (running === own) state.generation.value = { status: 'running', fraction: 0, windows: 0 };
      return heard;
    };
    state.generation.value = { status: 'loading', fraction: 0, bytes: 0, totalBytes: 0, cached: false };
    try {
      return await job(signal, ready);
    } finally {
      if (running === own) cancel();
    }
  }

  const progress = (motion: Motion | null, fraction: number, windows: number, made?: FrameRange) => {
    if (motion) state.partial.value = motion;
    const range = made && { start: made.from / spec.fps, end: made.to / spec.fps };
    state.generation.value = { status: 'running', fraction, windows, ...(range ? { range } : {}) };
  };

  async function generate(call: GenerateCall = {}): Promise<GenerateSummary> {
    checkCall(call);
    const seedClip = seedClipNow();
    if (call.engine) setEngine(call.engine);
    const range = frameRange(call.range);
    return range ? generateRange(call, range, seedClip) : generateWhole(call, seedClip, false);
  }

  /** The dance of the document with what the call says in place of the dials; `reuse` takes parts that were made before. */
  async function generateWhole(call: GenerateCall, seedClip: SeedClip, reuse: boolean): Promise<GenerateSummary> {
    return work(async (signal, ready) => {
      const inputs = inputsOf(state.document.value);
      const { keyStrength, variation, seed } = { ...inputs.dials, ...defined(call) };
      const dials = { keyStrength, variation, seed };
      const made = await maker.make({ inputs, dials, seedClip, reuse, ready, onProgress: progress, signal });
      signal.throwIfAborted();
      show({ ...made, kind: 'generated', inputs, byDials: meansDials(dials, inputs.dials) });
      context.announce('The dance is ready.');
      return summary(made.motion, made.result);
    }, call.backend);
  }

  /** Only a stretch made anew, which the document does not know of. */
  async function generateRange(call: GenerateCall, range: FrameRange, seedClip: SeedClip): Promise<GenerateSummary> {
    return work(async (signal, ready) => {
      const heard = await ready();
      const inputs = inputsOf(state.document.value);
      const { keyStrength, variation, seed } = { ...inputs.dials, ...defined(call) };
      if (inputs.engine === 'curves') {
        const dials = { keyStrength, variation, seed };
        const wish = { inputs, dials, seedClip, reuse: false, ready, onProgress: progress, signal };
        const made = await maker.makeCurves(wish, { ...range, seed, variation });
        signal.throwIfAborted();
        show({ ...made, kind: 'generated', inputs, byDials: false });
        return summary(made.motion, made.result);
      }
      const trim = trimFrames(inputs.trim, state.frames.value);
      const { motion, uncorrected, ...result } = await services.engine.generate(
        {
          ...onGrid(heard, inputs.grid),
          frames: state.frames.value,
          keyPoses: [...inputs.keyPoses],
          seedClip,
          otherClips: state.seeds.value,
          options: { keyStrength, variation, seed, cleanFeet: true },
          ...(trim ? { trim } : {}),
          range,
          previous: danceSoFar(),
          previousUncorrected: state.dance.value?.uncorrected,
        },
        (part, fraction, windows) => {
          if (!signal.aborted) progress(part, fraction, windows);
        },
        signal,
      );
      signal.throwIfAborted();
      show({ motion, uncorrected, result, kind: 'generated', inputs, keyStrength, byDials: false });
      context.announce('The dance is ready.');
      return summary(motion, result);
    }, call.backend);
  }

  /** Puts a dance on stage, keeps it for the next visit and measures it. */
  function show(dance: Dance): void {
    bringing?.abort();
    if (dance.byDials) cache.remember(dance, hash());
    batch(() => {
      state.dance.value = dance;
      state.partial.value = null;
    });
    saveShown();
    void measureShown();
  }

  /**
   * Brings the dance of the document back where it was made before: the very one, or one put together from parts.
   * @returns false when the network is needed
   */
  function bringBack(): boolean {
    const inputs = inputsOf(state.document.value);
    const back = cache.find(hash(), inputs);
    if (back) {
      show(back);
      return true;
    }
    if (!maker.isKnown(inputs)) return false;
    bringing?.abort();
    const own = (bringing = new AbortController());
    void composed(inputs, own.signal).catch((error: unknown) => {
      if (!isAbort(error)) context.notify('error', messageOf(error));
    });
    return true;
  }

  async function composed(inputs: DanceInputs, signal: AbortSignal): Promise<void> {
    const { dials } = inputs;
    const ready = () => Promise.reject(new Error('The dance could not be put together: generate it.'));
    const seedClip = seedClipNow();
    const made = await maker.make({ inputs, dials, seedClip, reuse: true, ready, onProgress: () => undefined, signal });
    signal.throwIfAborted();
    const wanted = inputsOf(state.document.value);
    if (!madeFrom(inputs, wanted, true, state.frames.value)) return;
    show({ ...made, kind: 'generated', inputs, byDials: true });
  }

  /** Keeps the dance on stage for the next visit. */
  function saveShown(): void {
    const dance = state.dance.value;
    if (!hash() || dance?.kind !== 'generated') return;
    const { motion, uncorrected, keyStrength, byDials, inputs, curves, curveEdits } = dance;
    const made = { motion, uncorrected, keyStrength, byDials, inputs: inputs ?? undefined };
    const saved = { hash: hash(), ...made, ...(curves ? { curves, curveEdits } : {}) };
    services.storage.saveDance(saved).catch(() => undefined);
  }

  return {
    loadModel,
    setEngine,
    generate,
    measureShown,
    saveShown,
    showReport,
    reportNow,
    showDance: show,
    bringBack,

    /** What the Generate button does: errors become notices. */
    async generateForPage(): Promise<void> {
      try {
        await generate();
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },

    /**
     * Makes the dance that the document asks for, from what was made before as far as that goes. Errors become notices.
     * @returns false when it was cancelled or failed
     */
    async catchUp(): Promise<boolean> {
      if (!state.stale.value || bringBack()) return true;
      try {
        await generateWhole({}, seedClipNow(), true);
        return true;
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
        return false;
      }
    },

    /** Puts a dance from the last visit on stage, if it is one to the song at hand; it knows what it was made from. */
    restoreDance(saved: SavedDance | null): boolean {
      if (saved?.hash !== hash() || saved.motion.frames !== state.frames.value) return false;
      const { motion, uncorrected, keyStrength, byDials, curves, curveEdits } = saved;
      const inputs = saved.inputs ?? inputsOf(state.document.value);
      const made = { motion, uncorrected, keyStrength, byDials, ...(curves ? { curves, curveEdits } : {}) };
      const dance: Dance = { ...made, kind: 'generated', inputs, result: null };
      if (byDials) cache.remember(dance, hash());
      state.dance.value = dance;
      void measureShown();
      return true;
    },

    /** The model had to move to another backend by itself. */
    modelMoved(model: ModelInfo): void {
      state.model.value = model;
      context.notify(
        'info',
        `The dance is now made on ${model.backend === 'wasm' ? 'the processor' : 'the graphics card'}. ${model.reason}`,
      );
    },

    /** Stops generating; the last good dance stays. */
    cancel,

    /** Changes a setting of the next dance: one step of undo. */
    setDial<K extends 'keyStrength' | 'variation' | 'seed' | 'seedClip'>(
      name: K,
      value: Context['state']['document']['value']['dials'][K],
    ): void {
      context.change('Change setting', (document) =>
        document.dials[name] === value ? document : { ...document, dials: { ...document.dials, [name]: value } },
      );
    },
  };
}

/** Actions on dances. */
export type DanceActions = ReturnType<typeof danceActions>;

/** Rejects when the signal fires. */
function aborted(signal: AbortSignal): Promise<never> {
  return new Promise((_, reject) =>
    signal.addEventListener('abort', () => reject(signal.reason as Error), { once: true }),
  );
}
