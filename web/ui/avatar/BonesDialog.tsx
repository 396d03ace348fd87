import type { AvatarMapping } from '../../app/avatar-state';
import { jointIndex } from '../../core/skeleton';
import { jointLabel } from '../../scene/pose-edit';
import { Dialog } from '../Dialog';
import { Icon } from '../Icon';
import { useStore } from '../store-context';

const sided = (side: string, joints: string[]) => joints.map((joint) => jointIndex(`${side}_${joint}`));
const ARM = ['collar', 'shoulder', 'elbow', 'wrist', 'hand'];
const LEG = ['hip', 'knee', 'ankle', 'foot'];
/** Our joints, as a body is looked through. */
const GROUPS: readonly { title: string; joints: readonly number[] }[] = [
  { title: 'Middle', joints: ['pelvis', 'spine1', 'spine2', 'spine3', 'neck', 'head'].map(jointIndex) },
  { title: 'Left arm', joints: sided('left', ARM) },
  { title: 'Right arm', joints: sided('right', ARM) },
  { title: 'Left leg', joints: sided('left', LEG) },
  { title: 'Right leg', joints: sided('right', LEG) },
];

/** Which bone of a character is which joint of ours. The character shows it on the stage beside. */
export function BonesDialog() {
  const store = useStore();
  const { avatarMapping } = store.state;
  return (
    <Dialog
      open={avatarMapping.value !== null}
      onClose={() => store.cancelBones()}
      title="Which bone is which?"
      titleId="bones-title"
      kind="bones-panel"
      bodyClass="bones-body"
      keepsKeys
    >
      {() => avatarMapping.value && <Contents mapping={avatarMapping.value} />}
    </Dialog>
  );
}

function Contents({ mapping }: { mapping: AvatarMapping }) {
  const store = useStore();
  const { name, map, guess, joints: known, problems, notes, usable, byShape } = mapping;
  const wrong = problems.filter((problem) => problem !== null).length;
  const changed = map.some((node, joint) => node !== guess[joint]);
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        store.acceptBones();
      }}
    >
      <p class="hint">
        “{name}” stands on the stage and dances with what is chosen here; a dot shows the bone that you are at. Bones
        that it lacks may stay empty.
      </p>
      <p class={`bones-state ${wrong > 0 ? 'wrong' : ''}`} role="status">
        <Icon name={wrong > 0 ? 'warning' : 'check'} size={16} />
        {wrong > 0
          ? `${wrong === 1 ? 'One joint needs' : `${wrong} joints need`} a look.`
          : byShape
            ? 'Its names say nothing: the bones were told by where they are.'
            : 'Every bone that is needed has been found.'}
      </p>
      {notes.map((note) => (
        <p key={note} class="bones-state wrong">
          <Icon name="warning" size={16} />
          {note}
        </p>
      ))}
      <div class="bones-groups">
        {GROUPS.map(({ title, joints }) => (
          <fieldset key={title}>
            <legend>{title}</legend>
            {joints
              .filter((joint) => known.includes(joint))
              .map((joint) => (
                <BoneField key={joint} joint={joint} mapping={mapping} />
              ))}
          </fieldset>
        ))}
      </div>
      <div class="bones-foot">
        {changed && (
          <button
            type="button"
            class="quiet"
            title="Back to the bones that were guessed"
            onClick={() => store.guessBones()}
          >
            Reset
          </button>
        )}
        <button type="button" class="secondary" onClick={() => store.cancelBones()}>
          Cancel
        </button>
        <button type="submit" class="primary motion-tone" disabled={!usable}>
          Use these bones
        </button>
      </div>
    </form>
  );
}

function BoneField({ joint, mapping }: { joint: number; mapping: AvatarMapping }) {
  const store = useStore();
  const { bones, map, problems } = mapping;
  const problem = problems[joint];
  const id = `bone-${joint}`;
  return (
    <div class={`bone-field ${problem ? 'wrong' : ''}`}>
      <label for={id}>{jointLabel(joint)}</label>
      <select
        id={id}
        value={String(map[joint])}
        aria-invalid={problem !== null}
        aria-describedby={problem ? `${id}-problem` : undefined}
        autofocus={joint === 0}
        onFocus={() => store.pointAtBone(joint)}
        onBlur={() => store.pointAtBone(null)}
        onChange={(event) => store.chooseBone(joint, Number(event.currentTarget.value))}
      >
        <option value="-1">None</option>
        {bones.map(({ node, name }) => (
          <option key={node} value={String(node)}>
            {name}
          </option>
        ))}
      </select>
      {problem && <small id={`${id}-problem`}>{problem}</small>}
    </div>
  );
}
