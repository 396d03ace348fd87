import { useStore } from './store-context';
import { Icon } from './Icon';
import { tip } from './shortcuts';

/** Over the stage while a pose is edited: what to do, and the ways out. */
export function PoseBar() {
  const store = useStore();
  const draft = store.state.draft.value;
  if (!draft) return null;
  const existing = draft.keyId !== null && store.state.document.value.keyPoses.some((key) => key.id === draft.keyId);
  return (
    <div class="pose-bar" role="toolbar" aria-label="Pose editor">
      <span class="pose-bar-hint">
        <strong>{existing ? 'Editing a key pose' : 'New pose'}</strong>
        <small>Click a joint, then turn it by its rings.</small>
      </span>
      <button type="button" class="quiet" onClick={() => store.closeDraft()}>
        Cancel
      </button>
      <button
        type="button"
        class="primary key-tone"
        onClick={() => store.keepDraft()}
        title={tip('add', existing ? 'Update' : 'Add to timeline')}
      >
        <Icon name="check" />
        {existing ? 'Update' : 'Add to timeline'}
      </button>
    </div>
  );
}
