import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { Fold } from './Fold';
import { PercentSlider } from './PercentSlider';

/** Random variations of the pose. */
export function VariationSection() {
  const store = useStore();
  const percent = Math.round(store.state.variationAmount.value * 100);
  return (
    <Fold title="Random variation" summary={`${percent}%`}>
      <PercentSlider
        label="How wild"
        percent={percent}
        min={5}
        step={5}
        onInput={(now) => store.setVariationAmount(now / 100)}
      />
      <button type="button" class="secondary" title={tip('pose-vary')} onClick={() => store.varyPose()}>
        <Icon name="dices" size={18} />
        Another variation
      </button>
      <p class="hint">Arms go far, the spine little, flat feet stay flat. Each press starts from the same pose.</p>
    </Fold>
  );
}
