import { leftText } from './left-text';
import { useStore } from '../store-context';

/** Where the button that was pressed has gone, this one takes its place: else the keyboard would be left on the page behind the dialog. */
export function takeFocus(button: HTMLButtonElement | null): void {
  if (button && document.activeElement === document.body) button.focus();
}

/** How far the video is, how long it still takes, and the way to stop it; as a chip over the page when its panel is closed. */
export function VideoProgress({ chip = false }: { chip?: boolean }) {
  const store = useStore();
  const job = store.state.videoJob.value;
  if (!job) return null;
  const percent = Math.floor((job.done / job.frames) * 100);
  const left = leftText(job.left, job.done >= job.frames);
  return (
    <div class={chip ? 'chip work-chip video-chip tone-motion' : 'video-progress tone-motion'}>
      <span class="work-text">{chip ? 'Making the video' : left}</span>
      <span class="work-percent tabular">{percent}%</span>
      <div
        class="bar"
        role="progressbar"
        aria-label="Making the video"
        aria-valuemin={0}
        aria-valuemax={100}
        aria-valuenow={percent}
        aria-valuetext={`${percent}%, ${left}`}
      >
        <div style={{ width: `${percent}%` }} />
      </div>
      {chip && (
        <button type="button" class="quiet" onClick={() => store.toggleVideo(true)}>
          Show
        </button>
      )}
      <button
        ref={chip ? undefined : takeFocus}
        type="button"
        class={chip ? 'quiet' : 'secondary'}
        onClick={() => store.cancelVideo()}
      >
        {chip ? 'Cancel' : 'Cancel the video'}
      </button>
    </div>
  );
}
