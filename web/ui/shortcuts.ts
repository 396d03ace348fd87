/** One table of keys: it feeds the bindings, the tooltips and the help overlay. */
import type { Store } from '../app/store';
import { keyText, matches } from './keys/combo';
import { PLAY_SHORTCUTS } from './keys/play';
import { BEAT_SHORTCUTS } from './keys/beats';
import { KEY_POSE_SHORTCUTS } from './keys/key-poses';
import { POSE_EDITOR_SHORTCUTS } from './keys/pose-editor';
import { PROJECT_SHORTCUTS } from './keys/project';
import { VIEW_SHORTCUTS } from './keys/view';
import type { Shortcut } from './keys/shortcut';

export { keyText, matches } from './keys/combo';

/** All shortcuts, in the order of the help overlay. */
export const SHORTCUTS: readonly Shortcut[] = [
  ...PLAY_SHORTCUTS,
  ...BEAT_SHORTCUTS,
  ...KEY_POSE_SHORTCUTS,
  ...POSE_EDITOR_SHORTCUTS,
  ...PROJECT_SHORTCUTS,
  ...VIEW_SHORTCUTS,
];

/** A tooltip: what a control does and its key. */
export function tip(id: string, text?: string): string {
  const shortcut = SHORTCUTS.find((each) => each.id === id);
  if (!shortcut) throw new Error(`No shortcut is called "${id}".`);
  return `${text ?? shortcut.label} (${keyText(shortcut.keys[0])})`;
}

/** Binds the table, or a part of it, to a page. Returns the way to stop that. */
export function bindShortcuts(store: Store, target: Window, table = SHORTCUTS): () => void {
  const listener = (event: KeyboardEvent) => {
    if (event.defaultPrevented) return;
    // Esc is for the innermost: the browser closes an open menu or dialog by itself, wherever the focus is. Not the help, whose search
    // field would take the key to empty itself.
    const helping = store.state.help.value;
    if (event.key === 'Escape' && !helping && target.document.querySelector(':popover-open, dialog:modal')) return;
    const element = event.target as HTMLElement;
    const typing = element.matches?.('input:not([type=range]):not([type=radio]), textarea, select, [contenteditable]');
    // Space and Enter belong to a focused control; arrows are never in the table.
    const pressing =
      (event.key === ' ' || event.key === 'Enter') && element.matches?.('button, a, summary, input, [role=tab]');
    for (const shortcut of table) {
      if ((typing || pressing) && !shortcut.everywhere) continue;
      if (!shortcut.keys.some((combo) => matches(event, combo))) continue;
      if (shortcut.when && !shortcut.when(store)) continue;
      event.preventDefault();
      shortcut.run(store, event);
      return;
    }
  };
  target.addEventListener('keydown', listener);
  return () => target.removeEventListener('keydown', listener);
}
