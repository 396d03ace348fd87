/** The page's side of the report worker. */
import type { FrameRange } from '../core/excerpt';
import type { UncorrectedDance } from '../core/finish';
import type { TradeOffPoint } from '../core/report-curves';
import type { BeatGrid, KeyPose, Motion } from '../core/types';
import type { DanceReport } from './report';
import type { ReportReply, ReportRequest } from './report-protocol';
import ReportWorker from './report.worker?worker';

/** A dance that can be finished again. */
export interface TunableDance {
  uncorrected: UncorrectedDance;
  /** As it is shown now. */
  motion: Motion;
  keyPoses: readonly KeyPose[];
}

/** How a dance is to be finished. */
export interface FinishWish {
  strength: number;
  grid: BeatGrid | null;
  /** The frame that is looked at; asks for a draft around it first. */
  near?: number;
  onDraft?: (motion: Motion) => void;
}

/** Measures and finishes dances off the main thread. */
export interface Reporter {
  /** Measures a dance, or the part that is danced of a trimmed song; the motion is copied. */
  measure(
    motion: Motion,
    keyPoses: readonly KeyPose[],
    grid: BeatGrid | null,
    part?: FrameRange | null,
  ): Promise<DanceReport>;
  /** Finishes a dance at a key strength; a newer wish rejects an older one with an AbortError. */
  finish(dance: TunableDance, wish: FinishWish): Promise<{ motion: Motion; report: DanceReport }>;
  /** Plots consistency against smoothness; rejects with an AbortError when the signal fires or a newer plot or dance comes. */
  plot(
    dance: TunableDance,
    strengths: readonly number[],
    onPoint: (point: TradeOffPoint) => void,
    signal: AbortSignal,
  ): Promise<void>;
}

interface Waiting {
  take(reply: ReportReply): void;
  fail(error: Error): void;
}

/** Makes a reporter with a worker of its own, started at the first call. */
export function createReporter(createWorker: () => Worker = () => new ReportWorker()): Reporter {
  let worker: Worker | null = null;
  let jobs = 0;
  let held: UncorrectedDance | null = null;
  let heldKeys: readonly KeyPose[] = [];
  const waiting = new Map<number, Waiting>();

  const stop = (error: Error) => {
    worker?.terminate();
    worker = held = null;
    for (const each of [...waiting.values()]) each.fail(error);
    waiting.clear();
  };
  const send = (request: ReportRequest) => {
    if (!worker) {
      worker = createWorker();
      worker.onmessage = ({ data }: MessageEvent<ReportReply>) => waiting.get(data.job)?.take(data);
      worker.onerror = (event) => {
        event.preventDefault();
        stop(new Error('Measuring the dance stopped unexpectedly: generate it again, or reload the page.'));
      };
    }
    worker.postMessage(request);
  };
  /** Sends a job and hands on its replies until `last` finds its result in one. */
  const ask = <T>(
    request: (job: number) => ReportRequest,
    last: (reply: ReportReply) => { result: T } | null,
    signal?: AbortSignal,
  ): Promise<T> => {
    const job = (jobs += 1);
    return new Promise<T>((resolve, reject) => {
      const cancel = () => {
        waiting.delete(job);
        send({ type: 'cancel', job });
        reject(dropped());
      };
      const end = () => {
        waiting.delete(job);
        signal?.removeEventListener('abort', cancel);
      };
      waiting.set(job, {
        take(reply) {
          const done = last(reply);
          if (!done && reply.type !== 'dropped' && reply.type !== 'error') return;
          end();
          if (done) resolve(done.result);
          else reject(reply.type === 'error' ? new Error(reply.message) : dropped());
        },
        fail: reject,
      });
      signal?.addEventListener('abort', cancel, { once: true });
      send(request(job));
    });
  };
  const hold = ({ uncorrected, motion, keyPoses }: TunableDance) => {
    if (held !== uncorrected) send({ type: 'hold', dance: uncorrected, motion, keyPoses });
    else if (heldKeys !== keyPoses) send({ type: 'keys', keyPoses });
    held = uncorrected;
    heldKeys = keyPoses;
  };

  return {
    measure: (motion, keyPoses, grid, part = null) =>
      ask(
        (job) => ({ type: 'measure', job, motion, keyPoses, grid, part }),
        (reply) => (reply.type === 'report' ? { result: reply.report } : null),
      ),
    finish(dance, { strength, grid, near, onDraft }) {
      hold(dance);
      return ask(
        (job) => ({ type: 'finish', job, strength, grid, near }),
        (reply) => {
          if (reply.type === 'draft') onDraft?.(reply.motion);
          return reply.type === 'finished' ? { result: { motion: reply.motion, report: reply.report } } : null;
        },
      );
    },
    async plot(dance, strengths, onPoint, signal) {
      signal.throwIfAborted();
      hold(dance);
      await ask<null>(
        (job) => ({ type: 'plot', job, strengths }),
        (reply) => {
          if (reply.type === 'point') onPoint(reply.point);
          return reply.type === 'plotted' ? { result: null } : null;
        },
        signal,
      );
    },
  };
}

function dropped(): DOMException {
  return new DOMException('A newer wish took its place.', 'AbortError');
}
