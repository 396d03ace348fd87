/** Draws the still parts of the timeline on one canvas: ruler, waveform, beats, onsets, ranges. */
import { lowerBound } from '../../app/snapping';
import type { LoopRange } from '../../audio/player';
import type { TimelineView } from '../../app/state';
import type { Section } from '../../core/sections';
import type { BeatGrid, Features, KeyPose, Waveform } from '../../core/types';
import { buildPyramid, forEachColumn, type Pyramid } from './pyramid';
import { barStep, LANES, LANES_HEIGHT, timeToX, xToTime } from './geometry';
import { PALETTE, tint } from '../palette';

/** What is drawn. */
export interface Picture {
  view: TimelineView;
  width: number;
  duration: number;
  waveform: Waveform | null;
  features: Features | null;
  grid: BeatGrid | null;
  loop: LoopRange | null;
  /** Parts of the song; none where they are not clear. */
  sections: readonly Section[];
  keys: readonly KeyPose[];
  /** Of `keyWidths` at this scale. */
  widths: readonly number[];
  selection: ReadonlySet<string>;
  /** Seconds up to which the dance is made, and whether it is up to date. */
  danced: number;
  stale: boolean;
  generating: boolean;
}

const COLOURS = {
  lane: '#12171e',
  laneAlt: '#151b23',
  end: PALETTE.ground,
  line: 'rgba(255,255,255,0.055)',
  bar: 'rgba(255,255,255,0.16)',
  text: '#9aa7b8',
  music: PALETTE.music,
  musicDim: tint(PALETTE.music, 0.45),
  beat: tint(PALETTE.music, 0.16),
  downbeat: tint(PALETTE.music, 0.38),
  loop: tint(PALETTE.music, 0.16),
  key: tint(PALETTE.key, 0.7),
  keyChosen: '#ffd08f',
  motion: PALETTE.motion,
  motionDim: tint(PALETTE.motion, 0.35),
};
/** Beats closer than this are not drawn, bars are thinned out instead. */
const MIN_BEAT_PIXELS = 9;
const MIN_BAR_PIXELS = 18;
const MIN_NUMBER_PIXELS = 44;

/** How strongly parts of the song are shaded, by their letter. */
const SECTION_SHADES = [0.02, 0.1, 0.055, 0.14];
/** A song quieter than this is drawn quiet. */
const QUIET = 0.05;

const waves = new WeakMap<Waveform, { pyramid: Pyramid; peak: number }>();

/** A waveform at every scale, and its loudest sample, so that every song fills its lane. */
function waveOf(waveform: Waveform): { pyramid: Pyramid; peak: number } {
  let wave = waves.get(waveform);
  if (!wave) {
    const pyramid = buildPyramid(waveform.min, waveform.max);
    const top = pyramid.levels[pyramid.levels.length - 1];
    wave = { pyramid, peak: Math.max(0, top.max[0] ?? 0, -(top.min[0] ?? 0)) };
    waves.set(waveform, wave);
  }
  return wave;
}

const onsets = new WeakMap<Features, Pyramid>();

function onsetOf(features: Features): Pyramid {
  let pyramid = onsets.get(features);
  if (!pyramid) {
    const column = features.names.indexOf('onset');
    const onset = new Float32Array(features.frames);
    if (column >= 0)
      for (let t = 0; t < onset.length; t += 1) onset[t] = features.data[t * features.names.length + column];
    pyramid = buildPyramid(onset, onset);
    onsets.set(features, pyramid);
  }
  return pyramid;
}

type Brush = CanvasRenderingContext2D;

/** Draws everything; `ratio` is the device's pixels per CSS pixel. */
export function drawTimeline(canvas: HTMLCanvasElement, picture: Picture, ratio: number): void {
  const pixels = Math.round(picture.width * ratio);
  if (canvas.width !== pixels) canvas.width = pixels;
  if (canvas.height !== Math.round(LANES_HEIGHT * ratio)) canvas.height = Math.round(LANES_HEIGHT * ratio);
  const brush = canvas.getContext('2d');
  if (!brush || picture.view.pixelsPerSecond <= 0) return;
  brush.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawLanes(brush, picture);
  drawLoop(brush, picture);
  drawBeats(brush, picture);
  drawSections(brush, picture);
  drawWaveform(brush, picture);
  drawOnsets(brush, picture);
  drawKeyStems(brush, picture);
  drawDanced(brush, picture);
}

