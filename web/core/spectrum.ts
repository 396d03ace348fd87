/** Amplitude spectra of windowed frames: the same numbers as Meyda's `amplitudeSpectrum`, by a real-input FFT. */

/**
 * Amplitude spectrum of real frames of one size (a power of two, at least 4), Hann-windowed.
 * Meyda's own FFT makes an object per butterfly and takes most of its time; this one allocates nothing per frame.
 */
export class SpectrumAnalyser {
  readonly size: number;
  /** Amplitudes of bins 0 .. size/2 - 1; overwritten by the next `analyse`. */
  readonly amplitudes: Float32Array;
  private readonly window: Float64Array;
  private readonly real: Float64Array;
  private readonly imaginary: Float64Array;
  private readonly cosines: Float64Array;
  private readonly sines: Float64Array;
  private readonly reversed: Uint32Array;
  /** Twiddle factors of each radix-4 pass: w^2, w, w^3 (real, imaginary) for each step in a block. */
  private readonly passes: Float64Array[];

  /** @throws RangeError for a size that is no power of two */
  constructor(size: number) {
    if (size < 4 || (size & (size - 1)) !== 0) throw new RangeError(`FFT size must be a power of two, got ${size}.`);
    const half = size / 2;
    this.size = size;
    this.amplitudes = new Float32Array(half);
    this.real = new Float64Array(half);
    this.imaginary = new Float64Array(half);
    // Symmetric Hann, as Meyda's.
    this.window = Float64Array.from({ length: size }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / (size - 1)));
    this.cosines = Float64Array.from({ length: half }, (_, k) => Math.cos((2 * Math.PI * k) / size));
    this.sines = Float64Array.from({ length: half }, (_, k) => Math.sin((2 * Math.PI * k) / size));
    const bits = Math.log2(half);
    this.reversed = Uint32Array.from({ length: half }, (_, i) => {
      let result = 0;
      for (let b = 0; b < bits; b++) result |= ((i >> b) & 1) << (bits - 1 - b);
      return result;
    });
    this.passes = [];
    for (let span = bits % 2 === 1 ? 2 : 1; span < half; span *= 4) {
      const turns = Array.from({ length: span }, (_, k) => (-2 * Math.PI * k) / (4 * span));
      this.passes.push(
        Float64Array.from(
          turns.flatMap((t) => [2 * t, t, 3 * t].flatMap((angle) => [Math.cos(angle), Math.sin(angle)])),
        ),
      );
    }
  }

  /**
   * @param samples at least offset + size samples
   * @param offset first sample of the frame
   * @returns `amplitudes`
   */
  analyse(samples: Float32Array, offset = 0): Float32Array {
    const { size, real, imaginary, window, reversed } = this;
    const half = size / 2;
    // Even samples as real part, odd as imaginary: one complex FFT of half the size does a real frame.
    const at = offset | 0;
    for (let i = 0; i < half; i++) {
      const target = reversed[i];
      real[target] = samples[at + 2 * i] * window[2 * i];
      imaginary[target] = samples[at + 2 * i + 1] * window[2 * i + 1];
    }
    this.transform(half);
    this.separate(half);
    return this.amplitudes;
  }

  /** In-place FFT of `real`, `imaginary`, whose input is bit-reversed: radix 4, after one radix-2 pass where the size asks for it. */
  private transform(length: number): void {
    let span = 1;
    if (Math.log2(length) % 2 === 1) {
      this.pairs(length);
      span = 2;
    }
    for (const twiddles of this.passes) {
      this.quadruples(length, span, twiddles);
      span *= 4;
    }
  }

  /** Radix-2 pass over neighbours. */
  private pairs(length: number): void {
    const { real, imaginary } = this;
    for (let a = 0; a < length; a += 2) {
      const re = real[a + 1];
      const im = imaginary[a + 1];
      real[a + 1] = real[a] - re;
      imaginary[a + 1] = imaginary[a] - im;
      real[a] += re;
      imaginary[a] += im;
    }
  }

  /** Radix-4 pass: two radix-2 passes (spans `span` and 2 `span`) in one, with 3 complex products per 4 numbers. */
  private quadruples(length: number, span: number, twiddles: Float64Array): void {
    const { real, imaginary } = this;
    for (let block = 0; block < length; block += 4 * span) {
      for (let k = 0, w = 0; k < span; k++, w += 6) {
        const a = block + k;
        const b = a + span;
        const c = b + span;
        const d = c + span;
        const bRe = real[b] * twiddles[w] - imaginary[b] * twiddles[w + 1];
        const bIm = real[b] * twiddles[w + 1] + imaginary[b] * twiddles[w];
        const cRe = real[c] * twiddles[w + 2] - imaginary[c] * twiddles[w + 3];
        const cIm = real[c] * twiddles[w + 3] + imaginary[c] * twiddles[w + 2];
        const dRe = real[d] * twiddles[w + 4] - imaginary[d] * twiddles[w + 5];
        const dIm = real[d] * twiddles[w + 5] + imaginary[d] * twiddles[w + 4];
        const sumRe = real[a] + bRe;
        const sumIm = imaginary[a] + bIm;
        const lessRe = real[a] - bRe;
        const lessIm = imaginary[a] - bIm;
        real[a] = sumRe + (cRe + dRe);
        imaginary[a] = sumIm + (cIm + dIm);
        real[c] = sumRe - (cRe + dRe);
        imaginary[c] = sumIm - (cIm + dIm);
        real[b] = lessRe + (cIm - dIm);
        imaginary[b] = lessIm - (cRe - dRe);
        real[d] = lessRe - (cIm - dIm);
        imaginary[d] = lessIm + (cRe - dRe);
      }
    }
  }

  /** Splits the packed spectrum into that of the real frame and takes absolute values. */
  private separate(half: number): void {
    const { real, imaginary, cosines, sines, amplitudes } = this;
    for (let k = 0; k < half; k++) {
      const mirror = k === 0 ? 0 : half - k;
      const evenRe = (real[k] + real[mirror]) / 2;
      const evenIm = (imaginary[k] - imaginary[mirror]) / 2;
      const oddRe = (imaginary[k] + imaginary[mirror]) / 2;
      const oddIm = (real[mirror] - real[k]) / 2;
      const re = evenRe + oddRe * cosines[k] + oddIm * sines[k];
      const im = evenIm + oddIm * cosines[k] - oddRe * sines[k];
      amplitudes[k] = Math.sqrt(re * re + im * im);
    }
  }
}

/** Rows of a filter bank with their leading and trailing zeros left out. */
export interface SparseBank {
  /** First bin of each row. */
  starts: Uint32Array;
  rows: Float32Array[];
}

/** @param rows dense filters, each over the same bins; weights below `least` count as zero */
export function sparseBank(rows: ArrayLike<number>[], least = 0): SparseBank {
  const starts = new Uint32Array(rows.length);
  const kept = rows.map((row, r) => {
    let from = 0;
    let to = row.length;
    while (from < to && Math.abs(row[from]) <= least) from++;
    while (to > from && Math.abs(row[to - 1]) <= least) to--;
    starts[r] = from;
    return Float32Array.from({ length: to - from }, (_, i) => row[from + i]);
  });
  return { starts, rows: kept };
}

/** Writes bank x values into `out` (one number per row). */
export function applyBank(bank: SparseBank, values: Float32Array, out: Float32Array): Float32Array {
  for (let r = 0; r < bank.rows.length; r++) {
    const row = bank.rows[r];
    const start = bank.starts[r];
    const end = Math.min(row.length, values.length - start);
    let sum = 0;
    for (let i = 0; i < end; i++) sum += row[i] * values[start + i];
    out[r] = sum;
  }
  return out;
}
