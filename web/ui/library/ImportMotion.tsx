import { useComputed, useSignal } from '@preact/signals';
import type { ImportDensity } from '../../app/actions/motion-import';
import { clockTime } from '../../app/snapping';
import { Icon } from '../Icon';
import { useStore } from '../store-context';

const DENSITIES: readonly { value: ImportDensity; label: string }[] = [
  { value: 'beat', label: 'On every beat' },
  { value: 'two', label: 'On every second beat' },
  { value: 'bar', label: 'On every bar' },
];

/** What the whole motion of a file can be used for, beside one of its frames. */
export function ImportMotion() {
  const store = useStore();
  const density = useSignal<ImportDensity>('two');
  const { time, playing } = store.state;
  // While it plays the count would run along with the playhead.
  const second = useComputed(() => (playing.value ? -1 : Math.round(time.value * 2)));
  void second.value;
  const plan = store.fileKeyCount(density.value);
  return (
    <section class="import-motion" aria-labelledby="import-motion-title">
      <h4 id="import-motion-title">The motion from this frame on</h4>
      <label class="field">
        <span>Its poses as key poses</span>
        <select
          value={density.value}
          onChange={(event) => (density.value = event.currentTarget.value as ImportDensity)}
        >
          {DENSITIES.map(({ value, label }) => (
            <option key={value} value={value}>
              {label}
            </option>
          ))}
        </select>
      </label>
      <div class="import-motion-actions">
        <button
          type="button"
          class="secondary"
          disabled={!plan}
          title="Puts the poses on the song’s beats; Generate dances the rest anew"
          onClick={() => store.useFileAsDance(density.value)}
        >
          <Icon name="plus" />
          Place them
        </button>
        <button
          type="button"
          class="secondary"
          title="The dance begins like these eight beats"
          onClick={() => store.useFileAsSeed()}
        >
          Start like this
        </button>
      </div>
      <small class="hint">
        {plan
          ? `${plan.count} key poses from ${playing.value ? 'the playhead on' : `${clockTime(plan.from)} to ${clockTime(plan.to)}`}, in place of those there.`
          : 'Drop a song first: the poses are placed on its beats.'}
      </small>
    </section>
  );
}
