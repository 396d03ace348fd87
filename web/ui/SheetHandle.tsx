import { useComputed, useSignalEffect } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { Icon } from './Icon';
import { useStore } from './store-context';

/** A standing phone. */
const NARROW = '(max-width: 767px)';
/** A lying phone: too low for a timeline and an open inspector at once. */
const LOW = '(max-height: 500px)';

/** Small screens only: puts the inspector away and brings it back. */
export function SheetHandle() {
  const store = useStore();
  const { song, sheetOpen } = store.state;
  const open = sheetOpen.value;
  // The demo is to be watched; with a song of one's own the poses are wanted.
  const watching = useComputed(() => !song.value || song.value.demo);

  useSignalEffect(() => {
    const away = matchMedia(LOW).matches || (watching.value && matchMedia(NARROW).matches);
    store.toggleSheet(!away);
  });
  useEffect(() => {
    const low = matchMedia(LOW);
    const turned = () => store.toggleSheet(!low.matches);
    low.addEventListener('change', turned);
    return () => low.removeEventListener('change', turned);
  }, [store]);

  const label = open ? 'Hide the panel' : 'Show the panel';
  return (
    <button
      type="button"
      class="tool sheet-handle"
      aria-expanded={open}
      aria-controls="inspector-panel"
      aria-label={label}
      title={label}
      onClick={() => store.toggleSheet()}
    >
      <Icon name={open ? 'chevronDown' : 'chevronUp'} />
    </button>
  );
}
