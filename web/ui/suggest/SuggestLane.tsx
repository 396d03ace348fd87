import { useEffect } from 'preact/hooks';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** How long an empty timeline is looked at before the model is fetched unasked, milliseconds. */
const A_LOOK = 1200;

/** The visitor wants nothing fetched that was not asked for. */
const savesData = (): boolean =>
  (navigator as Navigator & { connection?: { saveData?: boolean } }).connection?.saveData === true;

/**
 * Calls back when somebody has looked at the page for a moment and it has nothing else to do.
 * @returns takes the wish back
 */
function whenIdle(callback: () => void): () => void {
  let idle: number | undefined;
  const timer = setTimeout(() => {
    if (document.visibilityState !== 'visible') return;
    // Safari has no requestIdleCallback: there the moment itself must do.
    if (typeof requestIdleCallback === 'function') idle = requestIdleCallback(callback);
    else callback();
  }, A_LOOK);
  return () => {
    clearTimeout(timer);
    if (idle !== undefined) cancelIdleCallback(idle);
  };
}

/** The answer to an empty timeline: one press fills it with key poses on the beats. */
export function SuggestLane() {
  const store = useStore();
  const { song, suggestion } = store.state;
  const isIdle = suggestion.value.status === 'idle';
  const isWaiting = song.value !== null && isIdle;
  const isOffered = isWaiting && song.value?.complete === true;
  // While a song is being listened to its model can come: who sees the empty timeline may press in a second.
  useEffect(() => {
    if (!isWaiting) return undefined;
    const timeline = document.querySelector('.timeline');
    const warm = () => store.warmSuggester();
    timeline?.addEventListener('pointerenter', warm, { once: true });
    if (!savesData() && song.peek()?.complete === false) warm();
    const stop = savesData() ? undefined : whenIdle(warm);
    return () => {
      stop?.();
      timeline?.removeEventListener('pointerenter', warm);
    };
  }, [isWaiting, song, store]);
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
