import { useComputed, useSignalEffect } from '@preact/signals';
import type { VNode } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { useStore } from '../store-context';
import { SuggestLane } from '../suggest/SuggestLane';
import { barAndBeat, clockTime } from '../../app/snapping';
import { keyWidths, LANES, placeKeys, stretchInSight, timeToX, type PlacedKey } from './geometry';
import { KeyButton } from './KeyButton';
import { band, dragHint, focusedKey } from './lane-signals';
import { dropTime } from './surface';

/** An element and what it was made from; the same again is not rendered again. */
interface Made {
  from: readonly unknown[];
  element: VNode;
}

/** Key poses as a list of buttons, placed on their times. */
export function KeyLane() {
  const store = useStore();
  const { state } = store;
  const list = useRef<HTMLDivElement>(null);
  const rail = useRef<HTMLDivElement>(null);
  const made = useRef(new Map<string, Made>());
  const scale = useComputed(() => state.view.value.pixelsPerSecond);
  // As text, so that an equal stretch is no change.
  const stretch = useComputed(() => JSON.stringify(stretchInSight(state.view.value, state.viewWidth.value)));
  const keys = useComputed(() => state.document.value.keyPoses);
  const widths = useComputed(() => keyWidths(keys.value, scale.value));

  const selection = state.selection.value;
  const focused = focusedKey.value;
  const placed = placeKeys(
    keys.value,
    widths.value,
    scale.value,
    JSON.parse(stretch.value),
    new Set(focused ? [focused] : []),
  );
  // One stop for the Tab key: the focused one, else the first selected, else the first in sight.
  const stop = placed.find(({ key }) => key.id === focused) ?? placed.find(({ key }) => selection.has(key.id));
  const stopId = (stop ?? placed[0])?.key.id;

  const seen = new Map<string, Made>();
  const buttons = placed.map((place) => {
    const from = [place.key, place.index, place.width, selection.has(place.key.id), place.key.id === stopId];
    const count = keys.value.length;
    const all = [...from, count, state.grid.value];
    const before = made.current.get(place.key.id);
    const same = before !== undefined && before.from.every((part, i) => part === all[i]);
    const next = same ? before : { from: all, element: item(place, count, from[3] as boolean, from[4] as boolean) };
    seen.set(place.key.id, next);
    return next.element;
  });
  made.current = seen;

  // Panning only moves the rail: nothing is rendered or laid out.
  useSignalEffect(() => {
    const { start, pixelsPerSecond } = state.view.value;
    rail.current?.style.setProperty('transform', `translateX(${-start * pixelsPerSecond}px)`);
  });
  // A change of scale renders the lane, and after that each key pose goes to its place.
  useLayoutEffect(() => placeItems(rail.current, scale.peek()));

  useLayoutEffect(() => {
    // Moving an element in the list takes its focus away, and a walk along the list gives it to another: put it there.
    const id = focusedKey.value;
    if (!id || !(document.activeElement === document.body || list.current?.contains(document.activeElement))) return;
    const button = list.current?.querySelector<HTMLElement>(`[data-key="${CSS.escape(id)}"]`);
    if (button && button !== document.activeElement) button.focus({ preventScroll: true });
  });

  return (
    <div
      class="key-lane"
      // A list without items is none.
      role={keys.value.length > 0 ? 'list' : 'group'}
      aria-label={`Key poses, ${keys.value.length}`}
      ref={list}
      style={{ top: `${LANES.keys.top}px`, height: `${LANES.keys.height}px` }}
    >
      {keys.value.length === 0 && dropTime.value === null && state.duration.value > 0 && (
        <p class="lane-hint with-suggest">
          <SuggestLane />
          <span class="lane-words">Drag a pose here, or choose one in the list: it lands on a beat.</span>
        </p>
      )}
      {state.duration.value === 0 && state.songJob.value === null && (
        <p class="lane-hint">Drop a song on the page: its beats appear here, and poses land on them.</p>
      )}
      <div class="key-rail" ref={rail} role="presentation">
        {buttons}
      </div>
      <Marks />
    </div>
  );
}

/** Puts each key pose on its time. An inherited variable for the scale would cost the style of everything inside, each frame. */
function placeItems(rail: HTMLElement | null, pixelsPerSecond: number): void {
  for (const element of rail?.children ?? []) {
    const { dataset, style } = element as HTMLElement;
    style.left = `${Number(dataset.time) * pixelsPerSecond}px`;
  }
}

function item({ key, index, width }: PlacedKey, count: number, chosen: boolean, tabStop: boolean): VNode {
  return (
    <div
      key={key.id}
      role="listitem"
      class="key-item"
      aria-posinset={index + 1}
      aria-setsize={count}
      data-time={key.time}
      style={{ width: `${width}px`, marginLeft: `${-width / 2}px` }}
    >
      <KeyButton pose={key} width={width} chosen={chosen} tabStop={tabStop} />
    </div>
  );
}

/** What shows while something is dragged: where a pose lands, what is being selected, where the dragged key pose is. */
function Marks() {
  const { state } = useStore();
  const landing = dropTime.value;
  const chosen = band.value;
  const hint = dragHint.value;
  if (landing === null && !chosen && !hint) return null;
  const view = state.view.value;
  const at = landing ?? hint?.time ?? 0;
  const place = barAndBeat(state.grid.value, at);
  return (
    <>
      {landing !== null && <div class="landing" style={{ transform: `translateX(${timeToX(view, landing)}px)` }} />}
      {chosen && (
        <div
          class="key-band"
          style={{
            transform: `translateX(${timeToX(view, chosen.start)}px)`,
            width: `${(chosen.end - chosen.start) * view.pixelsPerSecond}px`,
          }}
        />
      )}
      {(landing !== null || hint) && (
        <div class="drag-hint" style={{ transform: `translateX(${timeToX(view, at)}px)` }}>
          <span>
            {hint?.copy && <b>+ </b>}
            {place ? `${place.bar}.${place.beat}` : clockTime(at)}
            <small> {at.toFixed(2)} s</small>
          </span>
        </div>
      )}
    </>
  );
}
