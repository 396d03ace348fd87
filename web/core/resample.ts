/** Sample-rate conversion by a windowed-sinc polyphase filter, chunk by chunk. */

/** Zero crossings of the sinc on each side: sets the steepness of the low-pass. */
const ZERO_CROSSINGS = 8;
/** Share of the smaller Nyquist frequency that passes: the rest is the filter's transition band. */
const ROLL_OFF = 0.88;
/** Kaiser shape: about 70 dB of stop-band attenuation (Kaiser 1974). */
const KAISER_BETA = 7;

function greatestCommonDivisor(a: number, b: number): number {
  return b === 0 ? a : greatestCommonDivisor(b, a % b);
}

/** Modified Bessel function of the first kind, order 0, by its power series. */
function besselI0(x: number): number {
  let sum = 1;
  let term = 1;
  for (let k = 1; term > 1e-12 * sum; k++) {
    term *= (x / (2 * k)) ** 2;
    sum += term;
  }
  return sum;
}

/** Sum of taps[k] x values[from + k]: four sums side by side, since one alone would wait for each addition to finish. */
function dot(taps: Float64Array, values: Float64Array, from: number): number {
  // Says that this is a whole number: a double as index costs several times as much.
  const at = from | 0;
  const length = taps.length;
  let a = 0;
  let b = 0;
  let c = 0;
  let d = 0;
  let k = 0;
  for (; k + 3 < length; k += 4) {
    a += taps[k] * values[at + k];
    b += taps[k + 1] * values[at + k + 1];
    c += taps[k + 2] * values[at + k + 2];
    d += taps[k + 3] * values[at + k + 3];
  }
  for (; k < length; k++) a += taps[k] * values[at + k];
  return a + b + (c + d);
}

/**
 * Streaming resampler without delay: output sample n is the band-limited input at time n / toRate.
 * The output does not depend on how the input is cut into chunks.
 */
export class Resampler {
  private readonly up: number;
  private readonly down: number;
  private readonly reach: number;
  private readonly cutoff: number;
  private readonly phases: Float64Array[] = [];
  /** Input samples from `start` on; starts with silence before sample 0. */
  private buffer: Float64Array;
  private start: number;
  private held: number;
  private produced = 0;
  private received = 0;

  /**
   * @param fromRate input samples per second, a multiple of 0.5 above 0
   * @param toRate output samples per second, a multiple of 0.5 above 0
   * @throws RangeError for a rate that is not positive
   */
  constructor(fromRate: number, toRate: number) {
    const from = Math.round(fromRate * 2);
    const to = Math.round(toRate * 2);
    if (!(from > 0 && to > 0)) throw new RangeError(`Sample rates must be positive, got ${fromRate} and ${toRate}.`);
    const divisor = greatestCommonDivisor(from, to);
    this.up = to / divisor;
    this.down = from / divisor;
    this.cutoff = Math.min(1, to / from) * (this.up === this.down ? 1 : ROLL_OFF);
    this.reach = Math.ceil(ZERO_CROSSINGS / this.cutoff);
    this.buffer = new Float64Array(4096 + 2 * this.reach);
    this.start = -this.reach;
    this.held = this.reach;
  }

  /** Filter taps for an output sample that lies `phase / up` after an input sample; made when first needed. */
  private taps(phase: number): Float64Array {
    const known = this.phases[phase];
    if (known) return known;
    const taps = new Float64Array(2 * this.reach + 1);
    const scale = besselI0(KAISER_BETA);
    let sum = 0;
    for (let i = 0; i < taps.length; i++) {
      const x = i - this.reach - phase / this.up;
      const inside = 1 - (x / (this.reach + 1)) ** 2;
      const sinc = x === 0 ? 1 : Math.sin(Math.PI * x * this.cutoff) / (Math.PI * x * this.cutoff);
      taps[i] = (sinc * besselI0(KAISER_BETA * Math.sqrt(Math.max(0, inside)))) / scale;
      sum += taps[i];
    }
    // Every phase passes a constant unchanged; without this the phases ripple against each other.
    for (let i = 0; i < taps.length; i++) taps[i] /= sum;
    return (this.phases[phase] = taps);
  }

  /**
   * @param chunk input samples that follow those given before
   * @returns the output samples that can be known now
   */
  push(chunk: Float32Array): Float32Array {
    if (this.up === this.down) {
      this.received += chunk.length;
      this.produced += chunk.length;
      return chunk.slice();
    }
    if (this.held + chunk.length > this.buffer.length) {
      const larger = new Float64Array(2 * (this.held + chunk.length));
      larger.set(this.buffer.subarray(0, this.held));
      this.buffer = larger;
    }
    this.buffer.set(chunk, this.held);
    this.held += chunk.length;
    this.received += chunk.length;
    return this.drain(Math.ceil(((this.start + this.held - this.reach) * this.up) / this.down));
  }

  /** @returns the rest of the output, the input taken as silent from here on: ceil(inputs x to / from) samples in all */
  flush(): Float32Array {
    const total = Math.ceil((this.received * this.up) / this.down);
    if (this.up === this.down) return new Float32Array(0);
    const silence = new Float32Array(2 * this.reach + 1);
    const received = this.received;
    const first = this.push(silence);
    this.received = received;
    const keep = Math.max(0, first.length - (this.produced - total));
    this.produced = total;
    return first.subarray(0, keep);
  }

  /** Makes output samples up to `end` (exclusive) and forgets the input that no later sample needs. */
  private drain(end: number): Float32Array {
    const { up, down, reach, buffer } = this;
    const out = new Float32Array(Math.max(0, end - this.produced));
    for (let i = 0; i < out.length; i++) {
      const position = (this.produced + i) * down;
      const whole = Math.floor(position / up);
      out[i] = dot(this.taps(position - whole * up), buffer, whole - reach - this.start);
    }
    this.produced += out.length;
    const needed = Math.floor((this.produced * down) / up) - reach;
    const drop = Math.min(this.held, needed - this.start);
    if (drop > 0) {
      buffer.copyWithin(0, drop, this.held);
      this.held -= drop;
      this.start += drop;
    }
    return out;
  }
}

/**
 * @param pcm mono samples
 * @returns the same sound at another rate, ceil(length x toRate / fromRate) samples
 */
export function resample(pcm: Float32Array, fromRate: number, toRate: number): Float32Array {
  const resampler = new Resampler(fromRate, toRate);
  const head = resampler.push(pcm);
  const tail = resampler.flush();
  const out = new Float32Array(head.length + tail.length);
  out.set(head);
  out.set(tail, head.length);
  return out;
}
