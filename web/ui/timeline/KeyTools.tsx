import { Icon, type IconName } from '../Icon';
import { AlternateTools } from '../suggest/AlternateTools';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** What can be done with the selected key poses, in the timeline's bar. */
export function KeyTools() {
  const store = useStore();
  const { selection, document, keysCopied } = store.state;
  const chosen = document.value.keyPoses.filter((key) => selection.value.has(key.id));
  const count = chosen.length;
  if (count === 0 && keysCopied.value === 0) return null;
  const allLocked = count > 0 && chosen.every((key) => key.locked);
  const tool = (name: IconName, label: string, title: string, run: () => void) => (
    <button type="button" class="tool bar-tool" aria-label={label} title={title} onClick={run}>
      <Icon name={name} size={18} />
    </button>
  );
  return (
    <div class="bar-group key-tools" role="group" aria-label="Selected key poses: tools">
      {count > 0 && (
        <>
          <span class="bar-label key-count">
            <span class="diamond-sign" aria-hidden="true" />
            {count === 1 ? '1 key pose' : `${count} key poses`}
          </span>
          <AlternateTools />
          <button
            type="button"
            class="tool bar-tool"
            aria-pressed={allLocked}
            aria-label="Lock"
            title={tip('lock', allLocked ? 'Unlock: let them be moved and edited' : 'Lock: keep them as they are')}
            onClick={() => store.toggleLock()}
          >
            <Icon name={allLocked ? 'lock' : 'lockOpen'} size={18} />
          </button>
          {count > 1 &&
            tool('distribute', 'Distribute', tip('distribute', 'Distribute evenly on the grid'), () =>
              store.distributeKeys(),
            )}
          {tool('duplicate', 'Duplicate', tip('keys-duplicate', 'Duplicate by a bar'), () => store.duplicateKeys())}
          {tool('copy', 'Copy key poses', tip('keys-copy'), () => store.copyKeys())}
        </>
      )}
      {keysCopied.value > 0 &&
        tool('paste', 'Paste key poses', tip('keys-paste', 'Paste key poses at the playhead'), () => store.pasteKeys())}
      {count > 0 && tool('trash', 'Delete key poses', tip('remove', 'Delete'), () => store.deleteKeys())}
    </div>
  );
}
