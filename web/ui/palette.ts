/** The colours of style.css for what is painted on a canvas. */
export const PALETTE = {
  ground: '#0d1015',
  surface: '#141920',
  line: '#2a3440',
  text: '#e9edf3',
  muted: '#a9b5c4',
  key: '#ffb454',
  music: '#4cc9f0',
  motion: '#a78bfa',
} as const;

/** A `#rrggbb` colour that lets so much through. */
export function tint(colour: string, alpha: number): string {
  const parts = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return `rgba(${parts.join(',')},${alpha})`;
}
