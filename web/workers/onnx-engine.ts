/** A model on the best backend that works here, with a way back to WASM when the graphics processor fails. */
import type { WindowInputs } from '../core/windows';
import {
  DANCE_MODEL,
  loadModel,
  parseGoldenRun,
  type GoldenWindow,
  type ModelFiles,
  type StoredModel,
} from './model-store';
import { goldenRunError, openNetwork, type Feeds, type GoldenRun, type Outputs } from './onnx-network';
import { checkAdapter, openRuntime, threadsAvailable, type OrtModule } from './onnx-runtime';
import { goldenError, GOLDEN_TOLERANCE, openSession } from './onnx-session';
import type { Backend } from './protocol';

/** What to load. */
export interface EngineOptions {
  /** Absolute URL of the models folder, with a slash at its end. */
  folder: string;
  /** Forces a backend; where it does not work WASM is used, and `reason` says so. */
  backend?: Backend;
  threads?: number;
  onProgress(bytes: number, total: number, cached: boolean): void;
}

/** What is in use, for people to see. */
export interface EngineState {
  backend: Backend;
  threads: number;
  /** Name and precision of the model. */
  model: string;
  /** Why this backend. */
  reason: string;
}

/** A model on one backend. */
interface Session<I, O> {
  backend: Backend;
  run(inputs: I): Promise<O>;
  close(): Promise<void>;
}

/** A kind of model: its files, and how it is opened and checked. */
export interface ModelKind<I, O, G> {
  files: ModelFiles<G>;
  open(ort: OrtModule, backend: Backend, weights: Uint8Array): Promise<Session<I, O>>;
  /** Largest difference to the golden run. */
  error(session: Session<I, O>, golden: G): Promise<number>;
  tolerance: number;
}

/** The dance model: a window in, its motion out. */
const DANCE_KIND: ModelKind<WindowInputs, Float32Array, GoldenWindow> = {
  files: DANCE_MODEL,
  open: openSession,
  error: goldenError,
  tolerance: GOLDEN_TOLERANCE,
};

/**
 * Any network whose manifest is NAME.json with a golden run in NAME.golden.json and .bin: named numbers in, named numbers out.
 * @param title in sentences for people: "The dance model"
 */
export function networkKind(name: string, title: string): ModelKind<Feeds, Outputs, GoldenRun> {
  return {
    files: { title, manifest: `${name}.json`, golden: `${name}.golden`, parse: parseGoldenRun },
    open: openNetwork,
    error: goldenRunError,
    tolerance: GOLDEN_TOLERANCE,
  };
}

/** A loaded model. */
export class ModelEngine<I, O, G> {
  private constructor(
    private readonly kind: ModelKind<I, O, G>,
    private readonly stored: StoredModel<G>,
    private session: Session<I, O>,
    readonly state: EngineState,
    private readonly onChange: (state: EngineState) => void,
  ) {}

  /**
   * Loads the weights, chooses a backend and checks it with the golden run.
   * @param onChange called when a later failure changes the backend
   * @throws Error with a message for people when nothing works
   */
  static async open<I, O, G>(
    kind: ModelKind<I, O, G>,
    options: EngineOptions,
    onChange: (state: EngineState) => void = () => undefined,
  ): Promise<ModelEngine<I, O, G>> {
    const choosing = chooseBackend(options.backend);
    // The runtime comes while the weights do; what is wrong with it is said when it is used.
    void choosing.then(({ backend }) => openRuntime(backend, 1)).catch(() => undefined);
    const [stored, choice] = await Promise.all([loadModel(options.folder, options.onProgress, kind.files), choosing]);
    const model = `${stored.manifest.name} (${stored.manifest.precision})`;
    const threads = threadsAvailable(options.threads);
    let reason = choice.reason;
    if (choice.backend === 'webgpu') {
      try {
        const session = await checkedSession(kind, 'webgpu', 1, stored);
        return new ModelEngine(kind, stored, session, { backend: 'webgpu', threads: 1, model, reason }, onChange);
      } catch (error) {
        reason = `WebGPU (${choice.name}) did not work: ${messageOf(error)}`;
      }
    }
    const session = await checkedSession(kind, 'wasm', threads, stored);
    const state: EngineState = { backend: 'wasm', threads, model, reason: `${reason}; ${threadsText(threads)}.` };
    return new ModelEngine(kind, stored, session, state, onChange);
  }

  /** Runs once. When the graphics processor fails in the middle of a dance, it is run again on WASM. */
  async run(inputs: I): Promise<O> {
    try {
      return await this.session.run(inputs);
    } catch (error) {
      if (this.session.backend === 'wasm') throw error;
      const threads = threadsAvailable();
      this.session = await checkedSession(this.kind, 'wasm', threads, this.stored);
      const reason = `WebGPU failed while dancing (${messageOf(error)}); ${threadsText(threads)}.`;
      Object.assign(this.state, { backend: 'wasm', threads, reason });
      this.onChange(this.state);
      return this.session.run(inputs);
    }
  }

  async close(): Promise<void> {
    await this.session.close();
  }
}

/** The dance model, loaded. */
export type DanceEngine = ModelEngine<WindowInputs, Float32Array, GoldenWindow>;
/** Opens the dance model. */
export const DanceEngine = {
  open: (options: EngineOptions, onChange?: (state: EngineState) => void): Promise<DanceEngine> =>
    ModelEngine.open(DANCE_KIND, options, onChange),
};

/** What to try first, and why. A software adapter is taken only when it is asked for. */
async function chooseBackend(
  forced: Backend | undefined,
  check: typeof checkAdapter = checkAdapter,
): Promise<{ backend: Backend; reason: string; name: string }> {
  if (forced === 'wasm') return { backend: 'wasm', reason: 'WASM was asked for', name: '' };
  const adapter = await check();
  if (!adapter.usable) {
    const asked = forced === 'webgpu' ? 'WebGPU was asked for, but: ' : '';
    return { backend: 'wasm', reason: asked + adapter.reason, name: '' };
  }
  if (forced === 'webgpu')
    return { backend: 'webgpu', reason: `WebGPU was asked for: ${adapter.name}.`, name: adapter.name };
  if (adapter.software) {
    return { backend: 'wasm', reason: `The only WebGPU adapter is software (${adapter.name})`, name: adapter.name };
  }
  return { backend: 'webgpu', reason: `WebGPU: ${adapter.name}.`, name: adapter.name };
}

function threadsText(threads: number): string {
  return threads > 1 ? `WASM with ${threads} threads` : 'WASM with 1 thread';
}

async function checkedSession<I, O, G>(
  kind: ModelKind<I, O, G>,
  backend: Backend,
  threads: number,
  stored: StoredModel<G>,
): Promise<Session<I, O>> {
  const ort = await openRuntime(backend, threads);
  const session = await kind.open(ort, backend, stored.weights);
  const error = await kind.error(session, stored.golden);
  if (error <= kind.tolerance) return session;
  await session.close();
  throw new Error(`the check window came out wrong (off by ${error.toPrecision(2)}, allowed ${kind.tolerance})`);
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
