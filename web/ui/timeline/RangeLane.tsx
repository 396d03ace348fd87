import { signal, useComputed, useSignalEffect } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { rangeInHand } from '../../app/actions/ranges';
import { rangeName } from '../../app/range-name';
import type { TakeRange } from '../../core/document';
import { useStore } from '../store-context';
import { LANES } from './geometry';
import { RANGE_MENU_ID, RangeMenu } from './RangeMenu';

/** A chip narrower than this says nothing, CSS pixels. */
const ROOM = 26;
/** A chip is never narrower than this, so that it can be hit. */
const NARROWEST = 14;

/** The range whose menu is open, or was last. */
const menuFor = signal<string | null>(null);

/** "2/3": the take on stage of how many; "–/3" where the whole dance is. */
export function takeText({ takes, chosen }: TakeRange): string {
  const index = takes.findIndex(({ id }) => id === chosen);
  return `${index < 0 ? '–' : index + 1}/${takes.length}`;
}

/** Ranges that were made anew, as chips with their takes. */
export function RangeLane() {
  const store = useStore();
  const { state } = store;
  const layer = useRef<HTMLDivElement>(null);
  const opener = useRef<HTMLButtonElement | null>(null);
  const scale = useComputed(() => state.view.value.pixelsPerSecond);

  // Straight to the element: a render per frame would be waste.
  useSignalEffect(() => {
    const { start, pixelsPerSecond } = state.view.value;
    if (layer.current) layer.current.style.transform = `translateX(${-start * pixelsPerSecond}px)`;
  });

  const { ranges } = state.document.value;
  const loop = state.loop.value;
  const inHand = loop ? rangeInHand(state)?.id : undefined;
  const shown = ranges.find(({ id }) => id === menuFor.value);
  return (
    <div
      class="range-lane"
      role="list"
      aria-label={`Ranges with takes, ${ranges.length}`}
      style={{ top: `${LANES.ranges.top}px`, height: `${LANES.ranges.height}px` }}
    >
      <div class="range-layer" ref={layer} role="presentation">
        {ranges.map((range) => (
          <RangeChip
            key={range.id}
            range={range}
            scale={scale.value}
            selected={range.id === inHand}
            onOpen={(button) => {
              opener.current = button;
              if (menuFor.value === range.id) return;
              // It is another range's: the click that follows opens it anew, in its place.
              document.getElementById(RANGE_MENU_ID)?.hidePopover();
              menuFor.value = range.id;
            }}
          />
        ))}
      </div>
      {shown && <RangeMenu range={shown} opener={opener} />}
    </div>
  );
}

function RangeChip(props: {
  range: TakeRange;
  scale: number;
  selected: boolean;
  onOpen: (button: HTMLButtonElement) => void;
}) {
  const { range, scale, selected } = props;
  const store = useStore();
  const width = Math.max(NARROWEST, (range.end - range.start) * scale - 2);
  const index = range.takes.findIndex(({ id }) => id === range.chosen);
  const name = rangeName(store.state.grid.value, range);
  const take = index < 0 ? 'the whole dance' : `take ${index + 1} of ${range.takes.length}`;

  const onKeyDown = (event: KeyboardEvent) => {
    const act: Record<string, () => void> = {
      ArrowLeft: () => void store.stepTake(-1, range.id),
      ArrowRight: () => void store.stepTake(1, range.id),
      Delete: () => void store.deleteRange(range.id),
      Backspace: () => void store.deleteRange(range.id),
    };
    const run = act[event.key];
    if (!run || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    run();
  };

  return (
    <div role="listitem" class="range-item" style={{ left: `${range.start * scale + 1}px` }}>
      <button
        type="button"
        class={`range-chip ${index < 0 ? 'whole' : ''} ${selected ? 'in-hand' : ''}`}
        data-grab
        data-range={range.id}
        popovertarget={RANGE_MENU_ID}
        aria-haspopup="dialog"
        aria-label={`${name[0].toUpperCase()}${name.slice(1)}, ${take}`}
        title={`${name[0].toUpperCase()}${name.slice(1)}: ${take}. Left and right switch takes, Delete deletes the range.`}
        style={{ width: `${width}px` }}
        // Before the click that opens the menu, so that the menu knows whose it is.
        onPointerDown={(event) => props.onOpen(event.currentTarget)}
        onClick={(event) => props.onOpen(event.currentTarget)}
        onKeyDown={onKeyDown}
        onFocus={(event) => props.onOpen(event.currentTarget)}
      >
        {width >= ROOM && <span>{takeText(range)}</span>}
      </button>
    </div>
  );
}
