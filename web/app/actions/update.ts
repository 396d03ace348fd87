/** A newer page that waits until the visitor wants it. */
import type { Autosave } from '../autosave';
import type { Context } from '../context';

/** Actions on newer versions of the page. */
export function updateActions({ state }: Context, autosave: Autosave) {
  return {
    /** A newer page is ready; `install` lets it in, which reloads this one. */
    offerUpdate(install: () => Promise<void>): void {
      state.update.value = async () => {
        await autosave.flush();
        // What could not be saved is the visitor's to decide on: the message says so now.
        if (state.unkept.value && !state.updateRisk.value) {
          state.updateRisk.value = true;
          return;
        }
        await install();
      };
    },
    /** The visitor goes on with this page for now. */
    laterUpdate(): void {
      state.update.value = null;
      state.updateRisk.value = false;
    },
  };
}
