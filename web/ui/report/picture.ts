/** Draws the picture of two dances (paper A, figure 8): music on top, below it each dance as a strip of figures, key poses framed. */
import { clockTime, lowerBound } from '../../app/snapping';
import type { BeatGrid, Features, Waveform } from '../../core/types';
import { diamond, fit, font, write, type Brush } from '../../video/brush';
import { PAGE, pictureX } from './picture-layout';
import { PALETTE, tint } from '../palette';

/** One dance of the picture. */
export interface Strip {
  /** Name of its starting clip. */
  name: string;
  note: string;
  figures: { time: number; key: boolean; image: CanvasImageSource }[];
}

/** What the picture shows. */
export interface PictureContent {
  title: string;
  range: { start: number; end: number };
  tempo: number | null;
  grid: BeatGrid | null;
  waveform: Waveform | null;
  features: Features | null;
  strips: Strip[];
  exact: boolean;
}

const COLOURS = {
  ...PALETTE,
  panel: PALETTE.surface,
  keySoft: tint(PALETTE.key, 0.13),
  musicDim: tint(PALETTE.music, 0.32),
  left: '#6fa8ff',
  right: '#ff8f6b',
};

type Box = { top: number; height: number };

/** Draws onto a canvas of its own. */
export function drawPicture(content: PictureContent): HTMLCanvasElement {
  const canvas = document.createElement('canvas');
  canvas.width = PAGE.width;
  canvas.height = PAGE.height;
  const brush = canvas.getContext('2d');
  if (!brush) throw new Error('This browser cannot draw the picture: close other tabs and try again.');
  brush.fillStyle = COLOURS.ground;
  brush.fillRect(0, 0, PAGE.width, PAGE.height);
  drawTitle(brush, content);
  for (const box of [PAGE.music, ...PAGE.strips]) panel(brush, box);
  drawBeats(brush, content);
  drawMusic(brush, content);
  content.strips.forEach((strip, i) => drawStrip(brush, content, strip, PAGE.strips[i]));
  drawAxis(brush, content);
  drawLegend(brush, content);
  return canvas;
}

function drawTitle(brush: Brush, { title, range, tempo, strips }: PictureContent): void {
  brush.textBaseline = 'alphabetic';
  brush.textAlign = 'left';
  const shown = fit(brush, title, 1780, font(48, 650));
  write(brush, shown, PAGE.margin, 84, font(48, 650), COLOURS.text);
  const speed = tempo ? `, ${Math.round(tempo)} beats a minute` : '';
  const about = `${clockTime(range.start)} to ${clockTime(range.end)}${speed}. The same music and key poses, danced from two starting clips: ${strips
    .map((strip) => strip.name)
    .join(' and ')}.`;
  write(brush, fit(brush, about, 2200, font(26)), PAGE.margin, 130, font(26), COLOURS.muted);
  brush.textAlign = 'right';
  const mark = write(brush, 'Posebeat', PAGE.right, 80, font(30, 650), COLOURS.text);
  brush.textAlign = 'left';
  diamond(brush, PAGE.right - mark - 28, 69, 12, COLOURS.key);
}

function panel(brush: Brush, { top, height }: Box): void {
  brush.fillStyle = COLOURS.panel;
  brush.beginPath();
  brush.roundRect(PAGE.margin, top, PAGE.width - PAGE.margin * 2 + 24, height, 16);
  brush.fill();
}

/** Beats run through everything, so that the eye can follow them down to the figures. */
function drawBeats(brush: Brush, { grid, range }: PictureContent): void {
  if (!grid) return;
  const downbeats = new Set(grid.downbeats);
  const last = lowerBound(grid.beats, range.end);
  for (let i = lowerBound(grid.beats, range.start); i < last; i += 1) {
    const x = Math.round(pictureX(range, grid.beats[i]));
    const strong = downbeats.has(grid.beats[i]);
    brush.fillStyle = strong ? 'rgba(76, 201, 240, 0.6)' : 'rgba(76, 201, 240, 0.22)';
    for (const { top, height } of [PAGE.music, ...PAGE.strips]) brush.fillRect(x, top, strong ? 2 : 1, height);
  }
}

function drawMusic(brush: Brush, { range, waveform, features }: PictureContent): void {
  const { top, height } = PAGE.music;
  label(brush, PAGE.music, 'Music', 'waveform, onsets', COLOURS.music);
  const middle = top + height * 0.42;
  const seconds = (range.end - range.start) / (PAGE.right - PAGE.left);
  if (waveform) {
    const { min, max, rate } = waveform;
    let peak = 0.02;
    const each = (x: number) => {
      const from = Math.floor((range.start + (x - PAGE.left) * seconds) * rate);
      const to = Math.max(from + 1, Math.floor((range.start + (x + 1 - PAGE.left) * seconds) * rate));
      let [low, high] = [0, 0];
      for (let i = Math.max(0, from); i < Math.min(max.length, to); i += 1) {
        low = Math.min(low, min[i]);
        high = Math.max(high, max[i]);
      }
      return [low, high];
    };
    for (let x = PAGE.left; x < PAGE.right; x += 1) {
      const [low, high] = each(x);
      peak = Math.max(peak, high, -low);
    }
    brush.fillStyle = COLOURS.music;
    const reach = height * 0.36;
    for (let x = PAGE.left; x < PAGE.right; x += 1) {
      const [low, high] = each(x);
      brush.fillRect(x, middle - (high / peak) * reach, 1, Math.max(1, ((high - low) / peak) * reach));
    }
  }
  const column = features?.names.indexOf('onset') ?? -1;
  if (!features || column < 0) return;
  const bar = (PAGE.right - PAGE.left) / ((range.end - range.start) * features.fps);
  brush.fillStyle = COLOURS.musicDim;
  const end = Math.min(features.frames, Math.ceil(range.end * features.fps));
  for (let t = Math.max(0, Math.ceil(range.start * features.fps)); t < end; t += 1) {
    const tall = features.data[t * features.names.length + column] * height * 0.2;
    brush.fillRect(pictureX(range, t / features.fps), top + height - 8 - tall, Math.max(1, bar - 2), tall);
  }
}

