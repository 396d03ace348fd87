/** Makes dances off the main thread: one job at a time, cancelled between windows. */
import type { UncorrectedDance } from '../core/finish';
import { generateMotion } from '../core/windows';
import { CurveEngine } from './curves-engine';
import { generateCurves } from '../core/curves-dance';
import { DanceEngine, type EngineOptions, type EngineState } from './onnx-engine';
import type { GenerateReply, GenerateRequest } from './protocol';

type Load = Extract<GenerateRequest, { type: 'load' }>;
type Generate = Extract<GenerateRequest, { type: 'generate' }>;

let engine: Promise<DanceEngine> | undefined;
let curveEngine: Promise<CurveEngine> | undefined;
const jobs = new Map<number, AbortController>();
/** Jobs run one after the other: two at once would only make both slow. */
let queue: Promise<void> = Promise.resolve();

function reply(message: GenerateReply, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

/** Lets messages in: a run on WASM never yields to them by itself. */
function breathe(): Promise<void> {
  return new Promise((resolve) => {
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
      channel.port1.close();
      resolve();
    };
    channel.port2.postMessage(null);
  });
}

async function load({ job, baseUrl, backend, threads, engine: name }: Load): Promise<void> {
  const options: EngineOptions = {
    folder: new URL('models/', baseUrl).href,
    backend,
    threads,
    onProgress: (bytes, totalBytes, cached) =>
      reply({ type: 'loading', job, fraction: totalBytes ? bytes / totalBytes : 1, bytes, totalBytes, cached }),
  };
  const onChange = (state: EngineState) => reply({ type: 'loaded', job, ...state });
  const before = await (name === 'curves' ? curveEngine : engine)?.catch(() => undefined);
  await before?.close();
  const opened =
    name === 'curves'
      ? (curveEngine = CurveEngine.open(options, onChange))
      : (engine = DanceEngine.open(options, onChange));
  reply({ type: 'loaded', job, ...(await opened).state });
}

async function generateByCurves(request: Generate, signal: AbortSignal): Promise<void> {
  const { job } = request;
  if (!curveEngine) throw new Error('The curves model is not loaded yet: wait until it is ready.');
  const engine = await curveEngine;
  const begin = performance.now();
  let windows = 0;
  const { motion, curves } = await generateCurves(
    request,
    async (inputs) => {
      await breathe();
      signal.throwIfAborted();
      const outputs = await engine.run(inputs);
      windows++;
      return outputs;
    },
    {
      signal,
      onProgress: (fraction) => reply({ type: 'partial', job, motion: null, fraction, windows }),
    },
  );
  const milliseconds = performance.now() - begin;
  const { backend, model } = engine.state;
  const buffers = [
    motion.root,
    motion.quaternions,
    curves.times,
    curves.keys,
    curves.inner,
    curves.shares,
    curves.shape,
  ];
  reply(
    { type: 'result', job, motion, curves, backend, model, windows, milliseconds },
    buffers.map((array) => array.buffer),
  );
}

async function generate(request: Generate, signal: AbortSignal): Promise<void> {
  const { job } = request;
  if (!engine) throw new Error('The dance model is not loaded yet: wait until it is ready.');
  const dancer = await engine;
  const begin = performance.now();
  let windows = 0;
  let uncorrected: UncorrectedDance | undefined;
  const motion = await generateMotion(
    request,
    async (inputs) => {
      await breathe();
      signal.throwIfAborted();
      const rows = await dancer.run(inputs);
      windows++;
      return rows;
    },
    {
      signal,
      onUncorrected: (made) => (uncorrected = made),
      onPartial: (part, fraction, done) => {
        // Parts are copies already, so their buffers can go.
        const transfer = part ? [part.root.buffer, part.quaternions.buffer] : [];
        reply({ type: 'partial', job, motion: part, fraction, windows: done }, transfer);
      },
    },
  );
  const milliseconds = performance.now() - begin;
  const { backend, model } = dancer.state;
  const given = [motion, ...(uncorrected ? [uncorrected.motion] : [])];
  reply(
    { type: 'result', job, motion, uncorrected, backend, model, windows, milliseconds },
    given.flatMap(({ root, quaternions }) => [root.buffer, quaternions.buffer]),
  );
}

async function work(request: Load | Generate, controller: AbortController): Promise<void> {
  const { job } = request;
  try {
    controller.signal.throwIfAborted();
    if (request.type === 'load') await load(request);
    else await (request.engine === 'curves' ? generateByCurves : generate)(request, controller.signal);
  } catch (error) {
    if (controller.signal.aborted) reply({ type: 'cancelled', job });
    else reply({ type: 'error', job, message: error instanceof Error ? error.message : String(error) });
  } finally {
    jobs.delete(job);
  }
}

self.onmessage = ({ data: request }: MessageEvent<GenerateRequest>) => {
  if (request.type === 'cancel') {
    jobs.get(request.job)?.abort();
    return;
  }
  const controller = new AbortController();
  jobs.set(request.job, controller);
  queue = queue.then(() => work(request, controller));
};
