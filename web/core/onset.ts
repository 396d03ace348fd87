/** Onset strength: rise of the log mel spectrum from frame to frame (spectral flux; Boeck & Widmer 2013 review the family). */
import { applyBank, sparseBank, type SparseBank } from './spectrum';

/** Mel scale of Slaney's Auditory Toolbox: linear below 1 kHz, logarithmic above. */
const LINEAR_HZ_PER_MEL = 200 / 3;
const BREAK_HZ = 1000;
const BREAK_MEL = BREAK_HZ / LINEAR_HZ_PER_MEL;
const LOG_STEP = Math.log(6.4) / 27;

/** @returns mels (Slaney) of a frequency in hertz */
export function hertzToMel(hertz: number): number {
  return hertz < BREAK_HZ ? hertz / LINEAR_HZ_PER_MEL : BREAK_MEL + Math.log(hertz / BREAK_HZ) / LOG_STEP;
}

/** @returns hertz of a pitch in mels (Slaney) */
export function melToHertz(mel: number): number {
  return mel < BREAK_MEL ? mel * LINEAR_HZ_PER_MEL : BREAK_HZ * Math.exp((mel - BREAK_MEL) * LOG_STEP);
}

/**
 * Triangular mel filters of equal area (2 / width in hertz at the peak), from 0 Hz to half the sample rate.
 * @returns one row per band over bins 0 .. size/2 - 1
 */
export function melBank(bands: number, sampleRate: number, size: number): SparseBank {
  const top = hertzToMel(sampleRate / 2);
  const edges = Array.from({ length: bands + 2 }, (_, i) => melToHertz((top * i) / (bands + 1)));
  const rows = Array.from({ length: bands }, (_, b) => {
    const [low, peak, high] = [edges[b], edges[b + 1], edges[b + 2]];
    return Float64Array.from({ length: size / 2 }, (_, k) => {
      const hertz = (k * sampleRate) / size;
      const slope = Math.min((hertz - low) / (peak - low), (high - hertz) / (high - peak));
      return (Math.max(0, slope) * 2) / (high - low);
    });
  });
  return sparseBank(rows);
}

/** Mel bands that sound is measured in. */
export const MEL_BANDS = 128;
/** Numbers kept per frame: flux of all bands and of the parts that tell kick, snare and cymbals apart, and the level. */
export const FLUX_BANDS = 5;
/** Upper edges of the low and middle part, hertz. */
const LOW_HERTZ = 200;
const MIDDLE_HERTZ = 2000;
/** Mel power that counts as silence (-80 dB from a loud frame). */
const POWER_FLOOR = 3e-5;
/** The same for the level: digital silence is far below the quietest intro. */
const LEVEL_FLOOR = 1e-10;
const SILENT_DECIBELS = 10 * Math.log10(POWER_FLOOR);

/** Flux of successive spectra. */
export class FluxMeter {
  private readonly bank: SparseBank;
  private readonly power: Float32Array;
  private readonly level: Float32Array;
  private readonly history: Float32Array[];
  private readonly lowBands: number;
  private readonly middleBands: number;
  private seen = 0;

  /**
   * @param lag frames between the two spectra whose difference is taken
   */
  constructor(
    sampleRate: number,
    size: number,
    private readonly lag: number,
    private readonly bands = MEL_BANDS,
  ) {
    this.bank = melBank(bands, sampleRate, size);
    this.power = new Float32Array(size / 2);
    this.level = new Float32Array(bands);
    // Silence before the song: what sounds in the first frame begins there.
    this.history = Array.from({ length: lag }, () => new Float32Array(bands).fill(SILENT_DECIBELS));
    const perMel = (bands + 1) / hertzToMel(sampleRate / 2);
    this.lowBands = Math.round(hertzToMel(LOW_HERTZ) * perMel);
    this.middleBands = Math.round(hertzToMel(MIDDLE_HERTZ) * perMel);
  }

  /** Level of each mel band of the spectrum given last, decibels; overwritten by later ones. */
  get decibels(): Float32Array {
    return this.history[(this.seen + this.lag - 1) % this.lag];
  }

  /**
   * @param amplitudes amplitude spectrum that follows the one given before
   * @param out 5 numbers: mean rise in decibels over all bands, low, middle and high bands; level in decibels (mean of the bands' power)
   */
  next(amplitudes: Float32Array, out: Float32Array): Float32Array {
    const { power, level, bands } = this;
    for (let k = 0; k < power.length; k++) power[k] = amplitudes[k] * amplitudes[k];
    applyBank(this.bank, power, level);
    const before = this.history[this.seen % this.lag];
    out.fill(0);
    let sum = 0;
    for (let b = 0; b < bands; b++) {
      sum += level[b];
      const decibels = 10 * Math.log10(Math.max(POWER_FLOOR, level[b]));
      const rise = decibels - before[b];
      before[b] = decibels;
      if (rise > 0) out[b < this.lowBands ? 1 : b < this.middleBands ? 2 : 3] += rise;
    }
    this.seen++;
    out[0] = (out[1] + out[2] + out[3]) / bands;
    out[1] /= this.lowBands;
    out[2] /= this.middleBands - this.lowBands;
    out[3] /= bands - this.middleBands;
    out[4] = 10 * Math.log10(Math.max(LEVEL_FLOOR, sum / bands));
    return out;
  }
}
