import { useSignal } from '@preact/signals';
import { Icon } from '../Icon';
import { useStore } from '../store-context';

/** Keeps the pose in the editor in the visitor's own library. */
export function SaveDraft() {
  const store = useStore();
  const draft = store.state.draft.value;
  const name = useSignal<string | null>(null);
  if (!draft) return null;
  const text = name.value ?? draft.name;
  return (
    <form
      class="save-draft"
      onSubmit={(event) => {
        event.preventDefault();
        store.saveDraftPose(text);
      }}
    >
      <input
        type="text"
        aria-label="Name of the pose"
        placeholder="Name of the pose"
        maxLength={80}
        value={text}
        onInput={(event) => (name.value = event.currentTarget.value)}
      />
      <button type="submit" class="secondary" title="Save the pose to My poses in the library">
        <Icon name="bookmark" />
        Save
      </button>
    </form>
  );
}
