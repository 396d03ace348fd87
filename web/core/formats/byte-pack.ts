/**
 * Numbers, text and lists of times as few bytes, without loss. Whole numbers are LEB128 (7 bits a byte, least significant first);
 * signed ones are zigzag-folded before. What is read comes from anybody: every read is checked against the end of the bytes.
 */

/** Decimals tried before a number is written in full. */
const MAX_DECIMALS = 6;
/** In place of the number of decimals: eight bytes follow. */
const IN_FULL = 15;
/** Times that are whole numbers of these parts of a second need no fractions: seconds, halves, frames, milliseconds, microseconds. */
const SCALES = [1, 2, 30, 1000, 1e6] as const;
/** Ways to write a list of times. */
const WAY = { full: 0, steps: 1, even: 2 } as const;
/** Text longer than this is in no project of ours. */
const MAX_TEXT = 100_000;

/** Thrown by the reader for bytes that cannot be read; for callers only, who say it in a sentence. */
export class DamagedBytes extends Error {}

const damaged = () => new DamagedBytes('The bytes are damaged.');

/** Collects bytes. */
export class ByteWriter {
  readonly bytes: number[] = [];

  byte(value: number): void {
    this.bytes.push(value & 255);
  }

  /** @param value - 0 to 2^53 - 1 */
  whole(value: number): void {
    let rest = value;
    while (rest > 127) {
      this.bytes.push((rest % 128) + 128);
      rest = Math.floor(rest / 128);
    }
    this.bytes.push(rest);
  }

  /** @param value - A whole number; half the range of {@link whole}. */
  signed(value: number): void {
    this.whole(value < 0 ? -2 * value - 1 : 2 * value);
  }

  /** Eight bytes, little-endian. */
  full(value: number): void {
    this.bytes.push(...new Uint8Array(Float64Array.of(value).buffer));
  }

  /** Any number, in few bytes where it has few decimals. */
  number(value: number): void {
    for (let decimals = 0; decimals <= MAX_DECIMALS; decimals += 1) {
      const scaled = asWhole(value, 10 ** decimals);
      if (scaled === null) continue;
      this.byte(decimals);
      this.signed(scaled);
      return;
    }
    this.byte(IN_FULL);
    this.full(value);
  }

  /** What another writer holds, after how much that is. */
  part({ bytes }: ByteWriter): void {
    this.whole(bytes.length);
    for (const byte of bytes) this.bytes.push(byte);
  }

  text(value: string): void {
    const encoded = new TextEncoder().encode(value);
    this.whole(encoded.length);
    for (const byte of encoded) this.bytes.push(byte);
  }

  /**
   * Times, seconds, ascending; exact. A regular list costs a byte a time, which deflate makes next to nothing: what is written is how
   * far each one is from an even pace.
   */
  times(list: readonly number[]): void {
    this.whole(list.length);
    if (list.length === 0) return;
    const scale = SCALES.findIndex((each) => list.every((time) => asWhole(time, each) !== null));
    if (scale < 0) {
      this.byte(WAY.full);
      for (const time of list) this.full(time);
      return;
    }
    const ticks = list.map((time) => Math.round(time * SCALES[scale]));
    const pace = list.length > 1 ? (ticks[ticks.length - 1] - ticks[0]) / (list.length - 1) : 0;
    const off = ticks.map((tick, i) => tick - Math.round(ticks[0] + i * pace));
    const even = list.length > 2 && off.every((each) => Math.abs(each) < pace / 4);
    this.byte((even ? WAY.even : WAY.steps) + 4 * scale);
    this.signed(ticks[0]);
    if (even) {
      this.full(pace);
      for (const each of off.slice(1)) this.signed(each);
    } else {
      for (let i = 1; i < ticks.length; i += 1) this.signed(ticks[i] - ticks[i - 1]);
    }
  }
}

/** Reads what a {@link ByteWriter} wrote; every method throws {@link DamagedBytes} past the end or on nonsense. */
export class ByteReader {
  #at = 0;
  readonly #view: DataView;

  constructor(private readonly bytes: Uint8Array) {
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  /** True when everything was read. */
  get done(): boolean {
    return this.#at === this.bytes.length;
  }

  byte(): number {
    if (this.#at >= this.bytes.length) throw damaged();
    return this.bytes[this.#at++];
  }

  /** A byte as a number from -128 to 127. */
  small(): number {
    return (this.byte() << 24) >> 24;
  }

  whole(): number {
    let value = 0;
    let unit = 1;
    for (let i = 0; i < 8; i += 1) {
      const byte = this.byte();
      value += (byte & 127) * unit;
      if (byte < 128) {
        if (value > Number.MAX_SAFE_INTEGER) throw damaged();
        return value;
      }
      unit *= 128;
    }
    throw damaged();
  }

  signed(): number {
    const folded = this.whole();
    return folded % 2 === 1 ? -(folded + 1) / 2 : folded / 2;
  }

  full(): number {
    if (this.#at + 8 > this.bytes.length) throw damaged();
    const value = this.#view.getFloat64(this.#at, true);
    this.#at += 8;
    return value;
  }

  number(): number {
    const decimals = this.byte();
    if (decimals === IN_FULL) return this.full();
    if (decimals > MAX_DECIMALS) throw damaged();
    return this.signed() / 10 ** decimals;
  }

  /** A reader of what {@link ByteWriter.part} wrote. */
  part(): ByteReader {
    const length = this.whole();
    if (this.#at + length > this.bytes.length) throw damaged();
    return new ByteReader(this.bytes.subarray(this.#at, (this.#at += length)));
  }

  text(): string {
    const length = this.whole();
    if (length > MAX_TEXT || this.#at + length > this.bytes.length) throw damaged();
    const part = this.bytes.subarray(this.#at, (this.#at += length));
    try {
      return new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(part);
    } catch {
      throw damaged();
    }
  }

  /** How many things follow, each of at least one byte: more than there are bytes left is nonsense. */
  count(limit: number): number {
    const count = this.whole();
    if (count > limit || count > this.bytes.length - this.#at) throw damaged();
    return count;
  }

  times(limit: number): number[] {
    const count = this.count(limit);
    if (count === 0) return [];
    const head = this.byte();
    const way = head % 4;
    if (way === WAY.full) return Array.from({ length: count }, () => this.full());
    const scale = SCALES.at(Math.floor(head / 4));
    if (scale === undefined || way > WAY.even) throw damaged();
    const first = this.signed();
    const list = [first / scale];
    if (way === WAY.even) {
      const pace = this.full();
      for (let i = 1; i < count; i += 1) list.push((Math.round(first + i * pace) + this.signed()) / scale);
    } else {
      for (let i = 1, tick = first; i < count; i += 1) list.push((tick += this.signed()) / scale);
    }
    return list;
  }
}

/** A number as a whole number of parts, where dividing by that gives exactly the number again. */
function asWhole(value: number, parts: number): number | null {
  const whole = Math.round(value * parts);
  return Math.abs(whole) < 2 ** 51 && !Object.is(whole, -0) && whole / parts === value ? whole : null;
}
