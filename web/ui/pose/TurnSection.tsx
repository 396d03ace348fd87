import { headingOfPose } from '../../core/pose-tools';
import { useStore } from '../store-context';
import { Fold } from './Fold';
import { NumberField } from './NumberField';

/** Turns the whole figure about the vertical. */
export function TurnSection() {
  const store = useStore();
  const heading = (headingOfPose(store.state.draft.value!.rotations) * 180) / Math.PI;
  const set = (degrees: number) => {
    store.previewHeading(degrees);
    store.settlePose();
  };
  return (
    <Fold title="Turn the figure" summary={`${Math.round(heading) + 0}°`}>
      <div class="slider-row tone-key">
        <input
          type="range"
          aria-label="Where the figure faces"
          aria-valuetext={`${Math.round(heading) + 0} degrees`}
          min={-180}
          max={180}
          step={5}
          value={Math.round(heading)}
          style={{ '--fill': `${((heading + 180) / 360) * 100}%` }}
          onInput={(event) => store.previewHeading(Number(event.currentTarget.value))}
          onChange={() => store.settlePose()}
        />
        <NumberField
          label="Where the figure faces, degrees"
          step={15}
          min={-180}
          max={180}
          value={heading}
          onCommit={set}
        />
      </div>
      <p class="hint">0° looks to the front, 90° to the figure’s left.</p>
    </Fold>
  );
}
