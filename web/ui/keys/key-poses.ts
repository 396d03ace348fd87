import type { Store } from '../../app/store';
import spec from '../../core/spec.json';
import { posing, type Shortcut } from './shortcut';

const selectedOrHere = (store: Store): ReadonlySet<string> => {
  const { selection, document, time } = store.state;
  if (selection.value.size > 0) return selection.value;
  const here = document.value.keyPoses.find((key) => Math.abs(key.time - time.value) < 1 / spec.fps);
  return new Set(here ? [here.id] : []);
};

/** Keys for the key poses on the timeline. */
export const KEY_POSE_SHORTCUTS: readonly Shortcut[] = [
  {
    id: 'add',
    keys: ['Enter'],
    label: 'Keep the pose at the playhead as a key pose',
    group: 'Key poses',
    run: (store) => (store.state.draft.value ? store.keepDraft() : store.keepPoseHere()),
  },
  {
    id: 'remove',
    keys: ['Delete', 'Backspace', 'Shift+Enter'],
    label: 'Delete the selected key poses',
    group: 'Key poses',
    // In the editor it would take away what is being edited, out of reach of the editor's undo.
    when: (store) => !posing(store),
    run: (store) => store.deleteKeys(selectedOrHere(store)),
  },
  {
    id: 'mirror',
    keys: ['M'],
    label: 'Mirror the pose',
    group: 'Key poses',
    run: (store) => (store.state.draft.value ? store.mirrorDraft() : store.mirrorKeys()),
  },
  {
    id: 'select-all',
    keys: ['Mod+A'],
    label: 'Select all key poses',
    group: 'Key poses',
    run: (store) => store.selectAll(),
  },
  {
    id: 'keys-copy',
    keys: ['Mod+C'],
    label: 'Copy the selected key poses',
    group: 'Key poses',
    when: (store) => !posing(store) && store.state.selection.value.size > 0,
    run: (store) => void store.copyKeys(),
  },
  {
    id: 'keys-cut',
    keys: ['Mod+X'],
    label: 'Cut the selected key poses',
    group: 'Key poses',
    when: (store) => !posing(store) && store.state.selection.value.size > 0,
    run: (store) => store.cutKeys(),
  },
  {
    id: 'keys-paste',
    keys: ['Mod+V'],
    label: 'Paste key poses at the playhead',
    group: 'Key poses',
    when: (store) => !posing(store),
    run: (store) => store.pasteKeys(),
  },
  {
    id: 'keys-duplicate',
    keys: ['Mod+D'],
    label: 'Duplicate the selected key poses by a bar',
    group: 'Key poses',
    when: (store) => !posing(store),
    run: (store) => store.duplicateKeys(),
  },
  {
    id: 'distribute',
    keys: ['D'],
    label: 'Distribute the selected key poses on the grid',
    group: 'Key poses',
    run: (store) => store.distributeKeys(),
  },
  {
    id: 'suggest',
    keys: ['I'],
    label: 'Suggest key poses on the beats',
    group: 'Key poses',
    when: (store) => !posing(store) && store.state.song.value?.complete === true,
    run: (store) => void store.suggestForPage(),
  },
  {
    id: 'alternate-back',
    keys: ['Shift+N'],
    label: 'Previous alternate of the selected suggestion',
    group: 'Key poses',
    when: (store) => !posing(store),
    run: (store) => void store.stepAlternate(-1),
  },
  {
    id: 'alternate-on',
    keys: ['N'],
    label: 'Next alternate of the selected suggestion',
    group: 'Key poses',
    when: (store) => !posing(store),
    run: (store) => void store.stepAlternate(1),
  },
  {
    id: 'lock',
    keys: ['Shift+L'],
    label: 'Lock or unlock the selected key poses',
    group: 'Key poses',
    run: (store) => store.toggleLock(),
  },
  {
    id: 'snap',
    keys: ['S'],
    label: 'Next snap: bar, beat, half beat, off',
    group: 'Key poses',
    run: (store) => store.cycleSnap(),
  },
];
