import { useComputed, useSignal } from '@preact/signals';
import { documentOnStage } from '../../app/on-stage';
import { clockTime } from '../../app/snapping';
import { Progress } from '../export/Progress';
import { Icon } from '../Icon';
import { useStore } from '../store-context';
import { cancelPicture, pictureJob, savePicture } from './picture-job';
import { chooseStretch } from './picture-layout';

const WHY = {
  loop: 'the loop',
  view: 'what the timeline shows',
  playhead: 'from the bar at the playhead',
} as const;

/** Two dances through the same key poses as a picture (paper A, figure 8). */
export function SavePicture() {
  const store = useStore();
  const { state } = store;
  const picked = useSignal<string | null>(null);
  const seeds = state.seeds.value;
  const first = state.onStage.value?.inputs?.dials.seedClip ?? documentOnStage(state).dials.seedClip;
  const others = seeds.filter((clip) => clip.id !== (first || seeds[0]?.id));
  const second = others.find((clip) => clip.id === picked.value) ?? others[0];
  // The clock itself would render the panel sixty times a second.
  const now = useComputed(() => Math.floor(state.time.value));
  const { loop, view, viewWidth, duration, grid } = state;
  const stretch = chooseStretch({
    loop: loop.value,
    view: view.value,
    viewWidth: viewWidth.value,
    time: now.value,
    duration: duration.value,
    grid: grid.value,
  });
  const job = pictureJob.value;
  if (!second) return null;
  return (
    <section class="card tone-motion" aria-label="A picture of it">
      <h2>A picture of it</h2>
      <p class="hint">
        The music, and the same key poses danced from two starting clips, as strips of figures:{' '}
        <span class="tabular">
          {clockTime(stretch.start)} to {clockTime(stretch.end)}
        </span>
        , {WHY[stretch.why]}.
      </p>
      <label class="field">
        <span>Second starting clip</span>
        <select value={second.id} onChange={(event) => (picked.value = event.currentTarget.value)}>
          {others.map((clip) => (
            <option key={clip.id} value={clip.id}>
              {clip.name}
            </option>
          ))}
        </select>
      </label>
      {job ? (
        <button type="button" class="secondary full progress" onClick={cancelPicture} title="Stop the picture">
          <Progress word={job.text} done={job.fraction} />
        </button>
      ) : (
        <button
          type="button"
          class="secondary full"
          disabled={state.generation.value.status !== 'idle' || state.songJob.value !== null}
          onClick={() => void savePicture(store, stretch, second.id)}
        >
          <Icon name="imageDown" />
          Save picture
        </button>
      )}
      <div class="visually-hidden" role="status">
        {job ? job.text : ''}
      </div>
    </section>
  );
}