function drawLanes(brush: Brush, { width, view, duration }: Picture): void {
  brush.clearRect(0, 0, width, LANES_HEIGHT);
  const start = Math.max(0, timeToX(view, 0));
  const end = Math.min(width, timeToX(view, duration));
  brush.fillStyle = COLOURS.laneAlt;
  brush.fillRect(start, 0, end - start, LANES_HEIGHT);
  brush.fillStyle = COLOURS.lane;
  brush.fillRect(start, LANES.wave.top, end - start, LANES.wave.height + LANES.onset.height);
  brush.fillStyle = COLOURS.line;
  for (const lane of [LANES.beats, LANES.wave, LANES.keys, LANES.ranges])
    brush.fillRect(start, lane.top, end - start, 1);
}

function drawLoop(brush: Brush, { loop, view }: Picture): void {
  if (!loop) return;
  const x = timeToX(view, loop.start);
  const width = timeToX(view, loop.end) - x;
  brush.fillStyle = COLOURS.loop;
  brush.fillRect(x, 0, width, LANES_HEIGHT);
  brush.fillStyle = COLOURS.music;
  brush.fillRect(x, LANES.ruler.height - 3, width, 3);
}

function drawBeats(brush: Brush, { grid, view, width, duration }: Picture): void {
  if (!grid || grid.beats.length < 2) {
    drawSeconds(brush, view, width, duration);
    return;
  }
  const bottom = LANES.ranges.top;
  const beatWidth = (60 / grid.tempo) * view.pixelsPerSecond;
  if (beatWidth >= MIN_BEAT_PIXELS) {
    brush.fillStyle = COLOURS.beat;
    const last = lowerBound(grid.beats, xToTime(view, width));
    for (let i = lowerBound(grid.beats, view.start); i < last; i += 1) {
      brush.fillRect(Math.round(timeToX(view, grid.beats[i])), LANES.wave.top, 1, bottom - LANES.wave.top);
    }
  }
  const barWidth = beatWidth * grid.beatsPerBar;
  const lines = barStep(barWidth, MIN_BAR_PIXELS);
  const numbers = barStep(barWidth, MIN_NUMBER_PIXELS);
  brush.font = '11px system-ui, sans-serif';
  brush.textBaseline = 'middle';
  const from = Math.max(0, lowerBound(grid.downbeats, view.start - 60 / view.pixelsPerSecond));
  const to = lowerBound(grid.downbeats, xToTime(view, width));
  for (let bar = from; bar < to; bar += 1) {
    if (bar % lines !== 0) continue;
    const x = Math.round(timeToX(view, grid.downbeats[bar]));
    brush.fillStyle = COLOURS.downbeat;
    brush.fillRect(x, 12, 1, bottom - 12);
    if (bar % numbers !== 0) continue;
    brush.fillStyle = COLOURS.text;
    brush.fillText(String(bar + 1), x + 5, 12);
  }
}

/** Without beats (a song still on its way) the ruler shows seconds. */
function drawSeconds(brush: Brush, view: TimelineView, width: number, duration: number): void {
  const step = barStep(view.pixelsPerSecond, MIN_NUMBER_PIXELS);
  brush.font = '11px system-ui, sans-serif';
  brush.textBaseline = 'middle';
  const end = Math.min(duration, xToTime(view, width));
  for (let second = Math.max(0, Math.floor(view.start / step)) * step; second <= end; second += step) {
    const x = Math.round(timeToX(view, second));
    brush.fillStyle = COLOURS.bar;
    brush.fillRect(x, 12, 1, 12);
    brush.fillStyle = COLOURS.text;
    brush.fillText(`${second} s`, x + 5, 12);
  }
}

