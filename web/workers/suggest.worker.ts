/** Suggests key poses off the main thread: one job at a time, cancelled between steps. */
import { yieldToPage } from '../audio/decode';
import { alternatePoses, suggestPoses, type StepRunner, type SuggestedPose } from '../core/suggest';
import { ModelEngine, networkKind } from './onnx-engine';
import type { GoldenRun, Feeds, Outputs } from './onnx-network';
import type { SuggestCall, SuggestModel, SuggestReply } from './suggest-protocol';

type Engine = ModelEngine<Feeds, Outputs, GoldenRun>;
type Job = Exclude<SuggestCall, { type: 'cancel' }>;

/** Found poses are sent at most this often, milliseconds; the first at once. */
const INTERVAL = 60;
/** Suggests key poses: stage 1 of DanceFormer. */
const KIND = networkKind('suggest', 'The key pose model');

let engine: { promise: Promise<Engine>; backend: string } | undefined;
const jobs = new Map<number, AbortController>();
let queue: Promise<void> = Promise.resolve();

function reply(message: SuggestReply): void {
  self.postMessage(message);
}

/**
 * The model, loaded once for a backend. A step is many small operations on one pose: starting them costs a graphics processor, and
 * threads, more than they save, so it runs on one thread of the processor unless another backend is asked for.
 */
function open({ baseUrl, backend = 'wasm' }: SuggestModel, job: number): Promise<Engine> {
  if (engine?.backend === backend) return engine.promise;
  const before = engine?.promise;
  const promise = (async () => {
    await (await before?.catch(() => undefined))?.close();
    return ModelEngine.open(KIND, {
      folder: new URL('models/', baseUrl).href,
      backend,
      threads: 1,
      onProgress: (bytes, totalBytes, cached) =>
        reply({ type: 'loading', job, fraction: totalBytes ? bytes / totalBytes : 1, bytes, totalBytes, cached }),
    });
  })();
  const own = (engine = { promise, backend });
  // A failed load may be tried again.
  promise.catch(() => {
    if (engine === own) engine = undefined;
  });
  return promise;
}

async function work(call: Job, signal: AbortSignal): Promise<void> {
  const { job } = call;
  const model = await open(call, job);
  signal.throwIfAborted();
  const begun = performance.now();
  let steps = 0;
  const run: StepRunner = async (inputs) => {
    await yieldToPage();
    signal.throwIfAborted();
    const { pose, code } = await model.run(inputs);
    steps++;
    return { poses: pose, codes: code };
  };
  if (call.type === 'alternates') {
    reply({ type: 'alternates', job, poses: await alternatePoses(call.request, call.key, run, signal) });
    return;
  }
  if (call.type === 'suggest') {
    let waiting: SuggestedPose[] = [];
    let sent = -Infinity;
    let done = 0;
    const send = () => {
      if (waiting.length > 0) reply({ type: 'poses', job, poses: waiting, fraction: done });
      waiting = [];
      sent = performance.now();
    };
    const onPose = (pose: SuggestedPose, fraction: number) => {
      waiting.push(pose);
      done = fraction;
      if (performance.now() - sent > INTERVAL) send();
    };
    await suggestPoses(call.request, run, { onPose, signal });
    send();
  }
  const { backend, model: name } = model.state;
  reply({ type: 'done', job, backend, model: name, steps, milliseconds: performance.now() - begun });
}

async function begin(call: Job, controller: AbortController): Promise<void> {
  const { job } = call;
  try {
    controller.signal.throwIfAborted();
    await work(call, controller.signal);
  } catch (error) {
    if (controller.signal.aborted) reply({ type: 'cancelled', job });
    else reply({ type: 'error', job, message: error instanceof Error ? error.message : String(error) });
  } finally {
    jobs.delete(job);
  }
}

self.onmessage = ({ data: call }: MessageEvent<SuggestCall>) => {
  if (call.type === 'cancel') {
    jobs.get(call.job)?.abort();
    return;
  }
  const controller = new AbortController();
  jobs.set(call.job, controller);
  queue = queue.then(() => begin(call, controller));
};
