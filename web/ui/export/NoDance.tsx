import { Icon } from '../Icon';
import { useStore } from '../store-context';

/** Why there is nothing to export yet, and the way to it. */
export function NoDance() {
  const store = useStore();
  const { song, generation } = store.state;
  const busy = generation.value.status !== 'idle';
  return (
    <div class="export-empty">
      <Icon name="person" size={32} />
      <p>
        <strong>There is no dance yet.</strong>
      </p>
      <p class="hint">
        {busy
          ? 'It is being made: come back when it is on stage.'
          : song.value
            ? 'Generate it first; then it can be saved as GLB, BVH, npz or JSON.'
            : 'Drop a song and press Generate; then it can be saved as GLB, BVH, npz or JSON.'}
      </p>
      {song.value && !busy && (
        <button
          type="button"
          class="secondary"
          onClick={() => {
            store.toggleExport(false);
            void store.generateForPage();
          }}
        >
          <Icon name="sparkles" />
          Generate
        </button>
      )}
    </div>
  );
}
