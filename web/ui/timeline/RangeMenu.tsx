import type { RefObject } from 'preact';
import { useRef } from 'preact/hooks';
import { rangeName } from '../../app/range-name';
import type { TakeRange } from '../../core/document';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { closeMenu, leaveByEscape, MARGIN } from '../popover';
import { useStore } from '../store-context';

/** Id of the menu's element, for the chips that open it. */
export const RANGE_MENU_ID = 'range-menu';
/** The takes of a range: choose, delete, make another. A popover of the browser's own. */
export function RangeMenu({ range, opener }: { range: TakeRange; opener: RefObject<HTMLButtonElement | null> }) {
  const store = useStore();
  const { grid, generation } = store.state;
  const menu = useRef<HTMLDivElement>(null);
  const name = rangeName(grid.value, range);
  const busy = generation.value.status !== 'idle';

  const place = () => {
    const [element, chip] = [menu.current!, opener.current?.getBoundingClientRect()];
    if (!chip) return;
    const { width } = element.getBoundingClientRect();
    const left = Math.max(chip.left, 0);
    element.style.left = `${Math.max(MARGIN, Math.min(left, innerWidth - width - MARGIN))}px`;
    element.style.bottom = `${innerHeight - chip.top + MARGIN}px`;
    element.style.maxHeight = `${chip.top - 2 * MARGIN}px`;
  };
  const close = () => closeMenu(menu.current, opener.current);

  const choices = [
    { id: null, label: 'Whole dance' },
    ...range.takes.map(({ id }, i) => ({ id, label: `Take ${i + 1}` })),
  ];
  return (
    <div
      id={RANGE_MENU_ID}
      ref={menu}
      class="range-menu"
      popover="auto"
      role="dialog"
      aria-label={`Takes of ${name}`}
      data-grab
      onToggle={(event) => {
        if (event.newState !== 'open') return;
        place();
        menu.current?.querySelector<HTMLElement>('input:checked')?.focus();
      }}
      onKeyDown={(event) => leaveByEscape(event, close)}
    >
      <p class="range-title">{`${name[0].toUpperCase()}${name.slice(1)}`}</p>
      <div role="radiogroup" aria-label="On stage">
        {choices.map(({ id, label }) => (
          <div class="range-choice" key={id ?? ''}>
            <label>
              <input
                type="radio"
                name="range-take"
                checked={range.chosen === id}
                onChange={() => void store.chooseTake(range.id, id)}
              />
              <span>{label}</span>
            </label>
            {id !== null && (
              <button
                type="button"
                class="tool"
                aria-label={`Delete ${label.toLowerCase()}`}
                title={`Delete ${label.toLowerCase()}`}
                onClick={() => {
                  if (range.takes.length === 1) close();
                  void store.deleteTake(range.id, id);
                }}
              >
                <Icon name="trash" size={16} />
              </button>
            )}
          </div>
        ))}
      </div>
      <button
        type="button"
        class="secondary full"
        disabled={busy}
        title={tip('regenerate', 'Another take of this range')}
        onClick={() => void store.regenerateRange(range)}
      >
        <Icon name="dices" />
        Another take
      </button>
      <div class="range-actions">
        <button
          type="button"
          class="quiet"
          title="Selects the range and repeats it while playing"
          onClick={() => store.setLoop({ start: range.start, end: range.end })}
        >
          <Icon name="repeat" size={16} />
          Loop it
        </button>
        <button
          type="button"
          class="quiet"
          title="Deletes the range with its takes; undo brings it back"
          onClick={() => {
            menu.current?.hidePopover();
            void store.deleteRange(range.id);
          }}
        >
          <Icon name="trash" size={16} />
          Delete range
        </button>
      </div>
    </div>
  );
}
