/** The page's side of the worker that suggests key poses. */
import type { SuggestedPose, SuggestRequest } from '../core/suggest';
import type { KeyPose } from '../core/types';
import type { AlternatesRequest, SuggestCall, SuggestModel, SuggestReply } from './suggest-protocol';

type Reply<T extends SuggestReply['type']> = Omit<Extract<SuggestReply, { type: T }>, 'type' | 'job'>;
type Call = SuggestCall extends infer C ? (C extends { job: number } ? Omit<C, 'job'> : never) : never;

/** How the suggestions were made. */
export type SuggestResult = Reply<'done'>;
/** How far the download of the model is. */
export type SuggestLoading = Reply<'loading'>;

/** How to follow the work. */
export interface SuggestFollow {
  onLoading?: (progress: SuggestLoading) => void;
  /** Poses that follow those given before, and the share that is done. */
  onPoses?: (poses: SuggestedPose[], fraction: number) => void;
  /** Rejects the promise at once with an AbortError; the worker stops after the step it is in. */
  signal?: AbortSignal;
}

interface Pending {
  receive(reply: SuggestReply): void;
  fail(error: Error): void;
}

/** Suggests key poses in a worker, which is started on first use. */
export class SuggestClient {
  private worker: Worker | undefined;
  private lastJob = 0;
  private readonly pending = new Map<number, Pending>();

  /** @param createWorker for tests */
  constructor(private readonly createWorker: () => Worker = startWorker) {}

  /** Loads the model ahead of its first use. Rejects with a message for people. */
  async load(model: SuggestModel): Promise<void> {
    await this.ask({ type: 'load', ...model }, 'done');
  }

  /**
   * Suggests key poses, beat by beat.
   * @throws DOMException AbortError when the signal is aborted; Error with a message for people
   */
  suggest(model: SuggestModel, request: SuggestRequest, follow: SuggestFollow = {}): Promise<SuggestResult> {
    return this.ask({ type: 'suggest', ...model, request }, 'done', follow);
  }

  /**
   * Other poses for a suggested one.
   * @throws DOMException AbortError when the signal is aborted; Error with a message for people
   */
  async alternates(
    model: SuggestModel,
    request: AlternatesRequest,
    key: KeyPose,
    signal?: AbortSignal,
  ): Promise<number[][]> {
    return (await this.ask({ type: 'alternates', ...model, request, key }, 'alternates', { signal })).poses;
  }

  /** Ends the worker; jobs under way reject. */
  dispose(): void {
    this.stop(new Error('The key pose suggestions were closed.'));
  }

  private ask<T extends 'done' | 'alternates'>(call: Call, last: T, follow: SuggestFollow = {}): Promise<Reply<T>> {
    const { signal, onLoading, onPoses } = follow;
    if (signal?.aborted) return Promise.reject(abortError());
    const job = ++this.lastJob;
    return new Promise<Reply<T>>((resolve, reject) => {
      const settle = (finish: () => void) => {
        this.pending.delete(job);
        signal?.removeEventListener('abort', abort);
        finish();
      };
      const abort = () => {
        this.send({ type: 'cancel', job });
        settle(() => reject(abortError()));
      };
      signal?.addEventListener('abort', abort, { once: true });
      this.pending.set(job, {
        receive: (reply) => {
          if (reply.type === 'loading') onLoading?.(reply);
          else if (reply.type === 'poses') onPoses?.(reply.poses, reply.fraction);
          else if (reply.type === last) settle(() => resolve(reply as unknown as Reply<T>));
          else if (reply.type === 'cancelled') settle(() => reject(abortError()));
          else if (reply.type === 'error') settle(() => reject(new Error(reply.message)));
        },
        fail: (error) => settle(() => reject(error)),
      });
      this.send({ ...call, job } as SuggestCall);
    });
  }

  private send(call: SuggestCall): void {
    if (!this.worker) {
      this.worker = this.createWorker();
      this.worker.onmessage = ({ data }: MessageEvent<SuggestReply>) => this.pending.get(data.job)?.receive(data);
      this.worker.onerror = (event) => {
        event.preventDefault();
        const detail = event.message ? ` (${event.message})` : '';
        this.stop(new Error(`The key pose suggestions stopped unexpectedly${detail}: try again, or reload the page.`));
      };
    }
    this.worker.postMessage(call);
  }

  private stop(error: Error): void {
    this.worker?.terminate();
    this.worker = undefined;
    for (const pending of [...this.pending.values()]) pending.fail(error);
    this.pending.clear();
  }
}

function startWorker(): Worker {
  return new Worker(new URL('./suggest.worker.ts', import.meta.url), { type: 'module', name: 'suggest' });
}

function abortError(): DOMException {
  return new DOMException('The suggestion was cancelled.', 'AbortError');
}