/** Parts of the song as shades behind the wave, named at their beginning, or at the edge while they are in sight. */
function drawSections(brush: Brush, { sections, view, width }: Picture): void {
  const { top, height } = LANES.wave;
  brush.font = '600 10px system-ui, sans-serif';
  brush.textBaseline = 'top';
  sections.forEach(({ start, end, label }, i) => {
    const left = timeToX(view, start);
    const right = timeToX(view, end);
    if (right < 0 || left > width) return;
    const shade = SECTION_SHADES[(label.charCodeAt(0) - 65) % SECTION_SHADES.length];
    brush.fillStyle = `rgba(76, 201, 240, ${shade})`;
    brush.fillRect(Math.max(0, left), top + 1, Math.min(width, right) - Math.max(0, left), height - 1);
    brush.fillStyle = COLOURS.text;
    if (i > 0) brush.fillRect(Math.round(left), top + 1, 1, height - 1);
    if (right - Math.max(0, left) > 18) brush.fillText(label, Math.max(0, left) + 5, top + 3);
  });
}

function drawWaveform(brush: Brush, { waveform, view, width, duration }: Picture): void {
  const middle = LANES.wave.top + LANES.wave.height / 2;
  const reach = LANES.wave.height / 2 - 4;
  const end = Math.min(width, timeToX(view, duration));
  brush.fillStyle = COLOURS.musicDim;
  const start = Math.max(0, timeToX(view, 0));
  brush.fillRect(start, Math.round(middle), end - start, 1);
  if (!waveform) return;
  const { pyramid, peak } = waveOf(waveform);
  const gain = reach / Math.max(QUIET, peak);
  brush.fillStyle = COLOURS.music;
  forEachColumn(
    pyramid,
    waveform.rate / view.pixelsPerSecond,
    firstColumn(view),
    Math.ceil(end),
    (column, low, high) => {
      const top = Math.max(-reach, -high * gain);
      const tall = Math.min(reach, -low * gain) - top;
      if (tall > 0.5) brush.fillRect(column, middle + top, 1, tall);
    },
  );
}

/** Pixel columns are counted from the song's start. */
const firstColumn = (view: TimelineView) => Math.round(view.start * view.pixelsPerSecond);

function drawOnsets(brush: Brush, { features, view, width }: Picture): void {
  if (!features) return;
  const { top, height } = LANES.onset;
  brush.fillStyle = COLOURS.musicDim;
  const perPixel = features.fps / view.pixelsPerSecond;
  // Far in, a frame is several pixels wide: a bar each, with a gap.
  const wide = Math.max(1, Math.floor(1 / perPixel));
  const bar = Math.max(1, wide - 1);
  const first = Math.floor(firstColumn(view) / wide);
  const shift = first * wide - firstColumn(view);
  forEachColumn(onsetOf(features), perPixel * wide, first, Math.ceil(width / wide) + 1, (column, _, high) => {
    const tall = high * (height - 4);
    if (tall > 0.5) brush.fillRect(column * wide + shift, top + height - 2 - tall, bar, tall);
  });
}

/** A line from each key pose up to its beat; key poses that have no room for an element are a mark on it. */
function drawKeyStems(brush: Brush, { keys, widths, view, width, selection }: Picture): void {
  const middle = LANES.keys.top + LANES.keys.height / 2;
  keys.forEach((key, i) => {
    const x = Math.round(timeToX(view, key.time));
    if (x < -8 || x > width + 8) return;
    brush.fillStyle = selection.has(key.id) ? COLOURS.keyChosen : COLOURS.key;
    brush.fillRect(x, LANES.wave.top, 1, LANES.keys.top - LANES.wave.top + 4);
    if (widths[i] > 0) return;
    const tall = selection.has(key.id) ? 14 : 8;
    brush.fillRect(x - 1, middle - tall, 2, 2 * tall);
  });
}

function drawDanced(brush: Brush, { danced, stale, generating, view, width, duration }: Picture): void {
  const { top, height } = LANES.ranges;
  const end = Math.min(width, timeToX(view, Math.min(danced, duration)));
  if (end <= 0) return;
  brush.fillStyle = stale && !generating ? COLOURS.motionDim : COLOURS.motion;
  const from = Math.max(0, timeToX(view, 0));
  brush.fillRect(from, top + height - 4, end - from, 3);
  brush.globalAlpha = 0.22;
  brush.fillRect(from, top + 1, end - from, height - 5);
  brush.globalAlpha = 1;
}
