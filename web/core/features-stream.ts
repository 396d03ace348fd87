/** Small parts of the streaming analysis: frames cut from sound that arrives in pieces, and rows of numbers that grow. */

/** Cuts overlapping frames, frame k centred on second k / framesPerSecond; before sample 0 there is silence. */
export class FrameCutter {
  private buffer: Float32Array;
  /** Sample number of buffer[0]. */
  private start: number;
  private held: number;
  private next = 0;

  constructor(
    private readonly sampleRate: number,
    private readonly size: number,
    private readonly framesPerSecond: number,
  ) {
    this.buffer = new Float32Array(16 * size);
    this.start = -size / 2;
    this.held = size / 2;
  }

  /**
   * @param sound samples that follow those given before
   * @param onFrame gets each complete frame as `size` samples from `offset`, valid during the call only
   */
  push(sound: Float32Array, onFrame: (samples: Float32Array, offset: number) => void): void {
    if (this.held + sound.length > this.buffer.length) {
      const larger = new Float32Array(2 * (this.held + sound.length));
      larger.set(this.buffer.subarray(0, this.held));
      this.buffer = larger;
    }
    this.buffer.set(sound, this.held);
    this.held += sound.length;
    for (; this.offset() + this.size <= this.held; this.next++) onFrame(this.buffer, this.offset());
    const drop = Math.min(this.offset(), this.held);
    this.buffer.copyWithin(0, drop, this.held);
    this.held -= drop;
    this.start += drop;
  }

  /** Place of the next frame in the buffer. */
  private offset(): number {
    return Math.round((this.next * this.sampleRate) / this.framesPerSecond) - this.size / 2 - this.start;
  }
}

/** A table of numbers that grows by rows. */
export class Rows {
  data: Float32Array;
  count = 0;

  constructor(readonly width: number) {
    this.data = new Float32Array(width * 1024);
  }

  /** @returns a view of a new row, to be written at once */
  add(): Float32Array {
    if ((this.count + 1) * this.width > this.data.length) {
      const larger = new Float32Array(this.data.length * 2);
      larger.set(this.data);
      this.data = larger;
    }
    const from = this.count++ * this.width;
    return this.data.subarray(from, from + this.width);
  }

  /**
   * @param count rows wanted; those not known are zero
   * @param delay rows of zeros to put before
   */
  column(index: number, count: number, delay = 0): Float32Array {
    const out = new Float32Array(count);
    const end = Math.min(count, this.count + delay);
    for (let i = delay; i < end; i++) out[i] = this.data[(i - delay) * this.width + index];
    return out;
  }
}
