import type { EngineName } from '../../core/document';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

const ENGINES: readonly { name: EngineName; label: string; hint: string }[] = [
  {
    name: 'light',
    label: 'Network frames',
    hint: 'A network draws every frame. Good from few poses; key strength can be turned at any time.',
  },
  {
    name: 'curves',
    label: 'Editable curves',
    hint: 'A few curves run from key pose to key pose, through each one exactly. You can bend them under the timeline, and export them with their keys.',
  },
];

/** What makes the dance: frames, or curves that can be edited. */
export function EngineSwitch() {
  const store = useStore();
  const { document, dance } = store.state;
  const engine = document.value.engine ?? 'light';
  const chosen = ENGINES.find(({ name }) => name === engine)!;
  return (
    <fieldset class="engine-switch" aria-describedby="engine-hint">
      <legend>Engine</legend>
      <div class="engine-choices">
        {ENGINES.map(({ name, label }) => (
          <label key={name}>
            <input type="radio" name="engine" checked={name === engine} onChange={() => store.setEngine(name)} />
            <span>{label}</span>
          </label>
        ))}
      </div>
      <p class="hint" id="engine-hint">
        {chosen.hint}
      </p>
      {engine === 'curves' && dance.value?.curves && (
        <button
          type="button"
          class="secondary full"
          title={tip('joint-curves')}
          aria-pressed={store.state.curvesOpen.value}
          onClick={() => store.toggleCurveView()}
        >
          <Icon name="path" />
          {store.state.curvesOpen.value ? 'Hide the curves' : 'Edit the curves'}
        </button>
      )}
      {dance.value?.kind === 'generated' && !store.state.stale.value && !store.state.compare.value && (
        <button type="button" class="quiet" onClick={() => void store.compareEngines()}>
          Compare both engines side by side
        </button>
      )}
    </fieldset>
  );
}
