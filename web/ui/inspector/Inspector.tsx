import { SheetHandle } from '../SheetHandle';
import { useStore } from '../store-context';
import type { Panel } from '../../app/state';
import { ReportPanel } from '../report/ReportPanel';
import { ImportPanel } from '../library/ImportPanel';
import { DancePanel } from './DancePanel';
import { Library } from './Library';
import { PoseEditor } from './PoseEditor';

const TABS: readonly { id: Panel; label: string }[] = [
  { id: 'poses', label: 'Poses' },
  { id: 'dance', label: 'Dance' },
  { id: 'report', label: 'Report' },
];

/** Poses to place, the settings of the dance, or how good it is. */
export function Inspector() {
  const store = useStore();
  const { panel, draft, poseImport } = store.state;
  // What is opened in the place of the library begins at its top, wherever the library was scrolled to.
  const content = draft.value ? 'editor' : poseImport.value ? 'import' : 'library';
  const onKeyDown = (event: KeyboardEvent) => {
    const now = TABS.findIndex((tab) => tab.id === panel.value);
    const targets: Record<string, number> = {
      ArrowLeft: now - 1,
      ArrowRight: now + 1,
      Home: 0,
      End: TABS.length - 1,
    };
    const target = targets[event.key];
    // With Alt an arrow is a key of the table.
    if (target === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    const next = TABS[(target + TABS.length) % TABS.length].id;
    store.showPanel(next);
    document.getElementById(`tab-${next}`)?.focus();
  };
  return (
    <aside class="inspector" aria-label="Inspector">
      <div class="inspector-head">
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
              onClick={() => {
                store.showPanel(tab.id);
                store.toggleSheet(true);
              }}
              onKeyDown={onKeyDown}
            >
              {tab.label}
            </button>
          ))}
        </div>
        <SheetHandle />
      </div>
      <div
        key={`${panel.value} ${content}`}
        id="inspector-panel"
        class="panel"
        role="tabpanel"
        aria-labelledby={`tab-${panel.value}`}
        tabIndex={-1}
      >
        {panel.value === 'dance' ? (
          <DancePanel />
        ) : panel.value === 'report' ? (
          <ReportPanel />
        ) : draft.value ? (
          <PoseEditor />
        ) : poseImport.value ? (
          <ImportPanel />
        ) : (
          <Library />
        )}
      </div>
    </aside>
  );
}
