/** Chroma: Meyda's filter bank on our spectra, then CENS post-processing (Mueller, Kurth & Clausen 2005). */
import Meyda from 'meyda';

/** Semitones of an octave, C first. */
export const PITCH_CLASSES = 12;

/** Shares of a frame's energy above which a pitch class gets one more quarter: logarithmic loudness steps of CENS. */
const QUANTISATION_STEPS = [0.4, 0.2, 0.1, 0.05] as const;

/** Meyda's settings are properties of one shared object, and its bundles wrap that object differently. */
interface MeydaSettings {
  sampleRate: number;
  bufferSize: number;
  chromaBands: number;
  chromaFilterBank?: number[][];
  extract(feature: string, signal: Float32Array): unknown;
}

/** Filters as a list per FFT bin: most bins feed one or two pitch classes only. */
export interface ChromaBank {
  bins: Uint16Array;
  classes: Uint8Array;
  weights: Float32Array;
}

/**
 * Meyda's chroma filters (after Ellis 2007, "Chroma feature analysis and synthesis") over bins 0 .. size/2 - 1, each bin's
 * weights scaled to length 1. That takes out Meyda's emphasis of the octaves around 880 Hz, which a constant-Q chroma does not
 * have: cosine to librosa's chroma_cens rises from 0.90 to 0.95.
 * @param sampleRate samples per second of the frames
 * @param size FFT size
 */
export function chromaBank(sampleRate: number, size: number): ChromaBank {
  const bundle = Meyda as unknown as MeydaSettings & { default?: MeydaSettings };
  const meyda = bundle.default ?? bundle;
  meyda.sampleRate = sampleRate;
  meyda.bufferSize = size;
  meyda.chromaBands = PITCH_CLASSES;
  // Meyda keeps the bank of the first settings it ever saw unless told to forget it.
  meyda.chromaFilterBank = undefined;
  meyda.extract('chroma', new Float32Array(size));
  const rows = meyda.chromaFilterBank as unknown as number[][];
  meyda.chromaFilterBank = undefined;
  const entries: [bin: number, pitchClass: number, weight: number][] = [];
  for (let bin = 0; bin < size / 2; bin++) {
    const length = Math.hypot(...rows.map((row) => row[bin]));
    if (length === 0) continue;
    rows.forEach((row, c) => {
      if (row[bin] > 1e-3 * length) entries.push([bin, c, row[bin] / length]);
    });
  }
  return {
    bins: Uint16Array.from(entries, (e) => e[0]),
    classes: Uint8Array.from(entries, (e) => e[1]),
    weights: Float32Array.from(entries, (e) => e[2]),
  };
}

/**
 * Chroma of one frame, not normalised.
 * @param amplitudes amplitude spectrum of the frame
 * @param out 12 numbers, C first
 */
export function chroma(bank: ChromaBank, amplitudes: Float32Array, out: Float32Array): Float32Array {
  const { bins, classes, weights } = bank;
  out.fill(0);
  for (let i = 0; i < bins.length; i++) out[classes[i]] += weights[i] * amplitudes[bins[i]];
  return out;
}

/** Odd-length Hann window of sum 1 that reaches zero just outside its ends; `length` in frames. */
export function hannWeights(length: number): Float64Array {
  const weights = Float64Array.from({ length }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * (i + 1)) / (length + 1)));
  const sum = weights.reduce((a, b) => a + b, 0);
  return weights.map((w) => w / sum);
}

/**
 * Chroma energy normalised statistics: L1-normalise each frame, quantise, smooth over time, L2-normalise.
 * Silent frames stay zero unless their neighbours sound.
 * @param raw frames x 12, not negative
 * @param window smoothing length in frames, odd
 * @returns frames x 12, each frame of length 1 or all zero
 */
export function cens(raw: Float32Array, window: number): Float32Array {
  const frames = raw.length / PITCH_CLASSES;
  const quantised = new Float32Array(raw.length);
  for (let f = 0; f < frames; f++) {
    const base = f * PITCH_CLASSES;
    let sum = 0;
    for (let c = 0; c < PITCH_CLASSES; c++) sum += raw[base + c];
    if (sum <= 0) continue;
    for (let c = 0; c < PITCH_CLASSES; c++) {
      const share = raw[base + c] / sum;
      let level = 0;
      for (const step of QUANTISATION_STEPS) if (share > step) level += 0.25;
      quantised[base + c] = level;
    }
  }
  return normaliseFrames(smoothFrames(quantised, hannWeights(window)));
}

/** Weighted moving average of each column; beyond the ends counts as zero. */
function smoothFrames(values: Float32Array, weights: Float64Array): Float32Array {
  const frames = values.length / PITCH_CLASSES;
  const reach = (weights.length - 1) / 2;
  const out = new Float32Array(values.length);
  for (let f = 0; f < frames; f++) {
    const from = Math.max(0, f - reach);
    const to = Math.min(frames - 1, f + reach);
    for (let g = from; g <= to; g++) {
      const weight = weights[g - f + reach];
      for (let c = 0; c < PITCH_CLASSES; c++) out[f * PITCH_CLASSES + c] += weight * values[g * PITCH_CLASSES + c];
    }
  }
  return out;
}

/** Scales each frame to Euclidean length 1, in place; all-zero frames stay. */
function normaliseFrames(values: Float32Array): Float32Array {
  for (let base = 0; base < values.length; base += PITCH_CLASSES) {
    let squares = 0;
    for (let c = 0; c < PITCH_CLASSES; c++) squares += values[base + c] ** 2;
    if (squares === 0) continue;
    const scale = 1 / Math.sqrt(squares);
    for (let c = 0; c < PITCH_CLASSES; c++) values[base + c] *= scale;
  }
  return values;
}
