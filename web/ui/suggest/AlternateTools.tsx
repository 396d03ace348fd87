import { useEffect } from 'preact/hooks';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** Other poses for the selected suggestion, to flip through; `wide` with a word before it. */
export function AlternateTools({ wide = false }: { wide?: boolean }) {
  const store = useStore();
  const { selection, document, alternates } = store.state;
  const chosen = document.value.keyPoses.filter((key) => selection.value.has(key.id));
  const key = chosen.length === 1 && chosen[0].suggested && !chosen[0].locked ? chosen[0] : null;
  const id = key?.id;
  // They are looked for as soon as the suggestion is selected, so that flipping is immediate.
  useEffect(() => {
    if (id) void store.prepareAlternates(id).catch(() => undefined);
  }, [id, store]);
  if (!key) return null;
  const at = alternates.value && store.alternateOf(key);
  return (
    <div
      class={`alternate-switch ${wide ? 'in-card' : ''}`}
      role="group"
      aria-label={wide ? 'Suggested pose: others for it' : 'Other poses for this suggestion'}
    >
      {wide && <span class="alternate-word">Suggested: try another</span>}
      <button
        type="button"
        class="bar-button"
        aria-label="Previous alternate"
        title={tip('alternate-back')}
        onClick={() => void store.stepAlternate(-1)}
      >
        <Icon name="chevronLeft" size={16} />
      </button>
      <span class="tabular" title="Which of the suggested poses this is">
        {at ? `${at.number} of ${at.count}` : 'Pose …'}
      </span>
      <button
        type="button"
        class="bar-button"
        aria-label="Next alternate"
        title={tip('alternate-on')}
        onClick={() => void store.stepAlternate(1)}
      >
        <Icon name="chevronRight" size={16} />
      </button>
    </div>
  );
}
