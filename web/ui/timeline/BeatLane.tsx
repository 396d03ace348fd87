import { signal, useComputed, useSignalEffect } from '@preact/signals';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { NUDGE } from '../../app/actions/beats';
import { useStore } from '../store-context';
import { beginBeatDrag } from './beat-drag';
import { tickName, visibleTicks, type Tick } from './beat-ticks';
import { LANES } from './geometry';

/** Ticks are made anew only when the view has moved on by this much, CSS pixels; between, the layer slides. */
const CHUNK = 512;

/** The beat that has the keyboard (its index), or -1. */
const focused = signal(-1);

/** The beats of the song in their lane, to be dragged. */
export function BeatLane() {
  const store = useStore();
  const { state } = store;
  const layer = useRef<HTMLDivElement>(null);
  const scale = useComputed(() => state.view.value.pixelsPerSecond);
  const chunk = useComputed(() => Math.floor((state.view.value.start * scale.value) / CHUNK));

  // Straight to the element: a render per frame would be waste.
  useSignalEffect(() => {
    const { start, pixelsPerSecond } = state.view.value;
    if (layer.current) layer.current.style.transform = `translateX(${-start * pixelsPerSecond}px)`;
  });
  useLayoutEffect(() => {
    // A beat that was gone to may only now be there.
    if (focused.value < 0 || document.activeElement !== document.body) return;
    layer.current?.querySelector<HTMLElement>(`[data-beat="${focused.value}"]`)?.focus({ preventScroll: true });
  });

  const grid = state.grid.value;
  const first = (chunk.value * CHUNK) / scale.value;
  const last = ((chunk.value + 1) * CHUNK + state.viewWidth.value) / scale.value;
  const ticks = grid ? visibleTicks(grid, scale.value, first, last, focused.value) : [];
  // The one in the middle is in sight for sure.
  const tabbable = ticks.some(({ index }) => index === focused.value) ? focused.value : ticks[ticks.length >> 1]?.index;
  const taps = state.tapping.value?.times ?? [];

  return (
    <div
      class="beat-lane"
      role="group"
      aria-label={`Beats, ${grid?.beats.length ?? 0}`}
      style={{ top: `${LANES.beats.top}px`, height: `${LANES.beats.height}px` }}
    >
      <div class="beat-layer" ref={layer}>
        {ticks.map((tick) => (
          <BeatTick key={tick.index} tick={tick} x={tick.time * scale.value} tabbable={tick.index === tabbable} />
        ))}
        {taps.map((time, i) => (
          <span key={i} class="tap-mark" style={{ left: `${time * scale.value}px` }} />
        ))}
      </div>
    </div>
  );
}

function BeatTick({ tick, x, tabbable }: { tick: Tick; x: number; tabbable: boolean }) {
  const store = useStore();
  const { state } = store;
  const { index, time, bar } = tick;
  const grid = state.grid.value!;

  /** Moves the keyboard to another beat. */
  const go = (to: number) => {
    const target = Math.min(Math.max(to, 0), grid.beats.length - 1);
    store.revealTime(grid.beats[target]);
    focused.value = target;
    document.querySelector<HTMLElement>(`[data-beat="${target}"]`)?.focus({ preventScroll: true });
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.altKey) return;
    const step = event.shiftKey ? NUDGE.frame : NUDGE.fine;
    const rest = event.ctrlKey || event.metaKey;
    const act: Record<string, () => void> = {
      ArrowLeft: () => store.nudgeBeat(index, -step, rest),
      ArrowRight: () => store.nudgeBeat(index, step, rest),
      ...(rest
        ? {}
        : {
            ArrowUp: () => go(index - 1),
            ArrowDown: () => go(index + 1),
            PageUp: () => go(index - grid.beatsPerBar),
            PageDown: () => go(index + grid.beatsPerBar),
            Home: () => go(0),
            End: () => go(grid.beats.length - 1),
            Delete: () => store.deleteBeat(index),
            Backspace: () => store.deleteBeat(index),
            b: () => store.setBarOne(index),
            B: () => store.setBarOne(index),
          }),
    };
    const run = act[event.key];
    if (!run) return;
    event.preventDefault();
    event.stopPropagation();
    run();
  };

  const name = tickName(grid, time);
  return (
    <button
      type="button"
      class={`beat-tick ${bar ? 'bar' : ''}`}
      data-grab
      data-beat={index}
      tabIndex={tabbable ? 0 : -1}
      aria-label={name}
      aria-keyshortcuts="ArrowLeft ArrowRight ArrowUp ArrowDown Delete B"
      title={`${name}. Drag it, with Shift all later beats too; arrows move it by 10 ms; B: bar 1 here; Delete removes it.`}
      style={{ left: `${x}px` }}
      onPointerDown={(event) => beginBeatDrag(event, index, store)}
      onClick={(event) => {
        if (event.detail === 0) store.seek(time);
      }}
      onKeyDown={onKeyDown}
      onFocus={(event) => {
        focused.value = index;
        if (event.currentTarget.matches(':focus-visible')) store.revealTime(time);
      }}
      onBlur={() =>
        queueMicrotask(() => {
          if (focused.value === index && document.activeElement !== document.body) focused.value = -1;
        })
      }
    />
  );
}
