/** The walk-through of four steps: each goes on when the visitor has really done it. */
import { effect, untracked } from '@preact/signals';
import type { Context } from '../context';
import type { State } from '../state';

/** Number of steps. */
export const TOUR_STEPS = 4;
/** Poses to be placed in the second step. */
const POSES_WANTED = 2;
const MEMORY = 'posebeat.tour';

/** What was there when a step began. */
interface Before {
  playing: boolean;
  document: State['document']['value'];
}

/** Whether a step is done, in their order. Reads signals. */
const DONE: readonly ((state: State, before: Before) => boolean)[] = [
  ({ song, songJob }) => song.value !== null && !song.value.demo && songJob.value === null,
  ({ document }) => document.value.keyPoses.length >= POSES_WANTED,
  ({ dance, stale, generation }) =>
    dance.value?.kind === 'generated' && !stale.value && generation.value.status === 'idle',
  ({ playing, document }, before) => playing.value !== before.playing || document.value !== before.document,
];

/** Whether the visitor has seen the steps, on this device; where nothing can be remembered they are shown again. */
const memory = {
  seen(): boolean {
    try {
      return localStorage.getItem(MEMORY) !== null;
    } catch {
      return false;
    }
  },
  remember(): void {
    try {
      localStorage.setItem(MEMORY, 'seen');
    } catch {
      // A private window: the steps come again.
    }
  },
};

/** Actions on the walk-through. */
export function tourActions(context: Context) {
  const { state } = context;
  let stop: () => void = () => undefined;

  /** Watches the step at hand; one that was done before it began goes by unless `stay`. */
  const watch = (step: number, stay: boolean) => {
    stop();
    const before = untracked(() => ({ playing: state.playing.value, document: state.document.value }));
    const isDone = DONE[step];
    let ready = stay ? !untracked(() => isDone(state, before)) : true;
    stop = effect(() => {
      const done = isDone(state, before);
      if (!done) ready = true;
      else if (ready) queueMicrotask(() => state.tour.peek() === step && go(step + 1, false));
    });
  };

  const go = (step: number, stay: boolean) => {
    stop();
    stop = () => undefined;
    if (step >= TOUR_STEPS) {
      end();
      context.notify('info', 'That is all it takes. Help (?) has these steps again, and all the keys.');
      return;
    }
    state.tour.value = step;
    watch(step, stay);
  };

  const end = () => {
    stop();
    stop = () => undefined;
    state.tour.value = null;
    memory.remember();
  };

  return {
    /** Shows the steps from the first one; those that are done already wait for a word. */
    startTour: () => go(0, true),
    /** Shows the steps to somebody who has never seen them. */
    offerTour(): void {
      // Who came for the dance of a link is not in the way of making one yet.
      if (state.guest.value) return;
      if (!memory.seen() && state.song.value?.demo && state.tour.value === null) go(0, false);
    },
    nextTourStep(): void {
      if (state.tour.value !== null) go(state.tour.value + 1, true);
    },
    /** Puts the steps away for good; H brings them back. */
    endTour(): void {
      if (state.tour.value !== null) end();
    },
  };
}
