/** The dance model on the best backend that works here, with a way back to WASM when the graphics processor fails. */
import type { WindowInputs } from '../core/windows';
import { loadModel, type StoredModel } from './model-store';
import { checkAdapter, openRuntime, threadsAvailable } from './onnx-runtime';
import { goldenError, GOLDEN_TOLERANCE, openSession, type DanceSession } from './onnx-session';
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

/** A loaded model. */
export class DanceEngine {
  private constructor(
    private readonly stored: StoredModel,
    private session: DanceSession,
    readonly state: EngineState,
    private readonly onChange: (state: EngineState) => void,
  ) {}

  /**
   * Loads the weights, chooses a backend and checks it with the golden window.
   * @param onChange called when a later failure changes the backend
   * @throws Error with a message for people when nothing works
   */
  static async open(
    options: EngineOptions,
    onChange: (state: EngineState) => void = () => undefined,
  ): Promise<DanceEngine> {
    const [stored, choice] = await Promise.all([
      loadModel(options.folder, options.onProgress),
      chooseBackend(options.backend),
    ]);
    const model = `${stored.manifest.name} (${stored.manifest.precision})`;
    const threads = threadsAvailable(options.threads);
    let reason = choice.reason;
    if (choice.backend === 'webgpu') {
      try {
        const session = await checkedSession('webgpu', 1, stored);
        return new DanceEngine(stored, session, { backend: 'webgpu', threads: 1, model, reason }, onChange);
      } catch (error) {
        reason = `WebGPU (${choice.name}) did not work: ${messageOf(error)}`;
      }
    }
    const session = await checkedSession('wasm', threads, stored);
    const state: EngineState = { backend: 'wasm', threads, model, reason: `${reason}; ${threadsText(threads)}.` };
    return new DanceEngine(stored, session, state, onChange);
  }

  /** Runs one window. When the graphics processor fails in the middle of a dance, the window is run again on WASM. */
  async run(inputs: WindowInputs): Promise<Float32Array> {
    try {
      return await this.session.run(inputs);
    } catch (error) {
      if (this.session.backend === 'wasm') throw error;
      const threads = threadsAvailable();
      this.session = await checkedSession('wasm', threads, this.stored);
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

/** What to try first, and why. A software adapter is taken only when it is asked for. */
export async function chooseBackend(
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

async function checkedSession(backend: Backend, threads: number, stored: StoredModel): Promise<DanceSession> {
  const ort = await openRuntime(backend, threads);
  const session = await openSession(ort, backend, stored.weights);
  const error = await goldenError(session, stored.golden);
  if (error <= GOLDEN_TOLERANCE) return session;
  await session.close();
  throw new Error(`the check window came out wrong (off by ${error.toPrecision(2)}, allowed ${GOLDEN_TOLERANCE})`);
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
