import type { Snap } from '../../core/types';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

const SNAPS: readonly { value: Snap; label: string; title: string }[] = [
  { value: 'bar', label: 'Bar', title: 'Key poses snap to bars' },
  { value: 'beat', label: 'Beat', title: 'Key poses snap to beats' },
  { value: 'half', label: '½', title: 'Key poses snap to half beats' },
  { value: 'off', label: 'Off', title: 'Key poses go where you put them' },
];

/** What key poses snap to. */
export function SnapTools() {
  const store = useStore();
  const { snap } = store.state;
  return (
    <div class="bar-group snap-tools" role="radiogroup" aria-label="Snap to">
      <span class="bar-label" aria-hidden="true">
        Snap
      </span>
      {SNAPS.map(({ value, label, title }) => (
        <label
          key={value}
          class="snap-choice"
          title={`${tip('snap', title)}. Hold Alt while dragging to place freely.`}
        >
          <input
            type="radio"
            class="visually-hidden"
            name="snap"
            aria-label={title}
            checked={snap.value === value}
            onChange={() => store.setSnap(value)}
          />
          <span aria-hidden="true">{label}</span>
        </label>
      ))}
    </div>
  );
}
