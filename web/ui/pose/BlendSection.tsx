import { useComputed, useSignal } from '@preact/signals';
import type { BlendSource } from '../../app/actions/pose-blend';
import { useStore } from '../store-context';
import { Fold } from './Fold';
import { PercentSlider } from './PercentSlider';

/** Blends the pose with another one: live, and one step however far the slider goes. */
export function BlendSection() {
  const store = useStore();
  const { document, draft, poseBlend, poseClip } = store.state;
  const source = useSignal<BlendSource | ''>('');
  const poses = useComputed(() => [...store.state.ownPoses.value, ...store.state.poses.value]);
  const groups = useComputed(() => [...new Set(poses.value.map((pose) => pose.group))]);
  const blend = poseBlend.value;
  const percent = Math.round((blend?.amount ?? 0) * 100);
  const others = document.value.keyPoses.filter((key) => key.id !== draft.value?.keyId);

  return (
    <Fold title="Blend with another pose" summary={blend ? `${percent}%` : ''}>
      <label class="field">
        <span>Other pose</span>
        <select
          aria-label="Other pose"
          value={source.value}
          onChange={(event) => {
            source.value = event.currentTarget.value as BlendSource | '';
            if (blend && source.value) store.blendWith(source.value, blend.amount);
          }}
        >
          <option value="">Choose</option>
          {store.canBlend('previous') && <option value="previous">Key pose before</option>}
          {store.canBlend('next') && <option value="next">Key pose after</option>}
          {poseClip.value && store.canBlend('clip') && <option value="clip">Copied pose</option>}
          {others.length > 0 && (
            <optgroup label="Key poses">
              {others.map((key) => (
                <option key={key.id} value={`key:${key.id}`}>
                  {`${key.time.toFixed(1)} s ${key.name ?? 'Key pose'}`}
                </option>
              ))}
            </optgroup>
          )}
          {groups.value.map((group) => (
            <optgroup key={group} label={group}>
              {poses.value
                .filter((pose) => pose.group === group)
                .map((pose) => (
                  <option key={pose.id} value={`pose:${pose.id}`}>
                    {pose.name}
                  </option>
                ))}
            </optgroup>
          ))}
        </select>
      </label>
      <PercentSlider
        label="How much of the other pose"
        percent={percent}
        disabled={source.value === ''}
        onInput={(now) => {
          if (source.value) store.blendWith(source.value, now / 100);
        }}
      />
      {blend && (
        <div class="tool-row">
          <button type="button" class="quiet" onClick={() => store.cancelBlend()}>
            Take back
          </button>
          <button type="button" class="secondary" onClick={() => store.keepBlend()}>
            Keep
          </button>
        </div>
      )}
    </Fold>
  );
}
