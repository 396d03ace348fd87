import { documentOnStage } from '../../app/on-stage';
import { MOST_POSES, sheetLayout } from '../../video/sheet-layout';
import { fileName } from '../files';
import { Icon } from '../Icon';
import { useStore } from '../store-context';
import { savePicture, usePreview } from './make';
import { SaveButton } from './SaveButton';

/** Pixels across of the preview are so much of the sheet's. */
const SMALL = 0.4;

/** The key poses as one picture. */
export function KeysPanel() {
  const store = useStore();
  const { song, grid } = store.state;
  const { keyPoses } = documentOnStage(store.state);
  if (keyPoses.length === 0) return <NoKeys />;
  return <Sheet key={grid.value?.tempo} count={keyPoses.length} name={song.value?.reference.name ?? 'dance'} />;
}

function NoKeys() {
  const store = useStore();
  return (
    <div class="export-empty">
      <Icon name="imageDown" size={32} />
      <p>
        There are no key poses yet. Drag poses from the library onto the timeline, or press Suggest below the stage;
        then all of them fit on one picture.
      </p>
      <button type="button" class="secondary" onClick={() => store.toggleVideo(false)}>
        To the timeline
      </button>
    </div>
  );
}

function Sheet({ count, name }: { count: number; name: string }) {
  const store = useStore();
  const { keyPoses, look } = documentOnStage(store.state);
  const shown = Math.min(count, MOST_POSES);
  const { width, height } = sheetLayout(shown);
  const preview = usePreview(JSON.stringify([keyPoses, look, store.state.avatar.value?.id]), (hooks) =>
    store.exportKeyPoses({ ...hooks, scale: SMALL }),
  );
  return (
    <>
      <p class="hint">
        Every key pose in order, with its name, time and bar: to print, to rehearse from, or to show.
        {count > MOST_POSES && ` These are the first ${MOST_POSES} of ${count}.`}
      </p>
      <div class="picture-preview sheet-preview">
        {preview && 'url' in preview ? (
          <img src={preview.url} alt={`Contact sheet of ${shown} key poses`} />
        ) : (
          <span class="hint">{preview ? preview.problem : 'Drawing a preview…'}</span>
        )}
      </div>
      <div class="export-foot">
        <p>
          <strong>{shown === 1 ? '1 key pose' : `${shown} key poses`}</strong>
          <span class="hint tabular">
            PNG, {width} × {height}
          </span>
        </p>
        <SaveButton
          what="keys"
          label="Save PNG"
          onSave={() =>
            void savePicture(store, 'keys', fileName(name, 'png').replace(/\.png$/, ' key poses.png'), (hooks) =>
              store.exportKeyPoses(hooks),
            )
          }
        />
      </div>
    </>
  );
}
