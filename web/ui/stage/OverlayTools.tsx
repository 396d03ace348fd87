import { JOINTS } from '../../core/skeleton';
import { jointLabel } from '../../scene/pose-edit';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** Buttons for what is drawn around the figure to show time: ghosts and the path of a joint, with the choice of the joint. */
export function OverlayTools() {
  const store = useStore();
  const { onionShown, pathJoint, draft } = store.state;
  const joint = pathJoint.value;
  const picked = draft.value?.joint ?? null;
  return (
    <div class="overlay-tools" role="group" aria-label="Through time">
      {joint !== null && (
        <select
          class="path-joint"
          aria-label="Joint whose path is shown"
          title="Joint whose path is shown; or click a limb of the figure"
          value={String(picked ?? joint)}
          onChange={(event) => {
            const next = Number(event.currentTarget.value);
            store.showPathOf(next);
            if (picked !== null) store.selectJoint(next);
          }}
        >
          {JOINTS.map((name, index) => (
            <option key={name} value={String(index)}>
              {jointLabel(index)}
            </option>
          ))}
        </select>
      )}
      <button
        type="button"
        class="tool key-tool"
        aria-pressed={onionShown.value}
        aria-label="Ghosts of the neighbouring key poses"
        title={tip('ghosts')}
        onClick={() => store.toggleOnion()}
      >
        <Icon name="ghosts" />
      </button>
      <button
        type="button"
        class="tool motion-tool"
        aria-pressed={joint !== null}
        aria-label="Path of a joint"
        title={tip('path')}
        onClick={() => store.togglePath()}
      >
        <Icon name="path" />
      </button>
    </div>
  );
}
