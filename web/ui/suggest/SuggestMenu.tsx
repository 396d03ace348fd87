import type { ComponentChildren, RefObject } from 'preact';
import { useRef } from 'preact/hooks';
import type { SuggestPlace } from '../../app/suggester';
import { rangeName } from '../../app/range-name';
import { spec } from '../../core/spec';
import type { Density } from '../../core/suggest';
import { Icon } from '../Icon';
import { Slider } from '../inspector/Slider';
import { leaveByEscape, closeMenu, placeMenu } from '../popover';
import { useStore } from '../store-context';

/** Id of the menu's element, for the button that opens it. */
export const SUGGEST_MENU_ID = 'suggest-menu';
const DENSITIES: readonly { value: Density; label: string; title: string }[] = [
  { value: 'beat', label: 'Beat', title: 'A pose on every beat' },
  { value: 'half', label: 'Half bar', title: 'Two poses in each bar' },
  { value: 'bar', label: 'Bar', title: 'A pose at the start of each bar' },
];

const boldness = (value: number) =>
  value < 0.25
    ? 'The likeliest poses for this music.'
    : value < 0.75
      ? 'Lively, like real dancers.'
      : 'Bold: expect surprises.';

/** What to suggest: how many poses, where, in which style, how bold. A popover of the browser's own. */
export function SuggestMenu({ opener }: { opener: RefObject<HTMLButtonElement | null> }) {
  const store = useStore();
  const { suggestChoice, loop, grid, document: project } = store.state;
  const menu = useRef<HTMLDivElement>(null);
  const { density, variation, style } = suggestChoice.value;
  const own = project.value.keyPoses.filter((key) => !key.suggested || key.locked).length;
  const places: { value: SuggestPlace; label: string; title: string; off: boolean }[] = [
    { value: 'all', label: 'Everywhere', title: 'All that is danced, around your own poses', off: false },
    {
      value: 'range',
      label: loop.value ? capital(rangeName(grid.value, loop.value)) : 'Range',
      title: loop.value ? 'Only the selected range' : 'Drag over the bar numbers first, to select a range',
      off: loop.value === null,
    },
    {
      value: 'gaps',
      label: 'Gaps only',
      title: own > 1 ? 'Only between your own poses' : 'Place two poses of your own first',
      off: own < 2,
    },
  ];
  // A choice that is not there any more falls back to the whole.
  const place = places.find(({ value, off }) => value === suggestChoice.value.place && !off)?.value ?? 'all';

  return (
    <div
      id={SUGGEST_MENU_ID}
      ref={menu}
      class="beat-menu suggest-menu"
      popover="auto"
      role="dialog"
      aria-label="What to suggest"
      onToggle={(event) => {
        if (event.newState !== 'open') return;
        placeMenu(menu.current!, opener.current!);
        store.warmSuggester();
        menu.current?.querySelector<HTMLElement>('input:checked')?.focus();
      }}
      onKeyDown={(event) => leaveByEscape(event, () => closeMenu(menu.current, opener.current))}
    >
      <Choices label="A pose every">
        {DENSITIES.map((each) => (
          <Choice
            key={each.value}
            name="suggest-density"
            {...each}
            checked={density === each.value}
            onChoose={() => store.chooseSuggestion({ density: each.value })}
          />
        ))}
      </Choices>
      <Choices label="Where">
        {places.map((each) => (
          <Choice
            key={each.value}
            name="suggest-place"
            {...each}
            checked={place === each.value}
            onChoose={() => store.chooseSuggestion({ place: each.value })}
          />
        ))}
      </Choices>
      <label class="beat-row suggest-style">
        <span>Style</span>
        <select
          value={style ?? ''}
          onChange={(event) => store.chooseSuggestion({ style: event.currentTarget.value || null })}
        >
          <option value="">Whatever fits</option>
          {spec.danceformer.styles.map((each) => (
            <option key={each} value={each}>
              {capital(each)}
            </option>
          ))}
        </select>
      </label>
      <Slider
        label="Variation"
        value={variation}
        text={boldness}
        tone="key"
        onCommit={(value) => store.chooseSuggestion({ variation: value })}
      />
      <button
        type="button"
        class="suggest-go"
        onClick={() => {
          menu.current?.hidePopover();
          void store.suggestForPage();
        }}
      >
        <Icon name="sparkles" size={16} />
        Suggest key poses
      </button>
      <p class="hint">Your own and locked key poses stay as they are. One undo takes the suggestions back.</p>
    </div>
  );
}

function Choices({ label, children }: { label: string; children: ComponentChildren }) {
  return (
    <div class="beat-row" role="radiogroup" aria-label={label}>
      <span aria-hidden="true">{label}</span>
      {children}
    </div>
  );
}

interface ChoiceProps {
  name: string;
  label: string;
  title: string;
  checked: boolean;
  off?: boolean;
  onChoose: () => void;
}

function Choice({ name, label, title, checked, off = false, onChoose }: ChoiceProps) {
  return (
    <label class="snap-choice" title={title}>
      <input type="radio" class="visually-hidden" name={name} checked={checked} disabled={off} onChange={onChoose} />
      <span>{label}</span>
    </label>
  );
}

const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
