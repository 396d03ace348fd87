/** One table of keys: it feeds the bindings, the tooltips and the help overlay. */
import type { Store } from '../app/store';
import spec from '../core/spec.json';
import { chooseProject } from './files';

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

const selectedOrHere = (store: Store): ReadonlySet<string> => {
  const { selection, document, time } = store.state;
  if (selection.value.size > 0) return selection.value;
  const here = document.value.keyPoses.find((key) => Math.abs(key.time - time.value) < 1 / spec.fps);
  return new Set(here ? [here.id] : []);
};

const posing = (store: Store): boolean => store.state.draft.value !== null;

/** All shortcuts, in the order of the help overlay. */
export const SHORTCUTS: readonly Shortcut[] = [
  { id: 'play', keys: ['Space'], label: 'Play or pause', group: 'Play', run: (store) => store.togglePlay() },
  { id: 'frame-back', keys: [','], label: 'One frame back', group: 'Play', run: (store) => store.stepFrame(-1) },
  { id: 'frame-on', keys: ['.'], label: 'One frame on', group: 'Play', run: (store) => store.stepFrame(1) },
  { id: 'key-back', keys: ['<'], label: 'Previous key pose', group: 'Play', run: (store) => store.stepKey(-1) },
  { id: 'key-on', keys: ['>'], label: 'Next key pose', group: 'Play', run: (store) => store.stepKey(1) },
  { id: 'loop', keys: ['L'], label: 'Loop on or off', group: 'Play', run: (store) => store.toggleLoop() },
  {
    id: 'tap',
    keys: ['T'],
    label: 'Tap the tempo along with the song',
    group: 'Beats',
    run: (store, event) => {
      if (!event.repeat) store.tapTempo(event.timeStamp);
    },
  },
  {
    id: 'beats-earlier',
    keys: ['['],
    label: 'All beats 10 ms earlier',
    group: 'Beats',
    run: (store) => store.nudgeBeats(-1, 'fine'),
  },
  {
    id: 'beats-later',
    keys: [']'],
    label: 'All beats 10 ms later',
    group: 'Beats',
    run: (store) => store.nudgeBeats(1, 'fine'),
  },
  {
    id: 'beats-frame-earlier',
    keys: ['{'],
    label: 'All beats one frame earlier',
    group: 'Beats',
    run: (store) => store.nudgeBeats(-1, 'frame'),
  },
  {
    id: 'beats-frame-later',
    keys: ['}'],
    label: 'All beats one frame later',
    group: 'Beats',
    run: (store) => store.nudgeBeats(1, 'frame'),
  },
  {
    id: 'metronome',
    keys: ['K'],
    label: 'A click on every beat',
    group: 'Beats',
    run: (store) => store.toggleMetronome(),
  },
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
  {
    id: 'pose-rotate',
    keys: ['E'],
    label: 'Turn joints',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.setPoseMode('rotate'),
  },
  {
    id: 'pose-move',
    keys: ['W'],
    label: 'Move joints; the body follows',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.setPoseMode('move'),
  },
  {
    id: 'pose-space',
    keys: ['X'],
    label: 'World axes, or the joint’s own',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.toggleSpace(),
  },
  {
    id: 'pose-limits',
    keys: ['J'],
    label: 'Joint limits',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.toggleLimits(),
  },
  {
    id: 'pose-mirror',
    keys: ['Shift+M'],
    label: 'Move both sides, mirrored',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.toggleMirrorEdit(),
  },
  {
    id: 'pose-pin',
    keys: ['P'],
    label: 'Pin the chosen joint where it is',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.togglePin(),
  },
  {
    id: 'pose-balance',
    keys: ['B'],
    label: 'Show the balance',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.toggleBalance(),
  },
  {
    id: 'pose-copy',
    keys: ['Mod+C'],
    label: 'Copy the pose',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.copyPose(),
  },
  {
    id: 'pose-copy-limb',
    keys: ['Shift+C'],
    label: 'Copy the limb of the chosen joint',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.copyLimbOfJoint(),
  },
  {
    id: 'pose-paste',
    keys: ['Mod+V'],
    label: 'Paste the copied pose or limb',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.pastePose(),
  },
  {
    id: 'pose-vary',
    keys: ['R'],
    label: 'Another random variation',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.varyPose(),
  },
  {
    id: 'pose-reset',
    keys: ['Shift+R'],
    label: 'Reset the pose',
    group: 'Pose editor',
    when: posing,
    run: (store) => store.resetPose(),
  },
  {
    id: 'pose-onto-keys',
    keys: ['Shift+V'],
    label: 'Paste the copied pose onto the selected key poses',
    group: 'Key poses',
    when: (store) => !posing(store) && store.state.poseClip.value !== null,
    run: (store) => store.pastePoseOntoKeys(),
  },
  { id: 'undo', keys: ['Mod+Z'], label: 'Undo', group: 'Project', run: (store) => store.undo() },
  { id: 'redo', keys: ['Mod+Shift+Z', 'Mod+Y'], label: 'Redo', group: 'Project', run: (store) => store.redo() },
  {
    id: 'save',
    keys: ['Mod+S'],
    label: 'Save the project with its song',
    group: 'Project',
    everywhere: true,
    run: (store) => void store.saveProject(true),
  },
  {
    id: 'open',
    keys: ['Mod+O'],
    label: 'Open a project',
    group: 'Project',
    everywhere: true,
    run: (store) => chooseProject(store),
  },
  {
    id: 'share',
    keys: ['Shift+S'],
    label: 'Share this dance as a link',
    group: 'Project',
    when: (store) => !posing(store),
    run: (store) => store.toggleShare(),
  },
  {
    id: 'export',
    keys: ['Mod+E'],
    label: 'Export the dance as a file',
    group: 'Project',
    everywhere: true,
    run: (store) => store.toggleExport(true),
  },
  {
    id: 'video',
    keys: ['Mod+Shift+E'],
    label: 'Save the dance as a video',
    group: 'Project',
    everywhere: true,
    run: (store) => store.toggleVideo(true),
  },
  {
    id: 'generate',
    keys: ['G'],
    label: 'Generate the dance',
    group: 'Project',
    run: (store) => void store.generateForPage(),
  },
  {
    id: 'regenerate',
    keys: ['Shift+G'],
    label: 'Regenerate the selected range: another take of it',
    group: 'Project',
    run: (store) => void store.regenerateRange(),
  },
  {
    id: 'take-back',
    keys: ['Alt+ArrowLeft'],
    label: 'Previous take of the range',
    group: 'Project',
    run: (store) => void store.stepTake(-1),
  },
  {
    id: 'take-on',
    keys: ['Alt+ArrowRight'],
    label: 'Next take of the range',
    group: 'Project',
    run: (store) => void store.stepTake(1),
  },
  {
    id: 'compare',
    keys: ['A'],
    label: 'Compare: hold this dance as A, then switch between A and B',
    group: 'Project',
    run: (store) => store.compare(),
  },
  { id: 'zoom-in', keys: ['+', '='], label: 'Zoom in', group: 'View', run: (store) => store.zoom(1.5) },
  { id: 'zoom-out', keys: ['-'], label: 'Zoom out', group: 'View', run: (store) => store.zoom(1 / 1.5) },
  // Before plain 0: some layouts type a digit with Shift.
  {
    id: 'fit-selection',
    keys: ['Shift+0'],
    label: 'Zoom to the selected key poses or the loop',
    group: 'View',
    run: (store) => store.showSelection(),
  },
  { id: 'fit', keys: ['0'], label: 'Show the whole song', group: 'View', run: (store) => store.fit() },
  {
    id: 'follow',
    keys: ['Shift+F'],
    label: 'Let the timeline follow the playhead',
    group: 'View',
    run: (store) => store.toggleFollow(),
  },
  {
    id: 'curves',
    keys: ['V'],
    label: 'Show motion against music on the timeline',
    group: 'View',
    run: (store) => store.toggleCurves(),
  },
  {
    id: 'joint-curves',
    keys: ['C'],
    label: 'Show the curves of a joint under the timeline',
    group: 'View',
    run: (store) => store.toggleCurveView(),
  },
  { id: 'frame', keys: ['F'], label: 'Show the whole figure', group: 'View', run: (store) => store.frameFigure() },
  {
    id: 'ghosts',
    keys: ['O'],
    label: 'Show the neighbouring key poses as ghosts',
    group: 'View',
    run: (store) => store.toggleOnion(),
  },
  {
    id: 'path',
    keys: ['Shift+P'],
    label: 'Show the path of a joint through time',
    group: 'View',
    run: (store) => store.togglePath(),
  },
  { id: 'help', keys: ['?'], label: 'Show the keys', group: 'View', run: (store) => store.toggleHelp() },
  { id: 'tour', keys: ['H'], label: 'Show the first steps', group: 'View', run: (store) => store.startTour() },
  {
    id: 'escape',
    keys: ['Escape'],
    label: 'Cancel: drag, dialog, editor',
    group: 'View',
    everywhere: true,
    run: (store) => {
      if (store.state.tapping.value) store.cancelTaps();
      else if (store.state.help.value) store.toggleHelp(false);
      else if (store.cancelBlend()) return;
      else if (store.state.draft.value) store.closeDraft();
      else if (store.state.selection.value.size > 0) store.selectKey(null);
      else store.endTour();
    },
  },
];

