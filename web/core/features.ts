/** Music features of a song: 12 chroma, beat, downbeat and onset per frame (spec.json), made chunk by chunk. */
import { findBars } from './beats-bars';
import { followTempo, normaliseEnvelope, trackBeats } from './beats';
import { cens, chroma, chromaBank, PITCH_CLASSES } from './chroma';
import { FLUX_BANDS, FluxMeter, percentile } from './onset';
import { Resampler } from './resample';
import { spec } from './spec';
import { SpectrumAnalyser } from './spectrum';
import type { BeatGrid, Features, Waveform } from './types';
import { WaveformBuilder } from './waveform';

const COLUMNS = spec.features.names.length;
const BEAT = spec.features.names.indexOf('beat');
const DOWNBEAT = spec.features.names.indexOf('downbeat');
const ONSET = spec.features.names.indexOf('onset');
const SIZE = spec.features.fftSize;
/** Flux frames per feature frame: beats are found on a finer grid than they are stored. */
const SUBFRAMES = 3;
const FLUX_HOP = spec.features.hop / SUBFRAMES;
const FLUX_RATE = spec.fps * SUBFRAMES;
/** Flux compares spectra this many flux frames apart. */
const FLUX_LAG = 3;
/** A spectrum feels a sound before its centre reaches it: flux peaks this many flux frames early. */
const FLUX_DELAY = 2;
/** Smoothing of CENS, frames: 0.7 s. */
const CENS_FRAMES = 21;
/** Share of a song's onsets that lie below strength 1. */
const ONSET_PERCENTILE = 0.98;

/** Everything found in a song. */
export interface Analysis {
  features: Features;
  grid: BeatGrid;
  waveform: Waveform;
}

/** @returns frames of a song: ceil(duration x fps) */
export function frameCount(samples: number, sampleRate: number): number {
  return Math.ceil((samples / sampleRate) * spec.fps);
}

/** Numbers that arrive one frame at a time. */
class Rows {
  data: Float32Array;
  count = 0;
  constructor(readonly width: number) {
    this.data = new Float32Array(width * 1024);
  }
  /** @returns a view of the new row, to be written by the caller */
  add(): Float32Array {
    if ((this.count + 1) * this.width > this.data.length) {
      const larger = new Float32Array(this.data.length * 2);
      larger.set(this.data);
      this.data = larger;
    }
    const from = this.count++ * this.width;
    return this.data.subarray(from, from + this.width);
  }
}

/** Analyses a song that arrives in chunks; the result does not depend on how it is cut. */
export class FeatureExtractor {
  private readonly resampler: Resampler;
  private readonly waveform: WaveformBuilder;
  private readonly spectrum = new SpectrumAnalyser(SIZE);
  private readonly bank = chromaBank(spec.features.sampleRate, SIZE);
  private readonly flux = new FluxMeter(spec.features.sampleRate, SIZE, FLUX_LAG);
  private readonly chromaRows = new Rows(PITCH_CLASSES);
  private readonly fluxRows = new Rows(FLUX_BANDS);
  /** Resampled sound from `start` on; begins half a frame before the song. */
  private buffer = new Float32Array(1 << 16);
  private start = -SIZE / 2;
  private held = SIZE / 2;

  /**
   * @param sampleRate of the song
   * @param samples length of the song
   */
  constructor(
    private readonly sampleRate: number,
    private readonly samples: number,
  ) {
    this.resampler = new Resampler(sampleRate, spec.features.sampleRate);
    this.waveform = new WaveformBuilder(sampleRate, samples);
  }

  /** Seconds whose features are known. */
  get seconds(): number {
    return this.chromaRows.count / spec.fps;
  }

  /** @param pcm mono samples that follow those given before */
  push(pcm: Float32Array): void {
    this.waveform.push(pcm);
    this.take(this.resampler.push(pcm));
  }

  private take(sound: Float32Array): void {
    if (this.held + sound.length > this.buffer.length) {
      const larger = new Float32Array(2 * (this.held + sound.length));
      larger.set(this.buffer.subarray(0, this.held));
      this.buffer = larger;
    }
    this.buffer.set(sound, this.held);
    this.held += sound.length;
    let at = this.fluxRows.count * FLUX_HOP - SIZE / 2 - this.start;
    for (; at + SIZE <= this.held; at += FLUX_HOP) {
      const amplitudes = this.spectrum.analyse(this.buffer, at);
      if (this.fluxRows.count % SUBFRAMES === 0) chroma(this.bank, amplitudes, this.chromaRows.add());
      this.flux.next(amplitudes, this.fluxRows.add());
    }
    const drop = Math.min(at, this.held);
    this.buffer.copyWithin(0, drop, this.held);
    this.held -= drop;
    this.start += drop;
  }

  /** Features of what has been heard so far, as if the song ended there. */
  head(): { features: Features; grid: BeatGrid } {
    return this.assemble(this.chromaRows.count);
  }

