/** The page's side of the analyse worker. */
import { monoPart, yieldToPage } from '../audio/decode';
import type { BeatGrid, Features, Waveform } from '../core/types';
import type { AnalyseReply, AnalyseRequest, Analysis } from './protocol';

/** Sound that is asked for piece by piece. */
export interface SoundSource {
  sampleRate: number;
  /** Samples per channel. */
  length: number;
  /** Mono samples [from, end); the array is given away. */
  read(from: number, end: number): Float32Array<ArrayBuffer>;
}

/** How to follow an analysis. */
export interface AnalyseOptions {
  /** Share that is done, 0..1; the waveform so far comes along now and then. */
  onProgress?: (fraction: number, waveform?: Waveform) => void;
  /** Features and beats of the first ten seconds, while the rest is worked on (not for shorter songs). */
  onHead?: (features: Features, grid: BeatGrid) => void;
  /** Rejects the promise at once with an AbortError; the worker stops after the chunk that it is in. */
  signal?: AbortSignal;
}

/** Samples per message: about 1.5 s of sound, mixed well within a frame of the page. */
const CHUNK = 1 << 16;
/** Chunks the worker has not answered yet: enough to keep it busy, few enough that a cancel is heard soon. */
const AHEAD = 4;

interface Job {
  id: number;
  options: AnalyseOptions;
  /** Chunks sent and not answered. */
  open: number;
  /** Wakes the sender. */
  wake: () => void;
  isOver: boolean;
  resolve(result: Analysis): void;
  reject(error: unknown): void;
}

/** Runs analyses in one worker, started on first use; a new one cancels the one before. */
export class AnalyseClient {
  private worker: Worker | null = null;
  private lastJob = 0;
  private current: Job | null = null;

  /** @param createWorker for tests */
  constructor(private readonly createWorker: () => Worker = startWorker) {}

  /**
   * @throws DOMException AbortError when the signal is aborted or another song takes over; Error with a message for people
   */
  analyse(source: SoundSource | AudioBuffer, options: AnalyseOptions = {}): Promise<Analysis> {
    const { signal } = options;
    if (signal?.aborted) return Promise.reject(abortError());
    if (this.current) this.cancel(this.current);
    return new Promise((resolve, reject) => {
      const job: Job = { id: ++this.lastJob, options, open: 0, wake: () => undefined, isOver: false, resolve, reject };
      this.current = job;
      const abort = (): void => this.cancel(job);
      signal?.addEventListener('abort', abort, { once: true });
      const settle = (): void => signal?.removeEventListener('abort', abort);
      job.resolve = (result) => (settle(), resolve(result));
      job.reject = (error) => (settle(), reject(error));
      this.feed(job, 'read' in source ? source : fromAudioBuffer(source)).catch((error) => this.fail(job, error));
    });
  }

  /** Ends the worker; a running analysis rejects with an AbortError. */
  dispose(): void {
    if (this.current) this.cancel(this.current);
    this.worker?.terminate();
    this.worker = null;
  }

  /** Sends the song, a chunk at a time; the page gets its turn after each. */
  private async feed(job: Job, source: SoundSource): Promise<void> {
    this.send({ type: 'begin', job: job.id, sampleRate: source.sampleRate, samples: source.length });
    for (let from = 0; from < source.length && !job.isOver; from += CHUNK) {
      const pcm = source.read(from, Math.min(source.length, from + CHUNK));
      job.open++;
      this.send({ type: 'chunk', job: job.id, pcm }, [pcm.buffer]);
      await yieldToPage();
      while (job.open >= AHEAD && !job.isOver) await new Promise<void>((resolve) => (job.wake = resolve));
    }
  }

  private send(message: AnalyseRequest, transfer: Transferable[] = []): void {
    if (!this.worker) {
      this.worker = this.createWorker();
      this.worker.onmessage = ({ data }: MessageEvent<AnalyseReply>) => this.receive(data);
      this.worker.onerror = (event) => {
        event.preventDefault();
        this.worker?.terminate();
        this.worker = null;
        if (this.current)
          this.fail(this.current, new Error('The song analysis stopped unexpectedly. Reload the page and try again.'));
      };
    }
    this.worker.postMessage(message, transfer);
  }

  private receive(message: AnalyseReply): void {
    const job = this.current;
    if (!job || message.job !== job.id) return;
    if (message.type === 'progress') {
      job.open--;
      job.wake();
      job.options.onProgress?.(message.fraction, message.waveform);
    } else if (message.type === 'head') {
      job.options.onHead?.(message.features, message.grid);
    } else if (message.type === 'result') {
      this.end(job);
      const { features, grid, waveform, milliseconds } = message;
      job.resolve({ features, grid, waveform, milliseconds });
    } else {
      this.fail(job, message.type === 'error' ? new Error(message.message) : abortError());
    }
  }

  private cancel(job: Job): void {
    if (job.isOver) return;
    this.send({ type: 'cancel', job: job.id });
    this.fail(job, abortError());
  }

  private fail(job: Job, error: unknown): void {
    if (job.isOver) return;
    this.end(job);
    job.reject(error);
  }

  private end(job: Job): void {
    job.isOver = true;
    if (this.current === job) this.current = null;
    job.wake();
  }
}

function fromAudioBuffer(buffer: AudioBuffer): SoundSource {
  return {
    sampleRate: buffer.sampleRate,
    length: buffer.length,
    read: (from, end) => monoPart(buffer, from, end),
  };
}

function abortError(): DOMException {
  return new DOMException('The song analysis was cancelled.', 'AbortError');
}

function startWorker(): Worker {
  return new Worker(new URL('./analyse.worker.ts', import.meta.url), { type: 'module' });
}
