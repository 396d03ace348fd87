/** Draws a contact sheet: heading, cells with their words, and the figures as they come. */
import type { SheetRequest } from './protocol';
import { SHEET, type Cell, type SheetLayout } from './sheet-layout';

type Brush = OffscreenCanvasRenderingContext2D;
/** Colours as `#rrggbb`. */
interface Colours {
  ground: string;
  surface: string;
  line: string;
  text: string;
  muted: string;
  key: string;
}

const FAMILY = 'Inter, system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';
const font = (size: number, weight: number) => `${weight} ${size}px ${FAMILY}`;

/**
 * Draws all but the figures.
 * @returns draws the figure of a cell, given as a square picture
 */
export function drawSheet(
  brush: Brush,
  layout: SheetLayout,
  { title, tempo, poses }: SheetRequest,
  colours: Colours,
): (cell: number, figure: CanvasImageSource) => void {
  brush.fillStyle = colours.ground;
  brush.fillRect(0, 0, layout.width, layout.height);
  brush.textBaseline = 'alphabetic';
  const left = SHEET.margin;
  const right = layout.width - SHEET.margin;
  brush.textAlign = 'right';
  write(brush, 'Posebeat', right, 92, font(32, 650), colours.text);
  const mark = right - brush.measureText('Posebeat').width - 30;
  diamond(brush, mark, 81, 13, colours.key);
  brush.textAlign = 'left';
  write(brush, fit(brush, title, mark - left - 80, font(52, 650)), left, 96, font(52, 650), colours.text);
  const count = `${poses.length} key pose${poses.length === 1 ? '' : 's'}`;
  const speed = tempo ? `, ${Math.round(tempo)} beats a minute` : '';
  write(brush, count + speed, left, 138, font(27, 400), colours.muted);
  layout.cells.forEach((cell, i) => drawCell(brush, layout, cell, poses[i], colours));
  return (i, figure) => {
    const { x, y, width } = layout.cells[i];
    brush.drawImage(figure, x, y, width, width);
  };
}

function drawCell(
  brush: Brush,
  { text }: SheetLayout,
  { x, y, width, height }: Cell,
  { name, when }: SheetRequest['poses'][number],
  colours: Colours,
): void {
  brush.fillStyle = colours.surface;
  brush.beginPath();
  brush.roundRect(x, y, width, height, 16);
  brush.fill();
  // A pool of light and a shadow, so that nobody floats.
  const floor = y + width * 0.905;
  pool(brush, x + width / 2, floor, width * 0.46, 'rgba(150, 165, 195, 0.16)');
  pool(brush, x + width / 2, floor, width * 0.19, 'rgba(0, 0, 0, 0.5)');
  const pad = Math.round(width * 0.055);
  const room = width - 2 * pad;
  const bottom = y + height - pad;
  const whenFont = font(text.when, 400);
  write(brush, fit(brush, when, room, whenFont), x + pad, bottom, whenFont, colours.muted);
  const nameFont = font(text.name, 600);
  const above = bottom - text.when * 1.45;
  write(brush, fit(brush, name, room, nameFont), x + pad, above, nameFont, colours.key);
}

function pool(brush: Brush, x: number, y: number, radius: number, colour: string): void {
  brush.save();
  brush.translate(x, y);
  brush.scale(1, 0.2);
  const light = brush.createRadialGradient(0, 0, 0, 0, 0, radius);
  light.addColorStop(0, colour);
  light.addColorStop(1, colour.replace(/[\d.]+\)$/, '0)'));
  brush.fillStyle = light;
  brush.fillRect(-radius, -radius, 2 * radius, 2 * radius);
  brush.restore();
}

function write(brush: Brush, text: string, x: number, y: number, face: string, colour: string): void {
  brush.font = face;
  brush.fillStyle = colour;
  brush.fillText(text, x, y);
}

/** As much of a text as fits. */
function fit(brush: Brush, text: string, width: number, face: string): string {
  brush.font = face;
  if (brush.measureText(text).width <= width) return text;
  let end = text.length;
  while (end > 1 && brush.measureText(`${text.slice(0, end)}…`).width > width) end -= 1;
  return `${text.slice(0, end).trimEnd()}…`;
}

function diamond(brush: Brush, x: number, y: number, half: number, colour: string): void {
  brush.fillStyle = colour;
  brush.beginPath();
  brush.moveTo(x, y - half);
  brush.lineTo(x + half, y);
  brush.lineTo(x, y + half);
  brush.lineTo(x - half, y);
  brush.fill();
}