  /** @returns everything; call once, after the last `push` */
  finish(): Analysis {
    this.take(this.resampler.flush());
    const frames = frameCount(this.samples, this.sampleRate);
    // The last frames look past the end: feed silence until they are all there.
    while (this.chromaRows.count < frames || this.fluxRows.count < frames * SUBFRAMES)
      this.take(new Float32Array(SIZE));
    return { ...this.assemble(frames), waveform: this.waveform.snapshot() };
  }

  private assemble(frames: number): { features: Features; grid: BeatGrid } {
    const data = new Float32Array(frames * COLUMNS);
    const smooth = cens(this.chromaRows.data.slice(0, frames * PITCH_CLASSES), CENS_FRAMES);
    const envelope = this.fluxColumn(0, frames * SUBFRAMES);
    const onset = new Float32Array(frames);
    for (let f = 0; f < frames; f++) {
      for (let c = 0; c < PITCH_CLASSES; c++) data[f * COLUMNS + c] = smooth[f * PITCH_CLASSES + c];
      onset[f] = envelope[f * SUBFRAMES];
    }
    const top = percentile(onset, ONSET_PERCENTILE);
    if (top > 0) for (let f = 0; f < frames; f++) data[f * COLUMNS + ONSET] = Math.min(1, onset[f] / top);
    const features: Features = { fps: spec.fps, names: spec.features.names, frames, data };
    const grid = this.findGrid(envelope, smooth);
    return { features: withGrid(features, grid), grid };
  }

  /** One column of the flux, moved so that its peaks stand at the sounds. */
  private fluxColumn(band: number, count: number): Float32Array {
    return Float32Array.from({ length: count }, (_, i) => {
      const row = i - FLUX_DELAY;
      return row < 0 || row >= this.fluxRows.count ? 0 : this.fluxRows.data[row * FLUX_BANDS + band];
    });
  }

  private findGrid(envelope: Float32Array, smooth: Float32Array): BeatGrid {
    const normal = normaliseEnvelope(envelope, FLUX_RATE);
    if (!envelope.some((v) => v > 0)) return { tempo: 120, beatsPerBar: 4, beats: [], downbeats: [] };
    const curve = followTempo(normal, FLUX_RATE);
    const positions = trackBeats(normal, FLUX_RATE, curve);
    const beats = positions.map((p) => p / FLUX_RATE);
    const low = this.fluxColumn(1, envelope.length);
    const peak = (values: ArrayLike<number>, p: number): number => {
      let best = 0;
      for (let i = Math.round(p) - 3; i <= Math.round(p) + 3; i++) best = Math.max(best, values[i] ?? 0);
      return best;
    };
    const frames = smooth.length / PITCH_CLASSES;
    const change = beats.map((b) => {
      const period = 60 / 120;
      const before = Math.max(0, Math.round((b - 0.5 * period) * spec.fps));
      const after = Math.min(frames - 1, Math.round((b + 0.5 * period) * spec.fps));
      let dot = 0;
      for (let c = 0; c < PITCH_CLASSES; c++)
        dot += smooth[before * PITCH_CLASSES + c] * smooth[after * PITCH_CLASSES + c];
      return 1 - dot;
    });
    const bars = findBars({
      onset: positions.map((p) => peak(envelope, p)),
      low: positions.map((p) => peak(low, p)),
      change,
    });
    const gaps = beats.slice(1).map((b, i) => b - beats[i]);
    return {
      tempo: gaps.length ? 60 / percentile(gaps, 0.5) : 120,
      beatsPerBar: bars.beatsPerBar,
      beats,
      downbeats: beats.filter((_, i) => i % bars.beatsPerBar === bars.first),
    };
  }
}

/**
 * @param pcm mono samples of a whole song
 * @returns the same as a FeatureExtractor that got the song in chunks
 */
export function analyse(pcm: Float32Array, sampleRate: number): Analysis {
  const extractor = new FeatureExtractor(sampleRate, pcm.length);
  const chunk = 1 << 16;
  for (let at = 0; at < pcm.length; at += chunk) extractor.push(pcm.subarray(at, at + chunk));
  return extractor.finish();
}

/**
 * @param grid beats as edited by the user
 * @returns the same features with the beat and downbeat columns written anew (1 in frame round(time x fps), else 0)
 */
export function withGrid(features: Features, grid: BeatGrid): Features {
  const data = features.data.slice();
  for (let f = 0; f < features.frames; f++) data[f * COLUMNS + BEAT] = data[f * COLUMNS + DOWNBEAT] = 0;
  const mark = (times: readonly number[], columns: number[]): void => {
    for (const time of times) {
      const frame = Math.round(time * features.fps);
      if (frame >= 0 && frame < features.frames) for (const column of columns) data[frame * COLUMNS + column] = 1;
    }
  };
  mark(grid.beats, [BEAT]);
  mark(grid.downbeats, [BEAT, DOWNBEAT]);
  return { ...features, data };
}
