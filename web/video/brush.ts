/** What the drawn pages (a contact sheet, a picture of two dances) are lettered with. */

/** A canvas of the page, or of a worker. */
export type Brush = CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D;

const FAMILY = 'Inter, system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';

/** A font of the page by its size in pixels and its weight. */
export const font = (size: number, weight = 400) => `${weight} ${size}px ${FAMILY}`;

/**
 * Writes a text, aligned as the brush is set.
 * @returns how wide it is, pixels
 */
export function write(brush: Brush, text: string, x: number, y: number, face: string, colour: string): number {
  brush.font = face;
  brush.fillStyle = colour;
  brush.fillText(text, x, y);
  return brush.measureText(text).width;
}

/** As much of a text as fits into a width in pixels. */
export function fit(brush: Brush, text: string, width: number, face: string): string {
  brush.font = face;
  if (brush.measureText(text).width <= width) return text;
  let end = text.length;
  while (end > 1 && brush.measureText(`${text.slice(0, end)}…`).width > width) end -= 1;
  return `${text.slice(0, end).trimEnd()}…`;
}

/** The sign of a key pose, so many pixels from its middle to its corners. */
export function diamond(brush: Brush, x: number, y: number, half: number, colour: string): void {
  brush.fillStyle = colour;
  brush.beginPath();
  brush.moveTo(x, y - half);
  brush.lineTo(x + half, y);
  brush.lineTo(x, y + half);
  brush.lineTo(x - half, y);
  brush.fill();
}
