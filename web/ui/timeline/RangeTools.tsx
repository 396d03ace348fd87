import { rangeInHand } from '../../app/actions/ranges';
import { barsOf, rangeName, shortRangeName } from '../../app/range-name';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { takeText } from './RangeLane';

/** What can be done with the selected range, in the timeline's bar. */
export function RangeTools() {
  const store = useStore();
  const { loop, grid, generation, song, songJob, compare } = store.state;
  const selected = loop.value;
  if (!selected || !song.value) return null;
  const range = rangeInHand(store.state);
  const name = rangeName(grid.value, selected);
  // Times are long: the bar numbers say it better where there are some.
  const short = barsOf(grid.value, selected) ? shortRangeName(grid.value, selected) : 'range';
  const busy = generation.value.status !== 'idle' || songJob.value !== null;
  const held = compare.value;
  return (
    <div class="bar-group range-tools" role="group" aria-label={`Selected range, ${name}`}>
      <button
        type="button"
        class="bar-button framed motion"
        disabled={busy}
        title={tip('regenerate', range ? `Another take of ${name}` : `Make ${name} anew; around it nothing changes`)}
        onClick={() => void store.regenerateRange()}
      >
        <Icon name="sparkles" size={16} />
        Regenerate {short}
      </button>
      {range && (
        <div class="take-switch" role="group" aria-label="Takes of the range">
          <button
            type="button"
            class="bar-button"
            aria-label="Previous take of the range"
            title={tip('take-back')}
            onClick={() => void store.stepTake(-1)}
          >
            <Icon name="chevronLeft" size={16} />
          </button>
          <span class="tabular" title="The take on stage; – is the whole dance">
            {takeText(range)}
          </span>
          <button
            type="button"
            class="bar-button"
            aria-label="Next take of the range"
            title={tip('take-on')}
            onClick={() => void store.stepTake(1)}
          >
            <Icon name="chevronRight" size={16} />
          </button>
        </div>
      )}
      <button
        type="button"
        class="bar-button"
        aria-pressed={held ? held.shown === 'a' : undefined}
        title={tip(
          'compare',
          held ? 'Show the other of A and B' : 'Hold this dance as A to compare it with what comes',
        )}
        onClick={() => store.compare()}
      >
        A/B
      </button>
    </div>
  );
}
