/** A/B: a dance is held as A while the visitor works on; either is on stage at a press, and neither is ever lost. */
import { effect, untracked } from '@preact/signals';
import type { Context } from '../context';
import { inputsOf, madeFrom } from '../recipe';
import type { DanceActions } from './dance';

/** Actions that compare two dances. */
export function compareActions(context: Context, dances: DanceActions) {
  const { state } = context;
  let wasBusy = false;

  const show = (shown: 'a' | 'b') => {
    const held = state.compare.value;
    // Whoever wants to see A wants to see it alone.
    const beside = shown === 'b' && held?.beside;
    if (held && held.shown !== shown) state.compare.value = { ...held, shown, beside };
  };

  // Whoever works on wants to see what it does: that is B. Another song ends the comparison.
  effect(() => {
    const { keyPoses, ranges, dials, trim, song } = state.document.value;
    void [keyPoses, ranges, dials, trim, state.dance.value?.uncorrected, state.strengthDraft.value];
    const busy = state.generation.value.status !== 'idle';
    untracked(() => {
      const held = state.compare.value;
      if (!held) return;
      if (held.document.song?.hash !== song?.hash) state.compare.value = null;
      else if (!busy || !wasBusy) show('b');
      wasBusy = busy;
    });
  });

  const actions = {
    /** Holds the dance on stage as A; once one is held, shows the other of the two. */
    compare(): void {
      const held = state.compare.value;
      if (held) {
        const other = held.shown === 'a' ? 'b' : 'a';
        show(other);
        context.announce(other === 'a' ? 'A is on stage: the dance you held.' : 'B is on stage: the dance of now.');
        return;
      }
      const dance = state.dance.value;
      if (!dance || dance.kind === 'preview') {
        context.notify('info', 'There is no dance to compare yet: generate one first.');
        return;
      }
      state.compare.value = { document: state.document.value, dance, shown: 'b', report: state.report.value };
      context.announce('This dance is held as A. Change what you like, then press A to compare.');
    },

    showCompared: show,

    /** A dances beside B, or B is alone. */
    toggleBeside(): void {
      const held = state.compare.value;
      if (held) state.compare.value = { ...held, shown: 'b', beside: !held.beside };
    },

    /** The same key poses through the other engine, both dances side by side, with both reports. */
    async compareEngines(): Promise<void> {
      const dance = state.dance.value;
      if (dance?.kind !== 'generated' || state.stale.value) {
        context.notify('info', 'There is no dance of these key poses yet: generate it first.');
        return;
      }
      const { document, report } = state;
      state.compare.value = { document: document.value, dance, shown: 'b', beside: true, report: report.value };
      dances.setEngine(document.value.engine === 'curves' ? 'light' : 'curves');
      if (await dances.catchUp()) context.announce('Both dances are on stage: A on the left, B on the right.');
    },

    /** Holds the dance of now as A in place of the one before. */
    holdAgain(): void {
      state.compare.value = null;
      actions.compare();
    },

    /** Ends the comparison; the dance of now stays. */
    leaveCompare(): void {
      state.compare.value = null;
    },

    /** Goes back to A, document and all: one step of undo. */
    keepHeld(): void {
      const held = state.compare.value;
      if (!held) return;
      state.compare.value = null;
      const { document, dance } = held;
      context.change('Back to A', (now) => ({ ...document, camera: now.camera }));
      const now = inputsOf(state.document.value);
      const same = dance.inputs && madeFrom(dance.inputs, now, dance.uncorrected !== undefined, state.frames.value);
      if (same) dances.showDance(dance);
      else dances.bringBack();
    },
  };
  return actions;
}
