import { rangeName } from '../../app/range-name';
import { Icon } from '../Icon';
import { useStore } from '../store-context';

/** Over a dance that plays without sound: the way to hear it. */
export function SoundChip() {
  const store = useStore();
  const { muted, playing } = store.state;
  if (!muted.value || !playing.value) return null;
  return (
    <button type="button" class="chip sound-chip" onClick={() => store.toggleMute()}>
      <Icon name="volumeOff" />
      Tap for sound
    </button>
  );
}

/** What is being worked on, with the way to stop it. */
export function WorkChip() {
  const store = useStore();
  const { songJob, generation } = store.state;
  const job = songJob.value;
  const made = generation.value;
  if (job) {
    const text = { reading: 'Reading', decoding: 'Decoding', analysing: 'Finding the beats of' }[job.stage];
    return (
      <Work text={`${text} “${job.name}”`} fraction={job.fraction} tone="music" onCancel={() => store.cancelSong()} />
    );
  }
  if (made.status === 'idle') return null;
  if (made.status === 'loading') {
    const size = made.totalBytes > 0 && !made.cached ? ` (${(made.totalBytes / 1e6).toFixed(0)} MB, only once)` : '';
    return (
      <Work
        text={`Getting the dancer ready${size}`}
        fraction={made.fraction}
        tone="motion"
        onCancel={() => store.cancel()}
      />
    );
  }
  const what = made.range ? rangeName(store.state.grid.value, made.range) : 'the dance';
  return <Work text={`Making ${what}`} fraction={made.fraction} tone="motion" onCancel={() => store.cancel()} />;
}

function Work(props: { text: string; fraction: number; tone: 'music' | 'motion'; onCancel: () => void }) {
  const percent = Math.round(props.fraction * 100);
  return (
    <div class={`chip work-chip tone-${props.tone}`}>
      <span class="work-text">{props.text}</span>
      <span class="work-percent">{percent}%</span>
      <div
        class="bar"
        role="progressbar"
        aria-label={props.text}
        aria-valuemin={0}
        aria-valuemax={100}
        aria-valuenow={percent}
      >
        <div style={{ width: `${percent}%` }} />
      </div>
      <button type="button" class="quiet" onClick={props.onCancel}>
        Cancel
      </button>
    </div>
  );
}
