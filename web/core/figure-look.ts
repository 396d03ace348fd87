/** What our own figure looks like: a style, and a set of colours in which left and right can be told apart. */

/** How the figure is made, in the order in which they are offered. Links hold their numbers: append only. */
export const FIGURE_STYLES = ['studio', 'mannequin', 'clay', 'neon'] as const;
/** One of them. */
export type FigureStyle = (typeof FIGURE_STYLES)[number];

/** A set of colours, sRGB as `#rrggbb`. */
export interface FigureColours {
  id: string;
  /** For people. */
  name: string;
  body: string;
  left: string;
  right: string;
}

/** The sets that are offered; the first is a new project's. Links hold their numbers: append only. */
export const FIGURE_COLOURS = [
  { id: 'sky', name: 'Sky and coral', body: '#dde1e8', left: '#6aa5ea', right: '#f08672' },
  { id: 'sun', name: 'Violet and sun', body: '#efe6d6', left: '#7a5fd0', right: '#ffb84d' },
  { id: 'lime', name: 'Blue and lime', body: '#dfe4dc', left: '#3a62d0', right: '#c3d94a' },
  { id: 'sea', name: 'Teal and rose', body: '#e8e3e6', left: '#0f8f8a', right: '#ff9dba' },
  { id: 'night', name: 'Night', body: '#566176', left: '#45c4f0', right: '#ff7448' },
  { id: 'mono', name: 'Black and white', body: '#b9bec7', left: '#3c424d', right: '#ffffff' },
] as const satisfies readonly FigureColours[];

/** What the figure wears. */
export interface FigureLook {
  style: FigureStyle;
  /** Id of a set of colours. */
  colours: (typeof FIGURE_COLOURS)[number]['id'];
}

/** The figure of a project that says nothing else. */
export const DEFAULT_LOOK: Readonly<FigureLook> = { style: 'studio', colours: 'sky' };

/** The colours of a look. */
export function coloursOf(look: Readonly<FigureLook>): FigureColours {
  return FIGURE_COLOURS.find(({ id }) => id === look.colours) ?? FIGURE_COLOURS[0];
}

/** A look as one byte: its colours in the lower four bits, its style in the upper four. */
export function lookByte({ style, colours }: Readonly<FigureLook>): number {
  return FIGURE_STYLES.indexOf(style) * 16 + FIGURE_COLOURS.findIndex(({ id }) => id === colours);
}

/** Reads {@link lookByte}; null for a byte that stands for no look known here. */
export function lookOfByte(byte: number): FigureLook | null {
  const style = FIGURE_STYLES[byte >> 4];
  const colours = FIGURE_COLOURS[byte & 15];
  return style && colours ? { style, colours: colours.id } : null;
}
