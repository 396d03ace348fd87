import { jointLabel } from '../scene/pose-edit';
import { useStore } from './store-context';
import { Icon } from './Icon';
import { startPoseDrag } from './pose-drag';
import { tip } from './shortcuts';
import { PosePicture } from './thumbs';

/** Over the stage while a pose is edited: what to do, and the ways out. */
export function PoseBar() {
  const store = useStore();
  const { draft: signal, document, poseBlend, poseWord, poseTools } = store.state;
  const draft = signal.value;
  if (!draft) return null;
  const existing = draft.keyId !== null && document.value.keyPoses.some((key) => key.id === draft.keyId);
  const moving = poseTools.value.mode === 'move';
  const blend = poseBlend.value;
  const hint = blend
    ? `${Math.round(blend.amount * 100)}% ${blend.name}. Esc takes it back.`
    : draft.joint === null
      ? `Click a joint, then ${moving ? 'drag it: the body follows' : 'turn it by its rings'}.`
      : `${jointLabel(draft.joint)}: ${moving ? 'drag it, or use' : 'turn its rings, or use'} the arrow keys.`;
  return (
    <div class="pose-bar" role="toolbar" aria-label="Pose editor">
      <span class="pose-bar-hint">
        <strong>{existing ? 'Editing a key pose' : 'New pose'}</strong>
        <small class={poseWord.value ? 'word' : ''}>{poseWord.value || hint}</small>
      </span>
      <button type="button" class="quiet" onClick={() => store.closeDraft()}>
        Cancel
      </button>
      <button
        type="button"
        class="primary key-tone"
        onPointerDown={(event) => startPoseDrag(event, draft, store, (time) => store.dropDraftAt(time))}
        onClick={(event) => {
          if (!event.currentTarget.dataset.dragged) store.keepDraft();
        }}
        title={`${tip('add', existing ? 'Update' : 'Add to timeline')}, or drag ${existing ? 'a copy' : 'it'} to a beat`}
      >
        <PosePicture rotations={draft.rotations} />
        <Icon name="check" />
        {existing ? 'Update' : 'Add to timeline'}
      </button>
    </div>
  );
}
