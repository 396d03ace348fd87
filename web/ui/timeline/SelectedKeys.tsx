import { useId } from 'preact/hooks';
import { barAndBeat, exactBeat, timeOfBeat } from '../../app/snapping';
import { lastKeyTime } from '../../core/key-ops';
import type { KeyPose } from '../../core/types';
import { Slider } from '../inspector/Slider';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { AlternateTools } from '../suggest/AlternateTools';
import { PosePicture } from '../thumbs';
import { ToolButton } from '../ToolButton';

const strengthText = (value: number) =>
  value >= 0.995
    ? 'Hit as exactly as the key strength of the dance allows.'
    : value < 0.005
      ? 'Only a hint to the dancer.'
      : 'The dance passes near it.';

/** The key poses selected on the timeline: name, place and strength as fields, and what can be done with them. */
export function SelectedKeys() {
  const store = useStore();
  const { selection, document } = store.state;
  const chosen = document.value.keyPoses.filter((key) => selection.value.has(key.id));
  if (chosen.length === 0) return null;
  const [first] = chosen;
  const single = chosen.length === 1;
  const locked = chosen.every((key) => key.locked);
  // Of several with different strengths the slider shows the first.
  const strength = (chosen.find((key) => !key.locked) ?? first).strength ?? 1;
  return (
    <section class="selected selected-keys" aria-label="Selected key poses">
      <div class="selected-head">
        <div class="selected-picture">
          <PosePicture rotations={first.rotations} />
        </div>
        {single ? (
          <NameField pose={first} />
        ) : (
          <div class="selected-text">
            <strong>{chosen.length} key poses</strong>
            <small>{locked ? 'all locked' : 'change together'}</small>
          </div>
        )}
        <ToolButton
          icon={locked ? 'lock' : 'lockOpen'}
          label="Lock"
          title={tip('lock', locked ? 'Unlock' : 'Lock: keep as it is')}
          pressed={locked}
          onClick={() => store.toggleLock()}
        />
        {single && (
          <ToolButton
            icon="pencil"
            label="Edit pose"
            title="Edit pose (double-click it)"
            disabled={first.locked}
            onClick={() => store.editKey(first.id)}
          />
        )}
        <ToolButton
          icon="flip"
          label="Mirror"
          title={tip('mirror')}
          disabled={locked}
          onClick={() => store.mirrorKeys()}
        />
        <ToolButton
          icon="trash"
          label="Delete"
          title={tip('remove')}
          disabled={locked}
          onClick={() => store.deleteKeys()}
        />
      </div>
      <AlternateTools wide />
      {single && <PlaceFields pose={first} />}
      {!locked && (
        <Slider
          key={first.id}
          label="Strength"
          value={strength}
          text={strengthText}
          tone="key"
          onPreview={(value) => store.previewKeyStrength(value)}
          onCommit={(value) => store.setKeyStrength(value)}
        />
      )}
    </section>
  );
}

function NameField({ pose }: { pose: KeyPose }) {
  const store = useStore();
  return (
    <label class="selected-name">
      <span class="visually-hidden">Name of the key pose</span>
      <input
        key={pose.id}
        type="text"
        maxLength={200}
        placeholder="Key pose"
        value={pose.name ?? ''}
        readOnly={pose.locked}
        onChange={(event) => store.renameKey(pose.id, event.currentTarget.value)}
      />
    </label>
  );
}

/** Where a key pose is, in seconds and in bars and beats. */
function PlaceFields({ pose }: { pose: KeyPose }) {
  const store = useStore();
  const { grid, duration } = store.state;
  const place = barAndBeat(grid.value, pose.time);
  const beat = exactBeat(grid.value, pose.time);
  const bars = grid.value;
  return (
    <div class="selected-place">
      <NumberField
        label="Time, s"
        value={Math.round(pose.time * 1000) / 1000}
        min={0}
        max={Math.floor(lastKeyTime(duration.value) * 1000) / 1000}
        step={0.01}
        readOnly={pose.locked}
        onCommit={(value) => store.setKeyTime(pose.id, value)}
      />
      {bars && place && beat !== null && (
        <>
          <NumberField
            label="Bar"
            value={place.bar}
            min={1}
            max={bars.downbeats.length}
            step={1}
            readOnly={pose.locked}
            onCommit={(value) => store.setKeyTime(pose.id, timeOfBeat(bars, Math.round(value), beat))}
          />
          <NumberField
            label="Beat"
            value={beat}
            min={1}
            max={bars.beatsPerBar + 0.999}
            step={0.5}
            readOnly={pose.locked}
            onCommit={(value) => store.setKeyTime(pose.id, timeOfBeat(bars, place.bar, value))}
          />
        </>
      )}
    </div>
  );
}

function NumberField(props: {
  label: string;
  value: number;
  min: number;
  max: number;
  step: number;
  readOnly?: boolean;
  onCommit: (value: number) => void;
}) {
  const id = useId();
  const { label, value, min, max, step, readOnly, onCommit } = props;
  return (
    <div class="number-field">
      <label for={id}>{label}</label>
      <input
        id={id}
        type="number"
        value={value}
        min={min}
        max={max}
        step={step}
        readOnly={readOnly}
        onChange={(event) => {
          const field = event.currentTarget;
          const typed = field.valueAsNumber;
          if (Number.isFinite(typed)) onCommit(Math.min(Math.max(typed, min), max));
          // What was refused or rounded shows what is true.
          else field.value = String(value);
        }}
      />
    </div>
  );
}
