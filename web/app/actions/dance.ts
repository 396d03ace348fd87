/** Making dances: loading the model, generating, cancelling, measuring. */
import spec from '../../core/spec.json';
import type { Motion } from '../../core/types';
import type { Backend } from '../../workers/protocol';
import { isAbort, messageOf, onGrid, type Context } from '../context';
import type { DanceResult, ModelInfo } from '../ports';
import type { Reporter } from '../report-client';
import { measureDance, type DanceReport } from '../report';
import type { Dance, DanceInputs } from '../state';

/** Settings of one dance; what is left out comes from the document's dials. */
export interface GenerateCall {
  keyStrength?: number;
  variation?: number;
  seed?: number;
  /** Seconds; only this stretch is made anew. */
  range?: { start: number; end: number };
  engine?: 'light' | 'curves';
  backend?: Backend;
}

/** What a dance cost. */
export interface GenerateSummary {
  backend: Backend;
  model: string;
  frames: number;
  milliseconds: number;
  windows: number;
}

/** Actions on dances. */
export function danceActions(context: Context, reporter: Reporter) {
  const { state, services } = context;
  let running: AbortController | null = null;
  /** The dance that the report is of. */
  let measured: Motion | null = null;
  let loading: { backend: Backend | undefined; promise: Promise<ModelInfo> } | null = null;

  const cancel = (reason = 'Cancelled.') => {
    running?.abort(new DOMException(reason, 'AbortError'));
    running = null;
    state.partial.value = null;
    state.generation.value = { status: 'idle' };
  };

  const loadModel = (backend = services.forcedBackend): Promise<ModelInfo> => {
    if (loading && loading.backend === backend) return loading.promise;
    const promise = services.engine
      .load(backend, (progress) => {
        if (running) state.generation.value = { status: 'loading', ...progress };
      })
      .then((info) => (state.model.value = info));
    loading = { backend, promise };
    // A failed download must not be remembered: the next press of Generate tries again.
    promise.catch(() => {
      if (loading?.promise === promise) loading = null;
    });
    return promise;
  };

  const check = (call: GenerateCall): void => {
    if (call.engine !== undefined && call.engine !== 'light') {
      if (call.engine === 'curves') throw new Error('The curves engine is not available yet: use engine "light".');
      throw new Error(`There is no engine "${String(call.engine)}": use "light".`);
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

  async function generate(call: GenerateCall = {}): Promise<GenerateSummary> {
    check(call);
    const song = state.song.value;
    if (!song) throw new Error('There is no song yet: drop one, or call loadSong first.');
    const seedClip = state.seedClip.value;
    if (!seedClip) throw new Error('The starting clips could not be loaded: reload the page.');
    const range = frameRange(call.range);
    cancel('A newer dance was asked for.');
    const own = (running = new AbortController());
    const { signal } = own;
    state.generation.value = { status: 'loading', fraction: 0, bytes: 0, totalBytes: 0, cached: false };
    try {
      await Promise.race([loadModel(call.backend ?? services.forcedBackend), aborted(signal)]);
      const heard = await Promise.race([context.analysed(), aborted(signal)]);
      const { document } = state;
      const inputs: DanceInputs = {
        keyPoses: document.value.keyPoses,
        grid: document.value.grid,
        dials: document.value.dials,
      };
      const { keyStrength, variation, seed } = { ...document.value.dials, ...defined(call) };
      state.generation.value = { status: 'running', fraction: 0, windows: 0 };
      const result = await services.engine.generate(
        {
          ...onGrid(heard, inputs.grid),
          frames: state.frames.value,
          keyPoses: [...inputs.keyPoses],
          seedClip,
          otherClips: state.seeds.value,
          options: { keyStrength, variation, seed, cleanFeet: true },
          ...(range ? { range, previous: danceSoFar(), previousUncorrected: state.dance.value?.uncorrected } : {}),
        },
        (motion, fraction, windows) => {
          if (signal.aborted) return;
          if (motion) state.partial.value = motion;
          state.generation.value = { status: 'running', fraction, windows };
        },
        signal,
      );
      signal.throwIfAborted();
      const { dials } = inputs;
      const byDials = keyStrength === dials.keyStrength && variation === dials.variation && seed === dials.seed;
      finish(result, { inputs, keyStrength, byDials });
      const { backend, model, windows, milliseconds, motion } = result;
      return { backend, model, frames: motion.frames, milliseconds, windows };
    } finally {
      if (running === own) cancel();
    }
  }

  function finish(result: DanceResult, made: Pick<Dance, 'inputs' | 'keyStrength' | 'byDials'>): void {
    const { motion, uncorrected, ...rest } = result;
    state.dance.value = { motion, kind: 'generated', result: rest, uncorrected, ...made };
    state.partial.value = null;
    context.announce('The dance is ready.');
    saveShown();
    void measureShown();
  }

  /** Keeps the dance on stage for the next visit. */
  function saveShown(): void {
    const hash = state.song.value?.reference.hash;
    const dance = state.dance.value;
    if (!hash || dance?.kind !== 'generated') return;
    const { motion, uncorrected, keyStrength } = dance;
    services.storage.saveDance({ hash, motion, uncorrected, keyStrength }).catch(() => undefined);
  }

  /** Shows what was measured of a dance. */
  function showReport(motion: Motion, report: DanceReport): void {
    measured = motion;
    state.report.value = report;
  }

  /** Measures the dance on stage for the report panel. */
  async function measureShown(): Promise<void> {
    const dance = state.dance.value;
    if (!dance || dance.kind === 'preview') return;
    const keys = dance.inputs?.keyPoses ?? state.document.value.keyPoses;
    try {
      const report = await reporter.measure(dance.motion, keys, state.grid.value);
      if (state.dance.value?.motion === dance.motion) showReport(dance.motion, report);
    } catch (error) {
      if (!isAbort(error)) context.notify('error', messageOf(error));
    }
  }

  return {
    loadModel,
    generate,
    measureShown,
    saveShown,
    showReport,

    /** What the Generate button does: errors become notices. */
    async generateForPage(range?: { start: number; end: number }): Promise<void> {
      try {
        await generate(range ? { range } : {});
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
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

    /** Measures the dance on stage now. Throws when there is none. */
    reportNow(): DanceReport {
      const dance = state.dance.value;
      if (!dance) throw new Error('There is no dance yet: call generate first.');
      const keys = dance.inputs?.keyPoses ?? state.document.value.keyPoses;
      const known = measured === dance.motion ? state.report.value : null;
      return structuredClone(known ?? measureDance(dance.motion, keys, state.grid.value));
    },

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

/** The members that are not undefined. */
function defined(call: GenerateCall): GenerateCall {
  return Object.fromEntries(Object.entries(call).filter(([, value]) => value !== undefined));
}

/** Rejects when the signal fires. */
function aborted(signal: AbortSignal): Promise<never> {
  return new Promise((_, reject) =>
    signal.addEventListener('abort', () => reject(signal.reason as Error), { once: true }),
  );
}
