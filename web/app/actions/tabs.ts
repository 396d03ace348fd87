/** The project in several tabs: one saves, the others say so, and work can move from one to another. */
import { effect } from '@preact/signals';
import { parseDocument } from '../../core/document-read';
import type { Autosave } from '../autosave';
import { messageOf, type Context } from '../context';
import type { ProjectActions } from './project';

/** Actions on tabs. */
export function tabActions(context: Context, autosave: Autosave, project: ProjectActions) {
  const { state, services, history } = context;
  const { tabs } = services;

  /** This tab saves from now on: the other tab's work comes first, and nothing of either is lost. */
  async function takeUp(): Promise<void> {
    if (!state.ready.value) return; // the page is about to open what is saved anyway
    const saved = await services.storage.load().catch(() => null);
    if (!saved) return autosave.flush();
    const { document } = parseDocument(saved.document);
    const mine = history.present;
    const changed = autosave.settled !== null && !project.sameWork(mine, autosave.settled);
    if (project.sameWork(document, mine)) autosave.settle(mine);
    else if (changed) {
      // Both are kept: the other tab's version lies one step behind this one's.
      history.push(document, 'Changes in the other tab');
      history.push(mine, 'Changes in this tab');
      context.sync();
      context.notify('info', 'Both tabs had changes. This tab’s are shown; undo goes to those of the other tab.');
      await autosave.flush();
    } else {
      await project.openDocument(document, null);
      autosave.settle(history.present);
      project.showKept(saved.dance);
    }
  }

  if (tabs) {
    tabs.onLeave(() => autosave.flush());
    tabs.onGain(() => {
      takeUp().catch((error: unknown) => context.notify('error', messageOf(error)));
    });
    effect(() => {
      state.elsewhere.value = !tabs.writes.value;
    });
  }

  return {
    /** Makes this tab the one that saves. */
    async workHere(): Promise<void> {
      await tabs?.takeOver();
    },
  };
}
