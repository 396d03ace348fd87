import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** The answer to an empty timeline: one press fills it with key poses on the beats. */
export function SuggestLane() {
  const store = useStore();
  const { song, suggestion } = store.state;
  if (!song.value?.complete || suggestion.value.status !== 'idle') return null;
  return (
    <button
      type="button"
      class="suggest-lane"
      data-grab
      title={tip('suggest', 'Let the music suggest key poses; change what you like')}
      onPointerEnter={() => store.warmSuggester()}
      onFocus={() => store.warmSuggester()}
      onClick={() => void store.suggestForPage()}
    >
      <Icon name="sparkles" size={16} />
      Suggest key poses
    </button>
  );
}
