import { chooseFile } from '../files';
import { Icon } from '../Icon';
import { useStore } from '../store-context';

/** The dance of a link is to a song of its maker's: until that is here, it is shown to the demo's. */
export function WantedSong() {
  const store = useStore();
  const wanted = store.state.wanted.value;
  if (!wanted) return null;
  return (
    <div class="notice info wanted" role="status">
      <Icon name="music" />
      <span>
        This dance is to “{wanted.name}”. Drop that song to see it as it was made; until then it goes to our demo song.
      </span>
      <button type="button" class="secondary" onClick={() => chooseFile(store)}>
        Choose the song
      </button>
    </div>
  );
}
