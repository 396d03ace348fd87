/** Draws a contact sheet: heading, cells with their words, and the figures as they come. */
import { diamond, fit, font, write, type Brush } from './brush';
import type { SheetRequest } from './protocol';
import { SHEET, type Cell, type SheetLayout } from './sheet-layout';

/** Colours as `#rrggbb`. */
interface Colours {
  ground: string;
  surface: string;
  line: string;
  text: string;
  muted: string;
  key: string;
}

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
  const mark = right - write(brush, 'Posebeat', right, 92, font(32, 650), colours.text) - 30;
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
