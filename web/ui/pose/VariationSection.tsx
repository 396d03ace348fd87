import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { Fold } from './Fold';

/** Random variations of the pose. */
export function VariationSection() {
  const store = useStore();
  const percent = Math.round(store.state.variationAmount.value * 100);
  return (
    <Fold title="Random variation" summary={`${percent}%`}>
      <div class="slider-row tone-key">
        <input
          type="range"
          aria-label="How wild"
          aria-valuetext={`${percent} percent`}
          min={5}
          max={100}
          step={5}
          value={percent}
          style={{ '--fill': `${((percent - 5) / 95) * 100}%` }}
          onInput={(event) => store.setVariationAmount(Number(event.currentTarget.value) / 100)}
        />
        <output>{percent}%</output>
      </div>
      <button type="button" class="secondary" title={tip('pose-vary')} onClick={() => store.varyPose()}>
        <Icon name="dices" size={18} />
        Another variation
      </button>
      <p class="hint">Arms go far, the spine little, flat feet stay flat. Each press starts from the same pose.</p>
    </Fold>
  );
}
