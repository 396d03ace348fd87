import { useEffect } from 'preact/hooks';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** The answer to an empty timeline: one press fills it with key poses on the beats. */
export function SuggestLane() {
  const store = useStore();
  const { song, suggestion } = store.state;
  const isOffered = song.value?.complete === true && suggestion.value.status === 'idle';
  // Who comes near the empty timeline may press in a second: the model is then on its way already.
  useEffect(() => {
    if (!isOffered) return undefined;
    const timeline = document.querySelector('.timeline');
    const warm = () => store.warmSuggester();
    timeline?.addEventListener('pointerenter', warm, { once: true });
    return () => timeline?.removeEventListener('pointerenter', warm);
  }, [isOffered, store]);
  if (!isOffered) return null;
  return (
    <button
      type="button"
      class="suggest-lane"
      data-grab
      title={tip('suggest', 'Let the music suggest key poses; change what you like')}
      onFocus={() => store.warmSuggester()}
      onClick={() => void store.suggestForPage()}
    >
      <Icon name="sparkles" size={16} />
      Suggest key poses
    </button>
  );
}
