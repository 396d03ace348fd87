import type { Shortcut } from './shortcut';

/** Keys that change what is seen. */
export const VIEW_SHORTCUTS: readonly Shortcut[] = [
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
