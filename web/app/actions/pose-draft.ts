/** The pose in the editor and its own undo, apart from the document's. Nothing of it is lost by leaving the editor. */
import { History } from '../../core/history';
import type { Context } from '../context';
import type { PoseDraft } from '../pose-state';

/** Drafts whose steps are remembered after they were kept. */
const REMEMBERED = 20;
/** Smaller differences are rounding: a click on a ring turns nothing and must be no step. Radians. */
const NOTHING = 1e-6;

/** Whether two poses are the same up to rounding. */
export function samePose(a: readonly number[], b: readonly number[]): boolean {
  return a.length === b.length && a.every((value, i) => Math.abs(value - b[i]) <= NOTHING);
}

/** A draft with its steps, put aside. */
interface Shelved {
  draft: PoseDraft;
  history: History<number[]>;
  opened: readonly number[];
}

/** Makes the desk that the pose lies on. */
export function poseDesk(context: Context) {
  const { state } = context;
  let history = new History<number[]>([]);
  /** What the editor was opened with. */
  let opened: readonly number[] = [];
  /** A change that is being tried: shown, but no step yet. */
  let trial: { label: string; base: readonly number[] } | null = null;
  /** Steps of the drafts that became key poses. */
  const kept = new Map<string, History<number[]>>();

  const refresh = () => {
    const draft = state.draft.value;
    if (!draft) return;
    state.draft.value = {
      ...draft,
      rotations: history.present,
      canUndo: history.undoLabel !== null || trial !== null,
      canRedo: history.redoLabel !== null,
    };
  };

  /** Says a short word over the stage, and to screen readers. */
  const say = (text: string) => {
    state.poseWord.value = text;
    if (text) context.announce(text);
  };

  const endTrial = () => {
    trial = null;
    state.poseBlend.value = null;
  };

  /** Makes a step of what is being tried; nothing tried, or nothing changed by it, makes none. */
  const settle = () => {
    if (!trial) return;
    const { label, base } = trial;
    endTrial();
    if (samePose(history.present, base)) history.discard();
    else history.commit(label);
    refresh();
  };

  /** Takes back what is being tried. Returns false when nothing is. */
  const discard = (): boolean => {
    if (!trial) return false;
    endTrial();
    history.discard();
    refresh();
    return true;
  };

  const changed = () => state.draft.value !== null && !samePose(history.present, opened);

  const show = (shelved: Shelved) => {
    ({ history, opened } = shelved);
    endTrial();
    state.poseWord.value = '';
    state.poseTools.value = { ...state.poseTools.value, pins: new Set() };
    state.draft.value = shelved.draft;
    state.panel.value = 'poses';
    refresh();
  };

  /** Closes the editor; what was changed in it can be brought back. */
  const drop = () => {
    const draft = state.draft.value;
    if (!draft) return;
    discard();
    const shelved = { draft: { ...draft, rotations: history.present }, history, opened };
    const worth = changed();
    state.draft.value = null;
    state.poseWord.value = '';
    if (!worth) return;
    context.notify('info', 'Pose dropped.', {
      label: 'Bring it back',
      run: () => {
        drop();
        show(shelved);
        say('The pose is back, with its steps.');
      },
    });
  };

  return {
    /** The pose as it is shown. */
    get present(): number[] {
      return history.present;
    },

    /** The pose before what is being tried under this label. */
    base: (label: string): readonly number[] => (trial?.label === label ? trial.base : history.present),

    /** Opens a pose; one that lies on the desk with changes is dropped first. Steps of a key pose that was made here come back. */
    open(rotations: readonly number[], { keyId = null, name = '' }: { keyId?: string | null; name?: string }): void {
      drop();
      const before = keyId === null ? undefined : kept.get(keyId);
      const steps = before && samePose(before.present, rotations) ? before : new History([...rotations]);
      const draft = { rotations: steps.present, keyId, name, joint: null, canUndo: false, canRedo: false };
      show({ draft, history: steps, opened: rotations });
    },

    /** One step. */
    push(rotations: number[], label: string): void {
      if (!state.draft.value) return;
      settle();
      state.poseWord.value = '';
      if (!samePose(rotations, history.present)) history.push(rotations, label);
      refresh();
    },

    /** Shows a change that may go on; it becomes one step by `settle`, or by whatever is done next. */
    attempt(rotations: number[], label: string): void {
      if (!state.draft.value) return;
      if (trial?.label !== label) {
        settle();
        state.poseWord.value = '';
        history.capture();
        trial = { label, base: history.present };
      }
      history.preview(rotations);
      refresh();
    },

    settle,
    discard,
    drop,
    say,

    /** Closes the editor; the steps are remembered with the key pose that the draft became. */
    keep(keyId: string): void {
      kept.delete(keyId);
      kept.set(keyId, history);
      if (kept.size > REMEMBERED) kept.delete(kept.keys().next().value!);
      state.draft.value = null;
      state.poseWord.value = '';
    },

    /** Goes one step back; what is being tried goes first. */
    undo(): void {
      const label = trial?.label ?? history.undoLabel;
      if (!discard() && !history.undo()) return;
      refresh();
      say(`Undone: ${label}.`);
    },

    /** Goes one step forward again. */
    redo(): void {
      discard();
      if (!history.redo()) return;
      refresh();
      say(`Redone: ${history.undoLabel}.`);
    },
  };
}

/** The desk. */
export type PoseDesk = ReturnType<typeof poseDesk>;
