import { fileName } from '../files';
import { useStore } from '../store-context';
import { savePicture } from './make';
import { SaveButton } from './SaveButton';

/** A few seconds of the dance to be posted beside its link. */
export function MovingPreview() {
  const store = useStore();
  const { onStage, song } = store.state;
  const dance = onStage.value;
  if (!dance || dance.kind === 'preview') return null;
  return (
    <div class="moving-preview">
      <SaveButton
        full
        what="loop"
        label="Save a moving preview"
        onSave={() =>
          void savePicture(store, 'loop', fileName(song.value?.reference.name ?? 'dance', 'gif'), (hooks) =>
            store.exportLoop(hooks),
          )
        }
      />
      <p class="share-note">
        An animated picture (GIF) of the bars at the playhead, to be posted next to the link. Made on this machine.
      </p>
    </div>
  );
}
