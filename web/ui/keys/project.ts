import { chooseProject } from '../files';
import { posing, type Shortcut } from './shortcut';

/** Keys for the project, its files and its takes. */
export const PROJECT_SHORTCUTS: readonly Shortcut[] = [
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
];
