/** Writes an animated GIF (GIF89a) that goes round for ever. Pure: no DOM. */

/** Number of the colour that lets the picture before shine through. */
const CLEAR = 255;
/** Colours of a picture: the last number is {@link CLEAR}. */
export const GIF_COLOURS = 255;

/** Bytes that grow. */
class Bytes {
  private data = new Uint8Array(1 << 16);
  length = 0;

  put(...values: number[]): void {
    this.room(values.length);
    for (const value of values) this.data[this.length++] = value;
  }

  short(value: number): void {
    this.put(value & 255, value >> 8);
  }

  text(value: string): void {
    for (const char of value) this.put(char.charCodeAt(0));
  }

  /** In blocks of at most 255 bytes with their lengths before them, and an empty one at the end. */
  blocks(bytes: Uint8Array): void {
    for (let at = 0; at < bytes.length; at += 255) {
      const block = bytes.subarray(at, at + 255);
      this.put(block.length);
      this.room(block.length);
      this.data.set(block, this.length);
      this.length += block.length;
    }
    this.put(0);
  }

  take(): Uint8Array<ArrayBuffer> {
    return this.data.slice(0, this.length);
  }

  private room(more: number): void {
    if (this.length + more <= this.data.length) return;
    const larger = new Uint8Array(Math.max(this.data.length * 2, this.length + more));
    larger.set(this.data);
    this.data = larger;
  }
}

/** One animation, picture by picture. */
export class GifWriter {
  private readonly out = new Bytes();
  private before: Uint8Array | null = null;

  /**
   * @param colours at most {@link GIF_COLOURS}, 3 bytes each
   * @param centiseconds that each picture stays
   */
  constructor(
    private readonly width: number,
    private readonly height: number,
    colours: Uint8Array,
    private readonly centiseconds: number,
  ) {
    const { out } = this;
    out.text('GIF89a');
    out.short(width);
    out.short(height);
    out.put(0xf7, 0, 0); // 256 colours for all pictures
    const table = new Uint8Array(768);
    table.set(colours.subarray(0, GIF_COLOURS * 3));
    for (const value of table) out.put(value);
    out.put(0x21, 0xff, 11);
    out.text('NETSCAPE2.0');
    out.put(3, 1, 0, 0, 0); // for ever
  }

  /** Adds a picture: the number of each pixel's colour, width x height. Only what has changed is written. */
  add(indices: Uint8Array): void {
    const { out, width, before } = this;
    const { left, top, right, bottom } = before ? this.changed(before, indices) : this.whole();
    const [across, down] = [right - left, bottom - top];
    const part = new Uint8Array(across * down);
    for (let y = 0; y < down; y++)
      for (let x = 0; x < across; x++) {
        const at = (top + y) * width + left + x;
        part[y * across + x] = before && before[at] === indices[at] ? CLEAR : indices[at];
      }
    out.put(0x21, 0xf9, 4, before ? 0x05 : 0x04); // stays; from the second picture on with a clear colour
    out.short(this.centiseconds);
    out.put(CLEAR, 0);
    out.put(0x2c);
    for (const value of [left, top, across, down]) out.short(value);
    out.put(0);
    out.put(8);
    out.blocks(lzw(part));
    this.before = indices.slice();
  }

  /** The file. */
  finish(): Uint8Array<ArrayBuffer> {
    this.out.put(0x3b);
    return this.out.take();
  }

  private whole() {
    return { left: 0, top: 0, right: this.width, bottom: this.height };
  }

  /** The smallest box that holds all changes; one pixel where there are none. */
  private changed(before: Uint8Array, now: Uint8Array) {
    const box = { left: this.width, top: this.height, right: 0, bottom: 0 };
    for (let y = 0; y < this.height; y++)
      for (let x = 0; x < this.width; x++) {
        const at = y * this.width + x;
        if (before[at] === now[at]) continue;
        box.left = Math.min(box.left, x);
        box.right = Math.max(box.right, x + 1);
        box.top = Math.min(box.top, y);
        box.bottom = y + 1;
      }
    return box.right ? box : { left: 0, top: 0, right: 1, bottom: 1 };
  }
}

/** GIF's own LZW with codes of 9 to 12 bits, lowest bit first (GIF89a, appendix F). */
export function lzw(indices: Uint8Array): Uint8Array {
  const [RESET, END] = [256, 257];
  const out = new Bytes();
  // What a known string followed by a colour is called: the string's code x 256 + the colour.
  let known = new Map<number, number>();
  let [next, size] = [258, 9];
  let [held, bits] = [0, 0];
  const write = (code: number) => {
    held |= code << bits;
    bits += size;
    for (; bits >= 8; bits -= 8, held >>>= 8) out.put(held & 255);
  };
  write(RESET);
  let string = indices[0];
  for (let i = 1; i < indices.length; i++) {
    const key = (string << 8) | indices[i];
    const longer = known.get(key);
    if (longer !== undefined) {
      string = longer;
      continue;
    }
    write(string);
    string = indices[i];
    if (next === 4096) {
      write(RESET);
      known = new Map();
      [next, size] = [258, 9];
      continue;
    }
    if (next === 1 << size) size++;
    known.set(key, next++);
  }
  write(string);
  write(END);
  if (bits > 0) out.put(held & 255);
  return out.take();
}
