import { describe, expect, it } from 'vitest';
import { GifWriter, lzw } from '../../web/video/gif';
import { GifPalette } from '../../web/video/gif-palette';

/** LZW as a reader does it (GIF89a, appendix F). */
function unpack(bytes: Uint8Array): number[] {
  const out: number[] = [];
  let table: number[][] = [];
  let [size, held, bits] = [9, 0, 0];
  let last: number[] | null = null;
  const reset = () => {
    table = Array.from({ length: 258 }, (_, i) => (i < 256 ? [i] : []));
    size = 9;
    last = null;
  };
  reset();
  for (const byte of bytes) {
    held |= byte << bits;
    bits += 8;
    while (bits >= size) {
      const code = held & ((1 << size) - 1);
      held >>>= size;
      bits -= size;
      if (code === 256) {
        reset();
        continue;
      }
      if (code === 257) return out;
      const string: number[] = code < table.length ? table[code] : [...last!, last![0]];
      out.push(...string);
      if (last && table.length < 4096) table.push([...last, string[0]]);
      if (table.length === 1 << size && size < 12) size++;
      last = string;
    }
  }
  throw new Error('no end');
}

/** Pictures of a file as a viewer shows them: numbers of colours. */
function read(file: Uint8Array) {
  const short = (at: number) => file[at] | (file[at + 1] << 8);
  expect(String.fromCharCode(...file.subarray(0, 6))).toBe('GIF89a');
  const [width, height] = [short(6), short(8)];
  const colours = file.slice(13, 13 + 768);
  const screen = new Uint8Array(width * height);
  const frames: { delay: number; pixels: Uint8Array }[] = [];
  let at = 13 + 768;
  let [delay, clear, loops] = [0, -1, -1];
  const blocks = () => {
    const parts: number[] = [];
    for (; file[at]; at += file[at] + 1) parts.push(...file.subarray(at + 1, at + 1 + file[at]));
    at++;
    return Uint8Array.from(parts);
  };
  for (;;) {
    const kind = file[at++];
    if (kind === 0x3b) return { width, height, colours, frames, loops, end: at };
    if (kind === 0x21 && file[at] === 0xf9) {
      clear = file[at + 2] & 1 ? file[at + 5] : -1;
      delay = short(at + 3);
      at += 7;
    } else if (kind === 0x21) {
      at += 13;
      const data = blocks();
      loops = data[1] | (data[2] << 8);
    } else {
      expect(kind).toBe(0x2c);
      const [left, top, across, down] = [short(at), short(at + 2), short(at + 4), short(at + 6)];
      at += 9;
      expect(file[at++]).toBe(8);
      const part = unpack(blocks());
      expect(part).toHaveLength(across * down);
      part.forEach((value, i) => {
        if (value !== clear) screen[(top + Math.floor(i / across)) * width + left + (i % across)] = value;
      });
      frames.push({ delay, pixels: screen.slice() });
    }
  }
}

const noise = (length: number, colours: number, seed: number) => {
  let state = seed;
  return Uint8Array.from({ length }, () => (state = (state * 1103515245 + 12345) & 0x7fffffff) >> 8).map(
    (value) => value % colours,
  );
};

describe('LZW', () => {
  it.each([
    ['one pixel', Uint8Array.of(7)],
    ['one colour', new Uint8Array(5000)],
    ['noise, past several full tables', noise(60_000, 255, 1)],
    ['runs', Uint8Array.from({ length: 20_000 }, (_, i) => (i >> 5) % 200)],
  ])('%s comes back', (_, pixels) => {
    expect(unpack(lzw(pixels))).toEqual(Array.from(pixels));
  });

  it('makes runs small', () => expect(lzw(new Uint8Array(100_000)).length).toBeLessThan(800));
});

describe('GIF', () => {
  it('has its pictures, their time, and goes round for ever', () => {
    const [width, height] = [37, 23];
    const colours = Uint8Array.from({ length: 255 * 3 }, (_, i) => i % 256);
    const first = noise(width * height, 255, 2);
    const second = first.slice();
    for (let x = 5; x < 9; x++) second[11 * width + x] = (second[11 * width + x] + 1) % 255;
    const writer = new GifWriter(width, height, colours, 6);
    const wanted = [first, second, second, noise(width * height, 255, 3)];
    for (const picture of wanted) writer.add(picture);
    const file = writer.finish();
    const found = read(file);
    expect([found.width, found.height, found.loops, found.end]).toEqual([width, height, 0, file.length]);
    expect(found.colours.slice(0, 765)).toEqual(colours);
    expect(found.frames.map(({ delay }) => delay)).toEqual([6, 6, 6, 6]);
    found.frames.forEach(({ pixels }, i) => expect(pixels).toEqual(wanted[i]));
  });
});

describe('palette', () => {
  const picture = (colours: number[][]) => Uint8Array.from(colours.flatMap((colour) => [...colour, 255]));

  it('keeps a few colours as they are', () => {
    const palette = new GifPalette();
    const colours = [
      [13, 16, 21],
      [221, 225, 232],
      [106, 165, 234],
    ];
    palette.count(picture([...Array.from({ length: 500 }, () => colours[0]), colours[1], colours[2]]));
    palette.choose(255);
    expect(palette.colours.length).toBe(9);
    for (const [r, g, b] of colours) {
      const at = palette.indexOf(r, g, b) * 3;
      [r, g, b].forEach((value, k) => expect(Math.abs(palette.colours[at + k] - value)).toBeLessThanOrEqual(4));
    }
  });

  it('shows a colour between two of its own as a pattern that stands still, and its own as they are', () => {
    const palette = new GifPalette();
    const [dark, light] = [
      [40, 40, 48],
      [52, 52, 60],
    ];
    const flat = (colour: number[]) => picture(Array.from({ length: 64 }, () => colour));
    palette.count(flat(dark));
    palette.count(flat(light));
    palette.choose(255);
    const shown = (colour: number[]) => {
      const out = new Uint8Array(64);
      palette.indices(flat(colour), 8, out);
      return out;
    };
    expect(new Set(shown(dark)).size).toBe(1);
    expect(new Set(shown(light)).size).toBe(1);
    const between = shown([48, 48, 56]);
    const share = between.filter((index) => index === shown(light)[0]).length / between.length;
    expect(Math.abs(share - 0.5)).toBeLessThan(0.2);
    // The same in every 4 x 4.
    between.forEach((index, i) => expect(index).toBe(between[((i >> 3) & 3) * 8 + (i & 3)]));
  });

  it('stands for many colours with at most so many, none of them far off', () => {
    const palette = new GifPalette();
    const values = noise(30_000, 256, 4);
    const colours = Array.from({ length: 10_000 }, (_, i) => [
      values[i * 3],
      values[i * 3] >> 1,
      values[i * 3 + 1] >> 2,
    ]);
    palette.count(picture(colours));
    palette.choose(64);
    expect(palette.colours.length).toBeLessThanOrEqual(64 * 3);
    let worst = 0;
    for (const [r, g, b] of colours) {
      const at = palette.indexOf(r, g, b) * 3;
      const [p, q, s] = palette.colours.subarray(at, at + 3);
      worst = Math.max(worst, Math.abs(p - r), Math.abs(q - g), Math.abs(s - b));
    }
    expect(worst).toBeLessThan(48);
  });
});
