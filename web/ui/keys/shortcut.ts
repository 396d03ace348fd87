import type { Store } from '../../app/store';

/** One action and its keys. */
export interface Shortcut {
  id: string;
  /** `Mod` is Ctrl, or Cmd on a Mac. A printable key stands for itself, whatever Shift it needs. */
  keys: readonly string[];
  label: string;
  group: 'Play' | 'Beats' | 'Key poses' | 'Pose editor' | 'View' | 'Project';
  /** The event tells when the key went down. */
  run(store: Store, event: KeyboardEvent): void;
  /** Where it is given and says no, the keys are somebody else's. */
  when?(store: Store): boolean;
  /** Works while a text field has the focus. */
  everywhere?: boolean;
}

/** The pose editor is open: some keys are its own then. */
export const posing = (store: Store): boolean => store.state.draft.value !== null;