const mac = typeof navigator !== 'undefined' && /Mac|iPhone|iPad/.test(navigator.platform);

/** True when an event is one of a shortcut's keys. */
export function matches(
  event: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'shiftKey' | 'altKey'> & { code?: string },
  combo: string,
): boolean {
  const parts = combo.split('+').filter((part) => part !== '');
  const wanted = combo.endsWith('+') ? '+' : parts[parts.length - 1];
  const modifiers = combo.endsWith('+') ? parts : parts.slice(0, -1);
  if (event.altKey !== modifiers.includes('Alt')) return false;
  if ((event.ctrlKey || event.metaKey) !== modifiers.includes('Mod')) return false;
  const key = event.key === ' ' ? 'Space' : event.key;
  const named = wanted.length > 1 || /^[A-Z]$/.test(wanted);
  // With Shift a digit types another sign: the key itself tells.
  if (/^\d$/.test(wanted) && modifiers.includes('Shift')) return event.shiftKey && event.code === `Digit${wanted}`;
  if (!named) return key === wanted; // a printable sign: Shift is part of typing it
  if (event.shiftKey !== modifiers.includes('Shift')) return false;
  return key.toLowerCase() === wanted.toLowerCase();
}

/** The keys of a shortcut as people read them. */
export function keyText(combo: string): string {
  return combo
    .replace('Mod+', mac ? '⌘' : 'Ctrl+')
    .replace('Shift+', mac ? '⇧' : 'Shift+')
    .replace('Alt+', mac ? '⌥' : 'Alt+')
    .replace('ArrowLeft', '←')
    .replace('ArrowRight', '→')
    .replace('Escape', 'Esc');
}

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
