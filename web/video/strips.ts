/** In which strips a picture is drawn. Pure: no DOM. */

/** Pixels of a strip: well under a second's work without a graphics card, nothing with one. */
const STRIP_PIXELS = 2 ** 18;

/** Rows of one strip of a picture: strips of the same height, the last one may reach beyond the picture's end. */
export function stripRows(width: number, height: number): number {
  const strips = Math.ceil((width * height) / STRIP_PIXELS);
  // Even: patterns that go by pairs of rows do not break.
  return Math.min(height, 2 * Math.ceil(height / strips / 2));
}
