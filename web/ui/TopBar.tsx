import { useStore } from './store-context';
import { chooseFile, chooseProject } from './files';
import { Icon } from './Icon';
import { ExportButton } from './export/ExportPanel';
import { SaveMenu } from './SaveMenu';
import { Share } from './share/SharePanel';
import { tip } from './shortcuts';

/** Name of the song, undo, project, help. */
export function TopBar() {
  const store = useStore();
  const { song, undoLabel, redoLabel, draft, grid } = store.state;
  const editing = draft.value;
  const canUndo = editing ? editing.canUndo : undoLabel.value !== null;
  const canRedo = editing ? editing.canRedo : redoLabel.value !== null;
  const name = song.value?.reference.name ?? 'No song yet';
  return (
    <header class="top-bar">
      <a class="brand" href="./" aria-label="Posebeat">
        <svg viewBox="0 0 24 24" width="24" height="24" aria-hidden="true">
          <path d="M12 3l6 6-6 6-6-6z" fill="var(--key)" />
          <path d="M4 20h16" stroke="var(--music)" stroke-width="2.5" stroke-linecap="round" />
        </svg>
        <span>Posebeat</span>
      </a>
      <div class="song-title">
        <strong title={name}>{song.value?.demo ? `${name} (demo)` : name}</strong>
        {grid.value && <span class="tempo">{Math.round(grid.value.tempo)} BPM</span>}
      </div>
      <button
        type="button"
        class="tool labelled new-song"
        onClick={() => chooseFile(store)}
        aria-label="New song"
        title="Choose another song, or drop one anywhere"
      >
        <Icon name="music" />
        <span>New song</span>
      </button>
      <span class="separator" />
      <button
        type="button"
        class="tool"
        disabled={!canUndo}
        aria-label="Undo"
        title={tip('undo', undoLabel.value && !editing ? `Undo: ${undoLabel.value}` : 'Undo')}
        onClick={() => store.undo()}
      >
        <Icon name="undo" />
      </button>
      <button
        type="button"
        class="tool"
        disabled={!canRedo}
        aria-label="Redo"
        title={tip('redo', redoLabel.value && !editing ? `Redo: ${redoLabel.value}` : 'Redo')}
        onClick={() => store.redo()}
      >
        <Icon name="redo" />
      </button>
      <span class="separator wide" />
      <button
        type="button"
        class="tool wide"
        aria-label="Open a project"
        title={tip('open')}
        onClick={() => chooseProject(store)}
      >
        <Icon name="folder" />
      </button>
      <SaveMenu />
      <ExportButton />
      <Share />
      <button
        type="button"
        class="tool"
        aria-label="Keys and help"
        title={tip('help')}
        onClick={() => store.toggleHelp()}
      >
        <Icon name="help" />
      </button>
    </header>
  );
}
