/** The inspector on a small screen: a sheet that can be put away, so that the stage has the room. */
import { effect } from '@preact/signals';
import type { Context } from '../context';

/** Actions on the layout of small screens; a large one always shows everything. */
export function layoutActions({ state }: Context) {
  let panel = state.panel.peek();
  effect(() => {
    // Whoever asks for a panel wants to see it.
    if (state.panel.value === panel) return;
    panel = state.panel.value;
    state.sheetOpen.value = true;
  });
  return {
    /** Small screens: the inspector is open, or only its tabs are there. */
    toggleSheet: (open = !state.sheetOpen.peek()) => (state.sheetOpen.value = open),
  };
}
