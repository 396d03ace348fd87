/** The song's samples under a video, exact to the sample. Pure: no DOM. */
import type { FramePlan } from './options';

/** Samples of the song: one or two channels. */
export interface Sound {
  sampleRate: number;
  channels: Float32Array<ArrayBuffer>[];
}

/** What is used of an AudioBuffer. */
export interface SampleSource {
  sampleRate: number;
  length: number;
  numberOfChannels: number;
  getChannelData(channel: number): Float32Array;
}

/** Where the song is cut in the middle it comes and goes over this long, seconds: a hard cut would click. */
const EDGE = 0.008;

/**
 * The samples from the first frame's time to the end of the last frame. What lies outside the song is silence.
 * @returns copies; a song of more than two channels gives its first two
 */
export function soundOf(buffer: SampleSource, plan: FramePlan): Sound {
  const { sampleRate } = buffer;
  const first = Math.round(plan.start * sampleRate);
  const length = Math.max(1, Math.round((plan.frames / plan.fps) * sampleRate));
  const edge = Math.min(Math.round(EDGE * sampleRate), length >> 1);
  const channels = Array.from({ length: Math.min(2, buffer.numberOfChannels) }, (_, channel) => {
    const samples = new Float32Array(length);
    const from = Math.max(0, -first);
    samples.set(buffer.getChannelData(channel).subarray(Math.max(0, first), Math.max(0, first + length)), from);
    for (let i = 0; i < edge; i++) {
      if (first > 0) samples[i] *= i / edge;
      if (first + length < buffer.length) samples[length - 1 - i] *= i / edge;
    }
    return samples;
  });
  return { sampleRate, channels };
}

/** Samples [from, to) of a sound, one channel after the other, as encoders take them. */
export function planar({ channels }: Sound, from: number, to: number): Float32Array<ArrayBuffer> {
  const out = new Float32Array((to - from) * channels.length);
  channels.forEach((samples, channel) => out.set(samples.subarray(from, to), channel * (to - from)));
  return out;
}
