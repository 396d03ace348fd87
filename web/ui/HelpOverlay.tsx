import { useComputed, useSignal } from '@preact/signals';
import { Dialog } from './Dialog';
import { Icon } from './Icon';
import { keyText, SHORTCUTS } from './shortcuts';
import { useStore } from './store-context';

/** All keys, from the same table that binds them. */
export function HelpOverlay() {
  const store = useStore();
  const leaveTo = (run: () => void) => () => {
    store.toggleHelp(false);
    run();
  };
  return (
    <Dialog
      open={store.state.help.value}
      onClose={() => store.toggleHelp(false)}
      title="How it works"
      titleId="help-title"
    >
      {() => (
        <>
          <ol class="help-steps">
            <li>Drop a song anywhere on the page. Its beats appear on the timeline.</li>
            <li>Drag poses from the list onto the timeline. They snap to beats; hold Alt to place them freely.</li>
            <li>Double-click a pose to change it: click a joint on the figure and turn it.</li>
            <li>Press Generate. The figure dances through your poses.</li>
          </ol>
          <div class="help-ways">
            <button type="button" class="secondary" onClick={leaveTo(() => store.startTour())}>
              Show the first steps
            </button>
            <button type="button" class="secondary" onClick={leaveTo(() => void store.openDemo())}>
              Show the demo again
            </button>
          </div>
          <Keys />
          <p class="hint">
            <a href="licenses.txt" target="_blank" rel="noopener">
              Licences of what is inside
            </a>
          </p>
        </>
      )}
    </Dialog>
  );
}

/** The table of keys, found by what they do or by the key. */
function Keys() {
  const query = useSignal('');
  const found = useComputed(() => {
    const words = query.value.toLowerCase().split(/\s+/).filter(Boolean);
    return SHORTCUTS.filter(({ label, group, keys }) => {
      const text = `${label} ${group} ${keys.map(keyText).join(' ')}`.toLowerCase();
      return words.every((word) => text.includes(word));
    });
  });
  const groups = [...new Set(found.value.map((shortcut) => shortcut.group))];
  return (
    <>
      <label class="search">
        <Icon name="search" size={16} />
        <span class="visually-hidden">Search the keys</span>
        <input
          type="search"
          placeholder="Search the keys"
          value={query.value}
          onInput={(event) => (query.value = event.currentTarget.value)}
        />
      </label>
      {groups.length === 0 && <p class="empty">No key does that.</p>}
      <div class="help-groups">
        {groups.map((group) => (
          <section key={group}>
            <h3>{group}</h3>
            <dl>
              {found.value
                .filter((shortcut) => shortcut.group === group)
                .map((shortcut) => (
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
    </>
  );
}
