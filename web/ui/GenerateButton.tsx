import { Icon } from './Icon';
import { tip } from './shortcuts';
import { useStore } from './store-context';

/** The primary action, with its state: to do, under way (then it cancels), done. */
export function GenerateButton() {
  const store = useStore();
  const { generation, stale, dance, song, songJob } = store.state;
  const made = generation.value;
  if (made.status !== 'idle') {
    const percent = Math.round(made.fraction * 100);
    return (
      <button
        type="button"
        class="generate busy"
        onClick={() => store.cancel()}
        title="Cancel; the last good dance stays"
      >
        <span class="generate-fill" style={{ width: `${percent}%` }} />
        <Icon name="close" />
        <span class="generate-text">
          Cancel <span class="tabular">{percent}%</span>
        </span>
      </button>
    );
  }
  const generated = dance.value?.kind === 'generated' || dance.value?.kind === 'demo';
  const fresh = generated && !stale.value;
  const ranges = store.state.document.value.ranges.filter(({ chosen }) => chosen !== null).length;
  const takes = ranges > 0 ? ` and the takes of its ${ranges === 1 ? 'range' : `${ranges} ranges`}` : '';
  return (
    <button
      type="button"
      class={`generate ${fresh ? 'fresh' : ''}`}
      disabled={!song.value || songJob.value !== null}
      onClick={() => void store.generateForPage()}
      title={tip(
        'generate',
        fresh ? `The dance is up to date. Generate it${takes} again` : `Generate the dance${takes}`,
      )}
    >
      <Icon name="sparkles" />
      <span class="generate-text">Generate</span>
      {generated && stale.value && <span class="stale-dot" aria-label="Poses or settings changed" />}
    </button>
  );
}
