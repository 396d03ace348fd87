/** Mel-frequency cepstrum (Davis & Mermelstein 1980), in the form of librosa's `feature.mfcc`, which the dataset's stored features have. */

/** Coefficients kept, the first (the overall level) included. */
export const MFCC_COUNT = 13;
/** Numbers of a row of `Features.timbre`: the coefficients, then the energy in decibels. */
export const TIMBRE_SIZE = MFCC_COUNT + 1;
/** Frames on each side that a difference looks at: librosa's width of nine. */
const DELTA_REACH = 4;

/** Orthonormal cosine transform (DCT-II) of one row of mel bands, its first 13 numbers. */
export class Cepstrum {
  private readonly basis: Float64Array;

  /** @param bands mel bands of a row */
  constructor(private readonly bands: number) {
    this.basis = new Float64Array(MFCC_COUNT * bands);
    for (let k = 0; k < MFCC_COUNT; k++) {
      const scale = Math.sqrt((k === 0 ? 1 : 2) / bands);
      for (let b = 0; b < bands; b++) this.basis[k * bands + b] = scale * Math.cos((Math.PI * (b + 0.5) * k) / bands);
    }
  }

  /**
   * @param decibels level of each mel band
   * @param out gets 13 coefficients
   */
  transform(decibels: Float32Array, out: Float32Array): void {
    const { basis, bands } = this;
    for (let k = 0; k < MFCC_COUNT; k++) {
      let sum = 0;
      for (let b = 0; b < bands; b++) sum += basis[k * bands + b] * decibels[b];
      out[k] = sum;
    }
  }
}

/**
 * Slope of each column over nine frames by least squares; rows beyond the ends repeat the first and the last.
 * @param values frames x width, row-major
 * @returns as many numbers, per frame
 */
export function deltas(values: ArrayLike<number>, width: number): Float64Array {
  const frames = values.length / width;
  const out = new Float64Array(values.length);
  let scale = 0;
  for (let n = 1; n <= DELTA_REACH; n++) scale += 2 * n * n;
  for (let f = 0; f < frames; f++) {
    for (let n = 1; n <= DELTA_REACH; n++) {
      const after = Math.min(frames - 1, f + n) * width;
      const before = Math.max(0, f - n) * width;
      for (let c = 0; c < width; c++) out[f * width + c] += (n * (values[after + c] - values[before + c])) / scale;
    }
  }
  return out;
}
