import { signal } from '@preact/signals';
import { clockTime } from '../../app/snapping';
import { pictureSettings, videoSize, type PictureOptions, type VideoAspect } from '../../video/options';
import { Segments } from '../export/Segments';
import { fileName } from '../files';
import { useStore } from '../store-context';
import { GroundField, SizeField } from '../video/fields';
import { savePicture, usePreview } from './make';
import { SaveButton } from './SaveButton';

type Ground = 'stage' | 'none' | 'colour';

/** What was chosen last; it stays while the page is open. */
const choice = {
  aspect: signal<VideoAspect>('16:9'),
  size: signal(1080),
  camera: signal<NonNullable<PictureOptions['camera']>>('stage'),
  ground: signal<Ground>('stage'),
  colour: signal('#00b140'),
};

const SIZE_LABELS: Readonly<Record<number, string>> = {
  720: '720 pixels',
  1080: '1080 pixels (Full HD)',
  2160: '2160 pixels (4K)',
};
const SIZES = Object.keys(SIZE_LABELS).map(Number);
/** Pixels along the shorter edge of the preview, on screens of all kinds. */
const SMALL = 360;

/** The moment at the playhead as a picture. */
export function PicturePanel() {
  const store = useStore();
  const { document, song, playing, avatar } = store.state;
  const [aspect, size] = [choice.aspect.value, choice.size.value];
  const options: PictureOptions = {
    aspect,
    camera: choice.camera.value,
    background: choice.ground.value === 'colour' ? choice.colour.value : choice.ground.value,
  };
  // A dance that plays under the panel must not make a picture for every frame.
  const time = playing.value ? store.state.time.peek() : store.state.time.value;
  const { camera, look } = document.value;
  const preview = usePreview(
    JSON.stringify([options, playing.value || time, camera, look, avatar.value?.id]),
    (hooks) => store.exportPicture({ ...options, ...hooks, size: SMALL }),
  );
  const { width, height } = videoSize(aspect, size);
  const name = fileName(`${song.value?.reference.name ?? 'dance'}`, 'png');
  return (
    <>
      <div class={`picture-preview ${choice.ground.value === 'none' ? 'see-through' : ''}`}>
        {preview && 'url' in preview ? (
          <img src={preview.url} alt="What the picture will show" />
        ) : (
          <span class="hint">{preview ? preview.problem : 'Drawing a preview…'}</span>
        )}
      </div>
      <div class="export-options">
        <Segments
          legend="Shape"
          name="picture-aspect"
          value={aspect}
          options={[
            { value: '16:9', label: '16:9', title: 'Wide' },
            { value: '1:1', label: '1:1', title: 'Square' },
            { value: '9:16', label: '9:16', title: 'Upright: phones and stories' },
          ]}
          onChange={(value) => (choice.aspect.value = value)}
        />
        <SizeField label="Shorter edge" size={choice.size} sizes={SIZES} text={(each) => SIZE_LABELS[each]} />
      </div>
      <div class="export-options">
        <Segments
          legend="Camera"
          name="picture-camera"
          value={choice.camera.value}
          options={[
            { value: 'stage', label: 'As on stage', title: 'Looks from where you do now' },
            { value: 'follow', label: 'All of the dancer' },
            { value: 'front', label: 'Front' },
          ]}
          onChange={(value) => (choice.camera.value = value)}
        />
        <GroundField
          name="picture-ground"
          ground={choice.ground}
          colour={choice.colour}
          options={[
            { value: 'stage', label: 'Stage' },
            { value: 'none', label: 'None', title: 'Transparent: to be put on anything' },
            { value: 'colour', label: 'Colour' },
          ]}
        />
      </div>
      <div class="export-foot">
        <p>
          <strong class="tabular">{clockTime(time)}</strong>
          <span class="hint tabular">
            PNG, {width} × {height}: the moment at the playhead
          </span>
        </p>
        <SaveButton
          what="picture"
          label="Save PNG"
          onSave={() => {
            const { background } = pictureSettings(options);
            void savePicture(store, 'picture', name, (hooks) =>
              store.exportPicture({ ...options, background, size, ...hooks }),
            );
          }}
        />
      </div>
    </>
  );
}
