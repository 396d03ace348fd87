/** Analyses songs: one job at a time, a chunk per message, so that a cancel is heard between chunks. */
import { FeatureExtractor } from '../core/features';
import { spec } from '../core/spec';
import type { Features } from '../core/types';
import type { AnalyseReply, AnalyseRequest } from './protocol';

/** Seconds whose features are sent ahead. */
const HEAD_SECONDS = 10;
/** The waveform so far goes with the progress at most this often, milliseconds. */
const WAVEFORM_INTERVAL = 200;

interface Job {
  id: number;
  samples: number;
  received: number;
  extractor: FeatureExtractor;
  begun: number;
  waveformSent: number;
  isHeadSent: boolean;
}

let current: Job | null = null;

const reply = (message: AnalyseReply, transfer: Transferable[] = []): void => {
  (self as unknown as DedicatedWorkerGlobalScope).postMessage(message, transfer);
};

const buffers = ({ data, timbre }: Features): Transferable[] => [data.buffer, ...(timbre ? [timbre.buffer] : [])];

function begin(id: number, sampleRate: number, samples: number): void {
  if (current) reply({ type: 'cancelled', job: current.id });
  if (!(samples > 0) || !(sampleRate > 0)) throw new Error('There is no sound to analyse.');
  current = {
    id,
    samples,
    received: 0,
    extractor: new FeatureExtractor(sampleRate, samples),
    begun: performance.now(),
    waveformSent: 0,
    isHeadSent: false,
  };
}

function take(job: Job, pcm: Float32Array): void {
  const { id, extractor } = job;
  extractor.push(pcm);
  job.received += pcm.length;
  const now = performance.now();
  const isWaveformDue = job.waveformSent === 0 || now - job.waveformSent > WAVEFORM_INTERVAL;
  if (isWaveformDue) job.waveformSent = now;
  const waveform = isWaveformDue ? extractor.wave() : undefined;
  reply(
    { type: 'progress', job: id, fraction: Math.min(1, job.received / job.samples), waveform },
    waveform ? [waveform.min.buffer, waveform.max.buffer] : [],
  );
  if (!job.isHeadSent && extractor.frames >= HEAD_SECONDS * spec.fps) {
    job.isHeadSent = true;
    const head = extractor.head();
    reply({ type: 'head', job: id, ...head }, buffers(head.features));
  }
  if (job.received < job.samples) return;
  current = null;
  const { features, grid, waveform: whole } = extractor.finish();
  const milliseconds = performance.now() - job.begun;
  reply({ type: 'result', job: id, features, grid, waveform: whole, milliseconds }, [
    ...buffers(features),
    whole.min.buffer,
    whole.max.buffer,
  ]);
}

self.onmessage = ({ data }: MessageEvent<AnalyseRequest>) => {
  try {
    if (data.type === 'begin') begin(data.job, data.sampleRate, data.samples);
    // Chunks of a job that is over may still be under way.
    else if (current?.id !== data.job) return;
    else if (data.type === 'chunk') take(current, data.pcm);
    else {
      current = null;
      reply({ type: 'cancelled', job: data.job });
    }
  } catch (error) {
    current = null;
    reply({ type: 'error', job: data.job, message: error instanceof Error ? error.message : String(error) });
  }
};
