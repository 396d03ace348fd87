import { Icon } from '../Icon';
import { useStore } from '../store-context';

/** Why there is no video to be made, and the way to the other files. */
export function NoVideo({ text }: { text: string }) {
  const store = useStore();
  return (
    <div class="export-empty">
      <Icon name="follow" size={32} />
      <p>{text}</p>
      <button
        type="button"
        class="secondary"
        onClick={() => {
          store.toggleVideo(false);
          store.toggleExport(true);
        }}
      >
        Other files
      </button>
    </div>
  );
}
