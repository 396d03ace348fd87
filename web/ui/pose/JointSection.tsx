import { axisAngleToEuler, type Degrees } from '../../app/euler';
import { limbLabel } from '../../app/limb-labels';
import { LIMBS, worldTurn, type Limb } from '../../core/pose-tools';
import { poseToQuaternions, quaternionToAxisAngle } from '../../core/rotation';
import { forwardKinematics } from '../../core/skeleton';
import { standingRoot } from '../../scene/body-points';
import { jointLabel } from '../../scene/pose-edit';
import { Icon } from '../Icon';
import { useStore } from '../store-context';
import { NumberField } from './NumberField';

const AXES = ['x', 'y', 'z'] as const;
const GROUPS: readonly Limb[] = ['head', 'torso', 'left_arm', 'right_arm', 'left_leg', 'right_leg'];

/** Which joint, and its numbers: degrees while turning, centimetres while moving. */
export function JointSection() {
  const store = useStore();
  const draft = store.state.draft.value!;
  const { mode } = store.state.poseTools.value;
  const { joint } = draft;
  return (
    <div class="pose-section">
      <div class="joint-row">
        <label class="field">
          <span>Joint</span>
          <select
            aria-label="Joint"
            value={joint === null ? '' : String(joint)}
            onChange={(event) =>
              store.selectJoint(event.currentTarget.value === '' ? null : Number(event.currentTarget.value))
            }
          >
            <option value="">Choose, or click the figure</option>
            <option value="0">{jointLabel(0)}</option>
            {GROUPS.map((limb) => (
              <optgroup key={limb} label={limbLabel(limb)}>
                {LIMBS[limb].map((index) => (
                  <option key={index} value={String(index)}>
                    {jointLabel(index)}
                  </option>
                ))}
              </optgroup>
            ))}
          </select>
        </label>
        <button
          type="button"
          class="secondary square"
          aria-label="Reset joint"
          title="Put this joint back to rest"
          disabled={joint === null}
          onClick={() => joint !== null && store.resetJoint(joint)}
        >
          <Icon name="reset" />
        </button>
      </div>
      {mode === 'move' ? <Place /> : <Angles />}
    </div>
  );
}

function Angles() {
  const store = useStore();
  const { joint, rotations } = store.state.draft.value!;
  const world = store.state.poseTools.value.space === 'world';
  const degrees: Degrees | null =
    joint === null
      ? null
      : axisAngleToEuler(
          world ? quaternionToAxisAngle(worldTurn(rotations, joint)) : rotations.slice(joint * 3, joint * 3 + 3),
        );
  const set = (axis: number, value: number) => {
    if (joint === null || !degrees) return;
    const next: Degrees = [...degrees];
    next[axis] = value;
    store.setJointDegrees(joint, next);
  };
  return (
    <fieldset class="angles">
      <legend>{world ? 'Turn about the world’s axes, degrees' : 'Turn about its own axes, degrees'}</legend>
      {AXES.map((axis, index) => (
        <NumberField
          key={axis}
          label={`Turn ${axis}, degrees`}
          prefix={axis}
          tone={`axis-${axis}`}
          step={5}
          min={-180}
          max={180}
          value={degrees ? degrees[index] : null}
          onCommit={(value) => set(index, value)}
        />
      ))}
    </fieldset>
  );
}

/** Where a joint is, standing on the floor at the centre of the stage, metres. */
function placeOf(rotations: readonly number[], joint: number): [number, number, number] {
  const quaternions = poseToQuaternions(rotations);
  const [x, y, z] = forwardKinematics(quaternions, standingRoot(quaternions)).subarray(joint * 3, joint * 3 + 3);
  return [x, y, z];
}

function Place() {
  const store = useStore();
  const { joint, rotations } = store.state.draft.value!;
  const place = joint === null ? null : placeOf(rotations, joint);
  const words = ['to its left', 'up', 'to the front'];
  const set = (axis: number, centimetres: number) => {
    if (joint === null || !place) return;
    const next: [number, number, number] = [...place];
    next[axis] = centimetres / 100;
    void store.moveJointTo(joint, next);
  };
  return (
    <fieldset class="angles">
      <legend>Place, centimetres: left, up, front</legend>
      {AXES.map((axis, index) => (
        <NumberField
          key={axis}
          label={`Place ${words[index]}, centimetres`}
          prefix={axis}
          tone={`axis-${axis}`}
          step={2}
          value={place ? place[index] * 100 : null}
          onCommit={(value) => set(index, value)}
        />
      ))}
    </fieldset>
  );
}
