import { useEffect, useRef } from 'preact/hooks';
import { Icon } from './Icon';
import { keyText, SHORTCUTS } from './shortcuts';
import { useStore } from './store-context';

/** All keys, from the same table that binds them. */
export function HelpOverlay() {
  const store = useStore();
  const open = store.state.help.value;
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (open) dialog.current?.showModal();
    else dialog.current?.close();
  }, [open]);
  const groups = [...new Set(SHORTCUTS.map((shortcut) => shortcut.group))];
  return (
    <dialog
      class="help"
      ref={dialog}
      aria-labelledby="help-title"
      onClose={() => store.toggleHelp(false)}
      onClick={(event) => event.target === dialog.current && store.toggleHelp(false)}
    >
      {open && (
        <div class="help-body">
          <div class="help-head">
            <h2 id="help-title">How it works</h2>
            <button type="button" class="tool" aria-label="Close" onClick={() => store.toggleHelp(false)}>
              <Icon name="close" />
            </button>
          </div>
          <ol class="help-steps">
            <li>Drop a song anywhere on the page. Its beats appear on the timeline.</li>
            <li>Drag poses from the list onto the timeline. They snap to beats; hold Alt to place them freely.</li>
            <li>Double-click a pose to change it: click a joint on the figure and turn it.</li>
            <li>Press Generate. The figure dances through your poses.</li>
          </ol>
          <div class="help-groups">
            {groups.map((group) => (
              <section key={group}>
                <h3>{group}</h3>
                <dl>
                  {SHORTCUTS.filter((shortcut) => shortcut.group === group).map((shortcut) => (
                    <div key={shortcut.id}>
                      <dt>
                        {shortcut.keys.map((combo) => (
                          <kbd key={combo}>{keyText(combo)}</kbd>
                        ))}
                      </dt>
                      <dd>{shortcut.label}</dd>
                    </div>
                  ))}
                </dl>
              </section>
            ))}
          </div>
          <button
            type="button"
            class="quiet"
            onClick={() => {
              store.toggleHelp(false);
              void store.openDemo();
            }}
          >
            Show the demo again
          </button>
        </div>
      )}
    </dialog>
  );
}
