import { chooseFile } from '../files';
import { Icon } from '../Icon';
import { useStore } from '../store-context';

/** In place of the welcome: the dance of a link is to a song of its maker's, and goes to the demo's until that is here. */
export function WantedSong() {
  const store = useStore();
  const { wanted, songJob } = store.state;
  if (!wanted.value) return null;
  return (
    <div class="welcome wanted" role="status">
      <h1>
        A dance to <em title={wanted.value.name}>“{wanted.value.name}”</em>
      </h1>
      <p>Drop that song to see it as it was made. Until then it goes to our demo song.</p>
      {songJob.value === null && (
        <button type="button" class="drop-target" onClick={() => chooseFile(store)}>
          <Icon name="music" size={28} />
          <span>
            <strong>Drop that song</strong>
            <small>or choose the file. It never leaves your device.</small>
          </span>
        </button>
      )}
    </div>
  );
}

/** The same in a frame, where there is less room: it can be put away. */
export function WantedNotice() {
  const store = useStore();
  const { wanted } = store.state;
  if (!wanted.value) return null;
  return (
    <div class="notices" role="region" aria-label="Song">
      <div class="notice info" role="status">
        <span>A dance to “{wanted.value.name}”, shown to our demo song.</span>
        <button type="button" class="secondary" onClick={() => chooseFile(store)}>
          Choose that song
        </button>
        <button type="button" class="tool" aria-label="Dismiss" onClick={() => store.dismissWanted()}>
          <Icon name="close" size={16} />
        </button>
      </div>
    </div>
  );
}
