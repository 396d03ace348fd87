import { useStore } from '../store-context';
import { DancePanel } from './DancePanel';
import { Library } from './Library';
import { PoseEditor } from './PoseEditor';

const TABS = [
  { id: 'poses', label: 'Poses' },
  { id: 'dance', label: 'Dance' },
] as const;

/** Poses to place, or the settings of the dance. */
export function Inspector() {
  const store = useStore();
  const { panel, draft } = store.state;
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key !== 'ArrowLeft' && event.key !== 'ArrowRight') return;
    event.preventDefault();
    const next = panel.value === 'poses' ? 'dance' : 'poses';
    store.showPanel(next);
    document.getElementById(`tab-${next}`)?.focus();
  };
  return (
    <aside class="inspector" aria-label="Inspector">
      <div class="tabs" role="tablist" aria-label="Inspector">
        {TABS.map((tab) => (
          <button
            key={tab.id}
            id={`tab-${tab.id}`}
            type="button"
            role="tab"
            aria-selected={panel.value === tab.id}
            aria-controls="inspector-panel"
            tabIndex={panel.value === tab.id ? 0 : -1}
            onClick={() => store.showPanel(tab.id)}
            onKeyDown={onKeyDown}
          >
            {tab.label}
          </button>
        ))}
      </div>
      <div
        key={panel.value}
        id="inspector-panel"
        class="panel"
        role="tabpanel"
        aria-labelledby={`tab-${panel.value}`}
        tabIndex={-1}
      >
        {panel.value === 'dance' ? <DancePanel /> : draft.value ? <PoseEditor /> : <Library />}
      </div>
    </aside>
  );
}
