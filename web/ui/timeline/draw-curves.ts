/** Draws paper A's figure 9 on the timeline: kinetic velocity with its motion beats, over the onset curve and the music's beats. */
import { lowerBound } from '../../app/snapping';
import { ON_BEAT_FRAMES } from '../../app/report-reference';
import type { DanceReport } from '../../app/report';
import type { TimelineView } from '../../app/state';
import { percentile } from '../../core/interpolate';
import { envelope, movesOnBeats } from '../../core/report-curves';
import type { BeatGrid, Features } from '../../core/types';
import { LANES, timeToX, xToTime } from './geometry';
import { PALETTE, tint } from '../palette';

/** What is drawn. */
export interface CurvePicture {
  view: TimelineView;
  /** CSS pixels. */
  width: number;
  duration: number;
  report: DanceReport | null;
  features: Features | null;
  grid: BeatGrid | null;
  /** Frames a second of the dance. */
  fps: number;
}

const COLOURS = {
  lane: '#10151c',
  line: '#222b36',
  beat: tint(PALETTE.music, 0.28),
  downbeat: tint(PALETTE.music, 0.7),
  onset: tint(PALETTE.music, 0.2),
  onsetLine: tint(PALETTE.music, 0.55),
  motion: PALETTE.motion,
  text: PALETTE.muted,
};
/** Room above the highest speed, for the legend, and below the curves. */
const HEAD = 22;
const FOOT = 4;
/** Share of the height that the onset curve takes. */
const ONSET_SHARE = 0.42;
/** Motion beats closer than this are not told apart, CSS pixels. */
const CIRCLE_GAP = 9;
const RADIUS = 3.5;
/** Beats closer than this are left out, CSS pixels. */
const MIN_BEAT_PIXELS = 6;

const height = LANES.curves.height;
const floor = height - FOOT;

type Brush = CanvasRenderingContext2D;

const tops = new WeakMap<Float32Array, number>();

/** Top of the speed axis, m/s: holds the fastest moment unless it is a wild exception; never moves with the view. */
export function speedTop(speed: Float32Array): number {
  let top = tops.get(speed);
  if (top === undefined) {
    const most = Math.min(percentile(speed, 1), 1.6 * percentile(speed, 0.99));
    top = Math.max(0.25, Math.ceil(most * 4) / 4);
    tops.set(speed, top);
  }
  return top;
}

/** Draws the lane; `ratio` is the device's pixels per CSS pixel. Costs what is in sight, however long the song is. */
export function drawCurves(canvas: HTMLCanvasElement, picture: CurvePicture, ratio: number): void {
  const [across, down] = [Math.round(picture.width * ratio), Math.round(height * ratio)];
  if (canvas.width !== across) canvas.width = across;
  if (canvas.height !== down) canvas.height = down;
  const brush = canvas.getContext('2d');
  if (!brush || picture.view.pixelsPerSecond <= 0) return;
  brush.setTransform(ratio, 0, 0, ratio, 0, 0);
  brush.clearRect(0, 0, picture.width, height);
  const start = Math.max(0, timeToX(picture.view, 0));
  const end = Math.min(picture.width, timeToX(picture.view, picture.duration));
  brush.fillStyle = COLOURS.lane;
  brush.fillRect(start, 0, end - start, height);
  brush.fillStyle = COLOURS.line;
  brush.fillRect(start, 0, end - start, 1);
  drawOnset(brush, picture);
  drawBeats(brush, picture);
  if (picture.report) drawSpeed(brush, picture, picture.report);
}

function drawBeats(brush: Brush, { grid, view, width }: CurvePicture): void {
  if (!grid) return;
  const spaced = (60 / grid.tempo) * view.pixelsPerSecond >= MIN_BEAT_PIXELS;
  const lines = (times: readonly number[], colour: string) => {
    brush.fillStyle = colour;
    const last = lowerBound(times, xToTime(view, width));
    for (let i = lowerBound(times, view.start); i < last; i += 1)
      brush.fillRect(Math.round(timeToX(view, times[i])), HEAD - 4, 1, floor - HEAD + 4);
  };
  if (spaced) lines(grid.beats, COLOURS.beat);
  if (spaced || (60 / grid.tempo) * grid.beatsPerBar * view.pixelsPerSecond >= MIN_BEAT_PIXELS)
    lines(grid.downbeats, spaced ? COLOURS.downbeat : COLOURS.beat);
}

