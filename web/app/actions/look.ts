/** What the figure wears: part of the project, and undoable like all of it. */
import { DEFAULT_LOOK, FIGURE_COLOURS, type FigureLook } from '../../core/figure-look';
import type { Context } from '../context';

/** For people, in the middle of a sentence and on a button. */
export const STYLE_NAMES: Readonly<Record<FigureLook['style'], string>> = {
  studio: 'Studio',
  mannequin: 'Mannequin',
  clay: 'Clay',
  neon: 'Neon',
};

/** Actions on the figure's look. */
export function lookActions({ state, change, announce }: Context) {
  return {
    /** Changes style, colours or both. */
    setLook(wish: Partial<FigureLook>): void {
      const now = state.document.value.look ?? DEFAULT_LOOK;
      const look: FigureLook = { ...now, ...wish };
      if (look.style === now.style && look.colours === now.colours) return;
      change(look.style === now.style ? 'Colours of the figure' : 'Style of the figure', (document) => ({
        ...document,
        look,
      }));
      const colours = FIGURE_COLOURS.find(({ id }) => id === look.colours)!.name;
      announce(`Figure: ${STYLE_NAMES[look.style]}, ${colours}.`);
    },
  };
}
