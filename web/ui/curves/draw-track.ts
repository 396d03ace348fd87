/** Draws the curves of one track into their lane. */
import type { TimelineView } from '../../app/state';
import { INNER_KNOTS } from '../../core/curves';
import { timeToX } from '../timeline/geometry';
import { AXES, CURVE_LANE, scaleOf, valueToY, type ShownCurves } from './curve-space';

const COLOURS = {
  lane: '#10151c',
  line: '#222b36',
  zero: '#33404f',
  key: '#ffb454',
  keyLine: 'rgba(255, 180, 84, 0.35)',
  filler: '#7d8a99',
  hand: 'rgba(167, 139, 250, 0.12)',
  text: '#a9b5c4',
};
/** Curves are drawn at every second pixel. */
const STEP = 2;
/** Knots closer than this are not drawn, CSS pixels. */
const KNOT_GAP = 5;

/** What is drawn. */
export interface TrackScene {
  view: TimelineView;
  /** CSS pixels. */
  width: number;
  curves: ShownCurves | null;
  /** The interval in hand; -1 = none. */
  interval: number;
  hidden: ReadonlySet<number>;
  /** Bottom and top, so that a change of it paints anew. */
  scale: { lowest: number; highest: number } | null;
}

/** Paints the lane. */
export function drawTrack(canvas: HTMLCanvasElement, scene: TrackScene, ratio: number): void {
  const { view, width, curves, interval, hidden } = scene;
  const { height } = CURVE_LANE;
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.round(height * ratio);
  const brush = canvas.getContext('2d');
  if (!brush) return;
  brush.scale(ratio, ratio);
  brush.fillStyle = COLOURS.lane;
  brush.fillRect(0, 0, width, height);
  brush.fillStyle = COLOURS.line;
  brush.fillRect(0, 0, width, 1);
  if (!curves || view.pixelsPerSecond <= 0) return;
  const { picture, shown } = curves;
  const scale = scaleOf(picture);
  const y = (value: number) => valueToY(value, scale);

  const handStart = interval < 0 ? 0 : timeToX(view, shown.times[interval]);
  if (interval >= 0) {
    brush.fillStyle = COLOURS.hand;
    brush.fillRect(handStart, 1, timeToX(view, shown.times[interval + 1]) - handStart, height - 1);
  }
  if (scale.lowest < 0 && scale.highest > 0) {
    brush.fillStyle = COLOURS.zero;
    brush.fillRect(0, Math.round(y(0)), width, 1);
  }
  shown.times.forEach((time, k) => {
    const x = timeToX(view, time);
    if (x < -2 || x > width + 2) return;
    brush.fillStyle = typeof shown.anchors[k] === 'string' ? COLOURS.keyLine : COLOURS.line;
    brush.fillRect(Math.round(x), 1, 1, height - 1);
  });

  AXES.forEach(({ colour, dash }, axis) => {
    if (hidden.has(axis)) return;
    brush.strokeStyle = colour;
    brush.lineWidth = 1.6;
    brush.setLineDash([...dash]);
    brush.beginPath();
    const samples = picture.values.length / 3;
    for (let x = 0; x <= width; x += STEP) {
      const position = (view.start + x / view.pixelsPerSecond) * picture.rate;
      if (position < 0 || position > samples - 1) continue;
      const a = Math.floor(position);
      const b = Math.min(a + 1, samples - 1);
      const share = position - a;
      brush.lineTo(x, y((1 - share) * picture.values[a * 3 + axis] + share * picture.values[b * 3 + axis]));
    }
    brush.stroke();
    brush.setLineDash([]);
    drawKnots(brush, scene, curves, axis, y);
  });

  brush.fillStyle = COLOURS.text;
  brush.font = '11px system-ui, sans-serif';
  const unit = curves.track === 'root' ? ' cm' : '°';
  brush.fillText(`${Math.round(scale.highest)}${unit}`, 6, CURVE_LANE.head + 9);
  brush.fillText(`${Math.round(scale.lowest)}${unit}`, 6, height - 6);
}

/** Key knots as diamonds, inner ones as small circles; the ones in hand are elements and lie above. */
function drawKnots(
  brush: CanvasRenderingContext2D,
  { view, width, interval }: TrackScene,
  { picture, shown }: ShownCurves,
  axis: number,
  y: (value: number) => number,
): void {
  const stride = INNER_KNOTS + 1;
  let before = -Infinity;
  picture.knots.forEach((time, i) => {
    const x = timeToX(view, time);
    if (x < -6 || x > width + 6 || x - before < KNOT_GAP) return;
    const isKey = i % stride === 0;
    if (!isKey && Math.floor(i / stride) === interval) return;
    before = x;
    const at = y(picture.knotValues[i * 3 + axis]);
    brush.beginPath();
    if (isKey) {
      brush.fillStyle = typeof shown.anchors[i / stride] === 'string' ? COLOURS.key : COLOURS.filler;
      for (const [dx, dy] of [
        [0, -4],
        [4, 0],
        [0, 4],
        [-4, 0],
      ])
        brush.lineTo(x + dx, at + dy);
    } else {
      brush.fillStyle = AXES[axis].colour;
      brush.arc(x, at, 2, 0, 2 * Math.PI);
    }
    brush.fill();
  });
}
