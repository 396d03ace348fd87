import { axisAngleToEuler, type Degrees } from '../../app/euler';
import { JOINTS } from '../../core/skeleton';
import { jointLabel } from '../../scene/pose-edit';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

const AXES = ['x', 'y', 'z'] as const;

/** Numbers and tools for the pose on the gizmo. */
export function PoseEditor() {
  const store = useStore();
  const draft = store.state.draft.value;
  if (!draft) return null;
  const { joint, rotations } = draft;
  const degrees: Degrees | null = joint === null ? null : axisAngleToEuler(rotations.slice(joint * 3, joint * 3 + 3));

  const set = (axis: number, text: string) => {
    const value = Number(text);
    if (joint === null || !degrees || text === '' || !Number.isFinite(value)) return;
    const next: Degrees = [...degrees];
    next[axis] = Math.min(Math.max(value, -180), 180);
    store.setJointDegrees(joint, next);
  };

  return (
    <div class="pose-editor">
      <label class="field">
        <span>Joint</span>
        <select
          value={joint === null ? '' : String(joint)}
          onChange={(event) =>
            store.selectJoint(event.currentTarget.value === '' ? null : Number(event.currentTarget.value))
          }
        >
          <option value="">Choose, or click it on the figure</option>
          {JOINTS.map((name, index) => (
            <option key={name} value={String(index)}>
              {jointLabel(index)}
            </option>
          ))}
        </select>
      </label>
      <fieldset class="angles" disabled={degrees === null}>
        <legend>Turn, degrees</legend>
        {AXES.map((axis, index) => (
          <label key={axis} class={`axis axis-${axis}`}>
            <span>{axis}</span>
            <input
              type="number"
              step={5}
              min={-180}
              max={180}
              value={degrees ? String(Math.round(degrees[index] * 10) / 10) : ''}
              onChange={(event) => set(index, event.currentTarget.value)}
            />
          </label>
        ))}
      </fieldset>
      <div class="tool-row">
        <button type="button" class="secondary" onClick={() => store.mirrorDraft()} title={tip('mirror')}>
          <Icon name="flip" />
          Mirror
        </button>
        <button
          type="button"
          class="secondary"
          disabled={joint === null}
          onClick={() => joint !== null && store.resetJoint(joint)}
        >
          <Icon name="reset" />
          Reset joint
        </button>
      </div>
      <p class="hint">
        Each turn can be undone. Turning the hips turns the whole body. The dance passes through this pose exactly when
        key strength is 100%.
      </p>
    </div>
  );
}
