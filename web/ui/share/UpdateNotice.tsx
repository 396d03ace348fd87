import { Icon } from '../Icon';
import { useStore } from '../store-context';

/** A newer page is ready: it takes this one's place only when the visitor says so. */
export function UpdateNotice() {
  const store = useStore();
  const { update, updateRisk } = store.state;
  const install = update.value;
  if (!install) return null;
  return (
    <div class="notice info update" role="status">
      <Icon name="info" />
      <span>
        {updateRisk.value
          ? 'This browser does not keep your work: reloading now would lose it. Save the project as a file first.'
          : 'A newer Posebeat is ready. Your work is saved before the page reloads.'}
      </span>
      {updateRisk.value && (
        <button type="button" class="secondary" onClick={() => void store.saveProject(true)}>
          Save the project
        </button>
      )}
      <button type="button" class="secondary" onClick={() => void install()}>
        {updateRisk.value ? 'Reload anyway' : 'Reload'}
      </button>
      <button type="button" class="tool" aria-label="Dismiss" onClick={() => store.laterUpdate()}>
        <Icon name="close" size={16} />
      </button>
    </div>
  );
}