const onsets = new WeakMap<Features, Float32Array>();

function onsetOf(features: Features): Float32Array {
  let onset = onsets.get(features);
  if (!onset) {
    const columns = features.names.length;
    const column = features.names.indexOf('onset');
    onset = new Float32Array(features.frames);
    for (let t = 0; t < onset.length; t += 1) onset[t] = features.data[t * columns + column];
    onsets.set(features, onset);
  }
  return onset;
}

function drawOnset(brush: Brush, { features, view, width }: CurvePicture): void {
  if (!features || !features.names.includes('onset')) return;
  const reach = (floor - HEAD) * ONSET_SHARE;
  const y = (value: number) => floor - Math.min(1, value) * reach;
  const { high } = columnsOf(onsetOf(features), features.fps, 0, view, width);
  const { first, last } = filled(high);
  if (last < first) return;
  brush.beginPath();
  brush.moveTo(first, floor);
  for (let x = first; x <= last; x += 1) brush.lineTo(x, y(high[x]));
  brush.lineTo(last, floor);
  brush.fillStyle = COLOURS.onset;
  brush.fill();
  brush.beginPath();
  for (let x = first; x <= last; x += 1) brush.lineTo(x, y(high[x]));
  brush.strokeStyle = COLOURS.onsetLine;
  brush.lineWidth = 1;
  brush.stroke();
}

function drawSpeed(brush: Brush, { view, width, grid, fps }: CurvePicture, report: DanceReport): void {
  const { speed } = report;
  const top = speedTop(speed);
  const y = (value: number) => floor - Math.min(1.06, value / top) * (floor - HEAD);
  // A speed lies between two frames.
  const { low, high } = columnsOf(speed, fps, -0.5, view, width);
  const { first, last } = filled(high);
  if (last >= first) {
    brush.beginPath();
    for (let x = first; x <= last; x += 1) brush.lineTo(x, y(high[x]) - 0.8);
    for (let x = last; x >= first; x -= 1) brush.lineTo(x, y(low[x]) + 0.8);
    brush.closePath();
    brush.fillStyle = COLOURS.motion;
    brush.fill();
  }
  drawMotionBeats(brush, report, grid, { view, width, fps, y });
}

interface Place {
  view: TimelineView;
  width: number;
  fps: number;
  y(speed: number): number;
}

function drawMotionBeats(brush: Brush, report: DanceReport, grid: BeatGrid | null, place: Place): void {
  const { view, width, fps, y } = place;
  const moves = report.motionBeats;
  const visible = moves.slice(
    lowerBound(moves, xToTime(view, -RADIUS)),
    lowerBound(moves, xToTime(view, width + RADIUS)),
  );
  const span = width / view.pixelsPerSecond;
  // So far out that circles would only be a band: better none, and the legend says so.
  if (!circlesFit(visible.length, span, view)) return;
  const hits = movesOnBeats(visible, grid?.beats ?? [], ON_BEAT_FRAMES / fps);
  brush.lineWidth = 1.5;
  let edge = -Infinity;
  visible.forEach((move, i) => {
    const x = timeToX(view, move);
    if (x - edge < CIRCLE_GAP * 0.6 && !hits[i]) return;
    edge = x;
    brush.beginPath();
    brush.arc(x, y(report.speed[Math.round(move * fps - 0.5)] ?? 0), RADIUS, 0, 2 * Math.PI);
    brush.fillStyle = hits[i] ? '#fff' : COLOURS.lane;
    brush.fill();
    brush.strokeStyle = COLOURS.motion;
    brush.stroke();
  });
}

/** Can that many motion beats in so many seconds be told apart? */
export function circlesFit(count: number, span: number, view: TimelineView): boolean {
  return count === 0 || (span * view.pixelsPerSecond) / count >= CIRCLE_GAP;
}

/** A curve by pixel columns; sample i lies at frame i - `shift`. */
function columnsOf(values: Float32Array, fps: number, shift: number, view: TimelineView, width: number) {
  const perPixel = fps / view.pixelsPerSecond;
  return envelope(values, view.start * fps + shift, perPixel, Math.ceil(width));
}

/** First and last column that hold something. */
function filled(column: Float32Array): { first: number; last: number } {
  let first = 0;
  let last = column.length - 1;
  while (first <= last && Number.isNaN(column[first])) first += 1;
  while (last >= first && Number.isNaN(column[last])) last -= 1;
  return { first, last };
}
