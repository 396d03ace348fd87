/** The page's side of the generate worker. */
import type { EngineName } from '../core/document';
import type { Motion } from '../core/types';
import type {
  Backend,
  DanceRequest,
  DanceResult,
  GenerateReply,
  GenerateRequest,
  LoadProgress,
  ModelInfo,
} from './protocol';

/** How to load the model. */
export interface LoadOptions {
  /** Forces a backend. */
  backend?: Backend;
  /** WASM threads; by default up to four where the page is isolated. */
  threads?: number;
  /** Which model; missing = light. The two are loaded independently of each other. */
  engine?: EngineName;
  /** Where the page's own files are; by default document.baseURI, so that any sub-path works. */
  baseUrl?: string;
  onProgress?: (progress: LoadProgress) => void;
}

/** How to follow one generation. */
export interface GenerateHooks {
  /** The dance so far: frames [0, motion.frames) are final; null for a range, which comes only as a whole. */
  onPartial?: (motion: Motion | null, fraction: number, windows: number) => void;
  /** Rejects the promise at once with an AbortError; the worker stops after the window it is in. */
  signal?: AbortSignal;
}

/** A model that is loaded, or on its way. */
interface Load {
  /** Backend and threads. */
  wanted: string;
  job: number;
  promise: Promise<ModelInfo>;
}

interface Pending {
  receive(reply: GenerateReply): void;
  fail(error: Error): void;
}

/** Loads the model and makes dances in a worker, which is started on first use. */
export class GenerateClient {
  private worker: Worker | undefined;
  private lastJob = 0;
  private readonly pending = new Map<number, Pending>();
  private readonly loads = new Map<EngineName, Load>();

  /**
   * @param createWorker for tests
   * @param onBackendChange the model had to move to another backend, for instance after the graphics processor was lost
   */
  constructor(
    private readonly createWorker: () => Worker = startWorker,
    public onBackendChange: (model: ModelInfo) => void = () => undefined,
  ) {}

  /** The light model in use, once it is loaded. */
  get loaded(): Promise<ModelInfo> | undefined {
    return this.loads.get('light')?.promise;
  }

  /**
   * Loads onnxruntime and the model and checks the backend. A second call for the same backend and threads is the first.
   * @throws Error with a message for people
   */
  load(options: LoadOptions = {}): Promise<ModelInfo> {
    const { backend, threads, onProgress, engine = 'light' } = options;
    const wanted = `${backend ?? 'best'} ${threads ?? 'auto'}`;
    const before = this.loads.get(engine);
    if (before?.wanted === wanted) return before.promise;
    const baseUrl = options.baseUrl ?? document.baseURI;
    const job = ++this.lastJob;
    const promise = new Promise<ModelInfo>((resolve, reject) => {
      this.pending.set(job, {
        receive: (reply) => {
          if (reply.type === 'loading') onProgress?.(strip(reply));
          else if (reply.type === 'loaded') this.settle(job, () => resolve(strip(reply)));
          else if (reply.type === 'error') this.settle(job, () => reject(new Error(reply.message)));
        },
        fail: (error) => this.settle(job, () => reject(error)),
      });
    });
    const own: Load = { wanted, job, promise };
    this.loads.set(engine, own);
    this.send({ type: 'load', job, baseUrl, backend, threads, ...(engine === 'light' ? {} : { engine }) });
    // A failed load may be tried again.
    promise.catch(() => {
      if (this.loads.get(engine) === own) this.loads.delete(engine);
    });
    return promise;
  }

  /**
   * Makes a dance; loads the model first if nothing has.
   * @throws DOMException AbortError when the signal is aborted; Error with a message for people
   */
  async generate(request: DanceRequest, hooks: GenerateHooks = {}): Promise<DanceResult> {
    const { signal, onPartial } = hooks;
    signal?.throwIfAborted();
    const abortion = abortPromise(signal);
    try {
      const { engine = 'light' } = request;
      await Promise.race([this.loads.get(engine)?.promise ?? this.load({ engine }), abortion.promise]);
      const job = ++this.lastJob;
      const result = new Promise<DanceResult>((resolve, reject) => {
        this.pending.set(job, {
          receive: (reply) => {
            if (reply.type === 'partial') onPartial?.(reply.motion, reply.fraction, reply.windows);
            else if (reply.type === 'result') this.settle(job, () => resolve(strip(reply)));
            else if (reply.type === 'cancelled') this.settle(job, () => reject(abortError()));
            else if (reply.type === 'error') this.settle(job, () => reject(new Error(reply.message)));
          },
          fail: (error) => this.settle(job, () => reject(error)),
        });
      });
      this.send({ type: 'generate', job, ...request });
      const cancel = () => {
        this.pending.delete(job);
        this.send({ type: 'cancel', job });
      };
      signal?.addEventListener('abort', cancel, { once: true });
      try {
        return await Promise.race([result, abortion.promise]);
      } finally {
        signal?.removeEventListener('abort', cancel);
      }
    } finally {
      abortion.dispose();
    }
  }

  /** Ends the worker; jobs under way reject. */
  dispose(): void {
    this.stop(new Error('The dance generator was closed.'));
  }

  private settle(job: number, finish: () => void): void {
    this.pending.delete(job);
    finish();
  }

  private send(request: GenerateRequest): void {
    if (!this.worker) {
      this.worker = this.createWorker();
      this.worker.onmessage = ({ data }: MessageEvent<GenerateReply>) => {
        const pending = this.pending.get(data.job);
        if (pending) pending.receive(data);
        else if (data.type === 'loaded') this.moved(data.job, strip(data));
      };
      this.worker.onerror = (event) => {
        event.preventDefault();
        const detail = event.message ? ` (${event.message})` : '';
        this.stop(new Error(`The dance generator stopped unexpectedly${detail}: try again, or reload the page.`));
      };
    }
    this.worker.postMessage(request);
  }

  private moved(job: number, model: ModelInfo): void {
    for (const [engine, load] of this.loads) {
      if (load.job !== job) continue;
      this.loads.set(engine, { ...load, promise: Promise.resolve(model) });
      this.onBackendChange(model);
    }
  }

  private stop(error: Error): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.loads.clear();
    for (const pending of [...this.pending.values()]) pending.fail(error);
    this.pending.clear();
  }
}

function startWorker(): Worker {
  return new Worker(new URL('./generate.worker.ts', import.meta.url), { type: 'module', name: 'generate' });
}

function strip<T extends { type: string; job: number }>(reply: T): Omit<T, 'type' | 'job'> {
  const rest: Partial<T> = { ...reply };
  delete rest.type;
  delete rest.job;
  return rest as Omit<T, 'type' | 'job'>;
}

function abortError(): DOMException {
  return new DOMException('The generation was cancelled.', 'AbortError');
}

/** A promise that rejects when the signal is aborted, and a way to stop listening. */
function abortPromise(signal: AbortSignal | undefined): { promise: Promise<never>; dispose: () => void } {
  let listener: () => void = () => undefined;
  const promise = new Promise<never>((_, reject) => {
    listener = () => reject(abortError());
    signal?.addEventListener('abort', listener, { once: true });
  });
  // Nobody may be racing it any more when it rejects.
  promise.catch(() => undefined);
  return { promise, dispose: () => signal?.removeEventListener('abort', listener) };
}
