/** 256 colours for many pictures: median cut (Heckbert 1982) over a histogram of 6 bits a channel. Pure: no DOM. */

/** Bits of a channel that colours are told apart by. */
const BITS = 6;
const SHIFT = 8 - BITS;
const LEVELS = 1 << BITS;
const BINS = LEVELS ** 3;

/** Thresholds of ordered dithering, 4 x 4 (Bayer 1973), and by how many levels they move a colour: as far as those of a calm ground lie apart. */
const BAYER = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5].map((rank) => (rank + 0.5) / 16 - 0.5);
const DITHER = 6;

const binOf = (r: number, g: number, b: number) => ((r >> SHIFT) << (2 * BITS)) | ((g >> SHIFT) << BITS) | (b >> SHIFT);

/** Colours of a box of the histogram. */
interface Box {
  bins: Uint32Array;
  pixels: number;
  /** Axis with the widest spread (0 red, 1 green, 2 blue), and how wide it is. */
  axis: number;
  spread: number;
}

const channel = (bin: number, axis: number) => (bin >> ((2 - axis) * BITS)) & (LEVELS - 1);

/** Counts the colours of pictures, then says which stand for them. */
export class GifPalette {
  private readonly counts = new Uint32Array(BINS);
  private nearest: Int16Array | null = null;
  /** Colours, 3 bytes each; empty until {@link choose}. */
  colours = new Uint8Array(0);

  /** Counts a picture, RGBA. */
  count(pixels: ArrayLike<number>): void {
    for (let i = 0; i < pixels.length; i += 4) this.counts[binOf(pixels[i], pixels[i + 1], pixels[i + 2])]++;
  }

  /** Chooses at most so many colours. */
  choose(most: number): void {
    const used: number[] = [];
    for (let bin = 0; bin < BINS; bin++) if (this.counts[bin] > 0) used.push(bin);
    const boxes = [this.box(Uint32Array.from(used))];
    while (boxes.length < most) {
      // The box that errs most: wide and full. The root lets the few pixels of a figure weigh against a large ground.
      let worst = 0;
      const weight = ({ spread, pixels }: Box) => spread * spread * Math.sqrt(pixels);
      boxes.forEach((box, i) => weight(box) > weight(boxes[worst]) && (worst = i));
      const box = boxes[worst];
      if (box.spread === 0) break;
      boxes.splice(worst, 1, ...this.halves(box));
    }
    this.colours = Uint8Array.from(boxes.flatMap((box) => this.mean(box)));
    this.nearest = new Int16Array(BINS).fill(-1);
  }

  /** The number of the colour nearest to one. */
  indexOf(r: number, g: number, b: number): number {
    const bin = binOf(r, g, b);
    const known = this.nearest![bin];
    if (known >= 0) return known;
    // What is looked for is the middle of the bin: one answer for all of its colours.
    const middle = [0, 1, 2].map((axis) => (channel(bin, axis) + 0.5) * (1 << SHIFT));
    let [best, least] = [0, Infinity];
    for (let i = 0; i < this.colours.length; i += 3) {
      // The eye is keenest on green, then red.
      const away =
        2 * (this.colours[i] - middle[0]) ** 2 +
        4 * (this.colours[i + 1] - middle[1]) ** 2 +
        (this.colours[i + 2] - middle[2]) ** 2;
      if (away < least) [best, least] = [i / 3, away];
    }
    this.nearest![bin] = best;
    return best;
  }

  /**
   * The numbers of a picture's colours. Slow changes of colour become patterns instead of bands; they stand still, so what does not move
   * stays as it is from picture to picture.
   * @param pixels RGBA, `width` to a row
   */
  indices(pixels: ArrayLike<number>, width: number, out: Uint8Array): void {
    for (let i = 0; i < out.length; i++) {
      const moved = DITHER * BAYER[((Math.floor(i / width) & 3) << 2) | ((i % width) & 3)];
      const level = (channel: number) => Math.max(0, Math.min(255, pixels[i * 4 + channel] + moved));
      out[i] = this.indexOf(level(0), level(1), level(2));
    }
  }

  private box(bins: Uint32Array): Box {
    let pixels = 0;
    const [low, high] = [
      [LEVELS, LEVELS, LEVELS],
      [0, 0, 0],
    ];
    for (const bin of bins) {
      pixels += this.counts[bin];
      for (let axis = 0; axis < 3; axis++) {
        low[axis] = Math.min(low[axis], channel(bin, axis));
        high[axis] = Math.max(high[axis], channel(bin, axis));
      }
    }
    const spreads = high.map((value, axis) => Math.max(0, value - low[axis]));
    const spread = Math.max(...spreads);
    return { bins, pixels, axis: spreads.indexOf(spread), spread };
  }

  /** Cuts a box where half of its pixels are on either side. */
  private halves({ bins, pixels, axis }: Box): [Box, Box] {
    const sorted = bins.slice().sort((a, b) => channel(a, axis) - channel(b, axis));
    let [at, sum] = [0, 0];
    while (at < sorted.length - 1 && sum + this.counts[sorted[at]] <= pixels / 2) sum += this.counts[sorted[at++]];
    // Never inside one level, or the same cut would come up for ever.
    const level = channel(sorted[Math.max(at, 1)], axis);
    let cut = sorted.findIndex((bin) => channel(bin, axis) === level);
    if (cut === 0) cut = sorted.findIndex((bin) => channel(bin, axis) > level);
    return [this.box(sorted.slice(0, cut)), this.box(sorted.slice(cut))];
  }

  private mean({ bins, pixels }: Box): number[] {
    return [0, 1, 2].map((axis) => {
      let sum = 0;
      for (const bin of bins) sum += this.counts[bin] * (channel(bin, axis) + 0.5);
      return Math.min(255, Math.floor((sum / Math.max(1, pixels)) * (1 << SHIFT)));
    });
  }
}
