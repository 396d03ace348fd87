/** Music features of a song: 12 chroma, beat, downbeat and onset per frame (spec.json), made chunk by chunk. */
import { findGrid, type GridEvidence } from './beats-grid';
import { cens, chroma, chromaBank, PITCH_CLASSES } from './chroma';
import { FrameCutter, Rows } from './features-stream';
import { Cepstrum, MFCC_COUNT, TIMBRE_SIZE } from './mfcc';
import { percentile } from './interpolate';
import { FLUX_BANDS, FluxMeter, MEL_BANDS } from './onset';
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
const SUBFRAMES = 2;
/** Flux compares spectra one feature frame apart. */
const FLUX_LAG = SUBFRAMES;
/** The onset column stands this many flux frames (33 ms) after the rise, where librosa and the dataset's features have it. */
const ONSET_DELAY = SUBFRAMES;
/** Chroma is taken from slow sound: the same FFT then tells semitones apart down to the bass. */
const CHROMA_RATE = spec.features.sampleRate / 4;
/** Feature frames per chroma frame; CENS smooths over far more. */
const CHROMA_STEP = 2;
/** Smoothing of CENS, frames: 0.7 s. */
const CENS_FRAMES = 21;
/** Where a row of the flux has the level. */
const LEVEL = 4;
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

/** Analyses a song that arrives in chunks; the result does not depend on how it is cut. */
export class FeatureExtractor {
  private readonly resampler: Resampler;
  private readonly decimator = new Resampler(spec.features.sampleRate, CHROMA_RATE);
  private readonly waveform: WaveformBuilder;
  private readonly spectrum = new SpectrumAnalyser(SIZE);
  private readonly bank = chromaBank(CHROMA_RATE, SIZE);
  private readonly flux = new FluxMeter(spec.features.sampleRate, SIZE, FLUX_LAG);
  private readonly chromaRows = new Rows(PITCH_CLASSES);
  private readonly fluxRows = new Rows(FLUX_BANDS);
  private readonly cepstrum = new Cepstrum(MEL_BANDS);
  private readonly timbreRows = new Rows(TIMBRE_SIZE);
  private readonly fluxFrames = new FrameCutter(spec.features.sampleRate, SIZE, spec.fps * SUBFRAMES);
  private readonly chromaFrames = new FrameCutter(CHROMA_RATE, SIZE, spec.fps / CHROMA_STEP);

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

  /** Feature frames that are known now. */
  get frames(): number {
    const chromaFrames = (this.chromaRows.count - 1) * CHROMA_STEP + 1;
    return Math.max(0, Math.min(chromaFrames, Math.floor(this.fluxRows.count / SUBFRAMES)));
  }

  /** @param pcm mono samples that follow those given before */
  push(pcm: Float32Array): void {
    this.waveform.push(pcm);
    this.take(this.resampler.push(pcm));
  }

  /** Waveform so far. */
  wave(): Waveform {
    return this.waveform.snapshot();
  }

  private take(sound: Float32Array): void {
    this.fluxFrames.push(sound, (samples, offset) => {
      const row = this.flux.next(this.spectrum.analyse(samples, offset), this.fluxRows.add());
      if ((this.fluxRows.count - 1) % SUBFRAMES !== 0) return;
      // The mel bands are there already: the cepstrum costs next to nothing.
      const timbre = this.timbreRows.add();
      this.cepstrum.transform(this.flux.decibels, timbre);
      timbre[MFCC_COUNT] = row[LEVEL];
    });
    this.chromaFrames.push(this.decimator.push(sound), (samples, offset) => {
      chroma(this.bank, this.spectrum.analyse(samples, offset), this.chromaRows.add());
    });
  }

  /** Features of what has been heard so far, as if the song ended there. */
  head(): { features: Features; grid: BeatGrid } {
    return this.assemble(this.frames);
  }

  /** @returns everything; call once, after the last `push` */
  finish(): Analysis {
    this.take(this.resampler.flush());
    const frames = frameCount(this.samples, this.sampleRate);
    // The last frames look past the end: feed silence until they are all there.
    while (this.frames < frames) this.take(new Float32Array(SIZE));
    return { ...this.assemble(frames), waveform: this.wave() };
  }

  /** What the beat search works on, for `frames` feature frames. */
  evidence(frames: number): GridEvidence {
    const count = frames * SUBFRAMES;
    const [all, low, middle, high, level] = [0, 1, 2, 3, 4].map((band) => this.fluxRows.column(band, count));
    return {
      rate: spec.fps * SUBFRAMES,
      all,
      low,
      middle,
      high,
      level,
      fps: spec.fps,
      chroma: this.chromaColumns(frames),
    };
  }

  /** CENS at the feature rate: between chroma frames by linear interpolation. */
  private chromaColumns(frames: number): Float32Array {
    const raw = new Float32Array(frames * PITCH_CLASSES);
    const { data, count } = this.chromaRows;
    for (let f = 0; f < frames; f++) {
      const below = Math.min(count - 1, Math.floor(f / CHROMA_STEP));
      const above = Math.min(count - 1, below + 1);
      const share = f / CHROMA_STEP - below;
      for (let c = 0; c < PITCH_CLASSES; c++) {
        raw[f * PITCH_CLASSES + c] =
          data[below * PITCH_CLASSES + c] * (1 - share) + data[above * PITCH_CLASSES + c] * share;
      }
    }
    return cens(raw, CENS_FRAMES);
  }

  private assemble(frames: number): { features: Features; grid: BeatGrid } {
    const evidence = this.evidence(frames);
    const data = new Float32Array(frames * COLUMNS);
    const onset = Float32Array.from({ length: frames }, (_, f) => evidence.all[f * SUBFRAMES - ONSET_DELAY] ?? 0);
    const top = percentile(onset, ONSET_PERCENTILE);
    for (let f = 0; f < frames; f++) {
      data.set(evidence.chroma.subarray(f * PITCH_CLASSES, (f + 1) * PITCH_CLASSES), f * COLUMNS);
      data[f * COLUMNS + ONSET] = top > 0 ? Math.min(1, onset[f] / top) : 0;
    }
    const grid = findGrid(evidence);
    const timbre = this.timbreRows.data.slice(0, frames * TIMBRE_SIZE);
    return { features: withGrid({ fps: spec.fps, names: spec.features.names, frames, data, timbre }, grid), grid };
  }
}

/**
 * Analyses a song in one go.
 * @param pcm mono samples of a whole song
 * @param sampleRate samples per second
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
