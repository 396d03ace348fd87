/** Lowest and highest samples of a song in short buckets, for drawing it. */
import type { Waveform } from './types';

/** Buckets per second: a pixel or less each at the timeline's usual zoom. */
const WAVEFORM_RATE = 100;

/** Collects a waveform from samples that come in chunks. */
export class WaveformBuilder {
  private readonly min: Float32Array;
  private readonly max: Float32Array;
  private seen = 0;

  /** @param samples length of the song */
  constructor(
    private readonly sampleRate: number,
    samples: number,
  ) {
    const buckets = Math.ceil((samples / sampleRate) * WAVEFORM_RATE);
    this.min = new Float32Array(buckets);
    this.max = new Float32Array(buckets);
  }

  /** @param chunk mono samples that follow those given before */
  push(chunk: Float32Array): void {
    const { min, max, sampleRate } = this;
    for (let i = 0; i < chunk.length;) {
      const bucket = Math.floor(((this.seen + i) * WAVEFORM_RATE) / sampleRate);
      const end = Math.min(chunk.length, Math.ceil(((bucket + 1) * sampleRate) / WAVEFORM_RATE) - this.seen);
      if (bucket >= min.length) break;
      let low = min[bucket];
      let high = max[bucket];
      for (; i < end; i++) {
        if (chunk[i] < low) low = chunk[i];
        else if (chunk[i] > high) high = chunk[i];
      }
      min[bucket] = low;
      max[bucket] = high;
    }
    this.seen += chunk.length;
  }

  /** @returns a copy of what is known so far; buckets not reached yet are flat */
  snapshot(): Waveform {
    return { rate: WAVEFORM_RATE, min: this.min.slice(), max: this.max.slice() };
  }
}