function label(brush: Brush, { top, height }: Box, name: string, note: string, colour: string): void {
  brush.textBaseline = 'alphabetic';
  const x = PAGE.margin + 24;
  brush.fillStyle = colour;
  brush.fillRect(PAGE.margin, top + 16, 5, height - 32);
  const room = PAGE.left - x - 48;
  const face = font(28, 620);
  write(brush, fit(brush, name, room, face), x, top + height / 2 - 4, face, COLOURS.text);
  write(brush, fit(brush, note, room, font(21)), x, top + height / 2 + 30, font(21), COLOURS.muted);
}

function drawStrip(brush: Brush, { range }: PictureContent, strip: Strip, box: Box): void {
  label(brush, box, strip.name, strip.note, COLOURS.motion);
  const base = box.top + box.height - 22;
  const top = base - PAGE.figure + 4;
  const xs = strip.figures.map((figure) => pictureX(range, figure.time));
  brush.fillStyle = COLOURS.line;
  brush.fillRect(PAGE.left - 40, base, PAGE.right - PAGE.left + 52, 2);
  const keys = strip.figures.map((figure, i) => ({ x: xs[i], key: figure.key })).filter((each) => each.key);
  const frame = ({ x }: { x: number }, i: number) => {
    const beside = Math.min(x - (keys[i - 1]?.x ?? -Infinity), (keys[i + 1]?.x ?? Infinity) - x);
    const width = Math.max(40, Math.min(156, beside - 8));
    brush.beginPath();
    brush.roundRect(x - width / 2, box.top + 12, width, base - box.top - 2, 12);
  };
  brush.fillStyle = COLOURS.keySoft;
  keys.forEach((key, i) => {
    frame(key, i);
    brush.fill();
  });
  const stand = (index: number) => {
    const { image } = strip.figures[index];
    brush.drawImage(image, xs[index] - PAGE.figure / 2, top, PAGE.figure, PAGE.figure);
  };
  // Key poses stand before their neighbours.
  strip.figures.forEach((figure, i) => !figure.key && stand(i));
  strip.figures.forEach((figure, i) => figure.key && stand(i));
  brush.strokeStyle = COLOURS.key;
  brush.lineWidth = 4;
  keys.forEach((key, i) => {
    frame(key, i);
    brush.stroke();
  });
}

function drawAxis(brush: Brush, { range }: PictureContent): void {
  brush.textAlign = 'center';
  brush.textBaseline = 'top';
  const { top } = PAGE.axis;
  for (let second = Math.ceil(range.start - 1e-6); second <= range.end + 1e-6; second += 1) {
    const x = pictureX(range, second);
    brush.fillStyle = COLOURS.muted;
    brush.fillRect(x - 1, top, 2, 10);
    write(brush, String(second), x, top + 16, font(24), COLOURS.muted);
  }
  brush.textAlign = 'left';
  write(brush, 'time, s', PAGE.margin + 24, top + 16, font(24), COLOURS.muted);
}

function drawLegend(brush: Brush, { exact }: PictureContent): void {
  const y = PAGE.legend.top;
  brush.textAlign = 'left';
  brush.textBaseline = 'middle';
  let x: number = PAGE.left;
  const entry = (draw: (at: number) => number, text: string) => {
    x += draw(x) + 14;
    x += write(brush, text, x, y + 1, font(24), COLOURS.muted) + 52;
  };
  entry(
    (at) => {
      brush.strokeStyle = COLOURS.key;
      brush.fillStyle = COLOURS.keySoft;
      brush.lineWidth = 4;
      brush.beginPath();
      brush.roundRect(at, y - 16, 26, 32, 6);
      brush.fill();
      brush.stroke();
      return 26;
    },
    exact ? 'key pose, hit exactly' : 'key pose',
  );
  entry((at) => {
    brush.fillStyle = 'rgba(76, 201, 240, 0.3)';
    brush.fillRect(at, y - 16, 2, 32);
    brush.fillStyle = COLOURS.music;
    brush.fillRect(at + 14, y - 16, 3, 32);
    return 17;
  }, 'beat, first beat of a bar');
  for (const [colour, text] of [
    [COLOURS.left, 'left limbs'],
    [COLOURS.right, 'right limbs'],
  ]) {
    entry((at) => {
      brush.fillStyle = colour;
      brush.beginPath();
      brush.arc(at + 11, y, 11, 0, 2 * Math.PI);
      brush.fill();
      return 22;
    }, text);
  }
}
