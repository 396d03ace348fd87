import { useComputed, useSignalEffect } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { barAndBeat, clockTime, stepBeat } from '../../app/snapping';
import spec from '../../core/spec.json';
import { capturePointer } from '../pointer';
import { useStore } from '../store-context';
import { timeToX } from './geometry';
import { timeAtX } from './surface';

const FRAME = 1 / spec.fps;

/** Where the song is: a line, and a slider for the keyboard. */
export function Playhead() {
  const store = useStore();
  const { state } = store;
  const line = useRef<HTMLDivElement>(null);

  // Straight to the element: a render per frame would be waste.
  useSignalEffect(() => {
    const x = timeToX(state.view.value, state.time.value);
    const element = line.current;
    if (!element) return;
    element.style.transform = `translateX(${x}px)`;
    // Out of sight it must still take the keyboard, so it is never hidden from it.
    element.style.opacity = x < -8 || x > state.viewWidth.value + 8 ? '0' : '1';
  });
  const tenth = useComputed(() => Math.floor(state.time.value * 10) / 10);
  const place = useComputed(() => {
    const at = barAndBeat(state.grid.value, tenth.value);
    return `${clockTime(tenth.value)}${at ? `, bar ${at.bar} beat ${at.beat}` : ''}`;
  });

  const onKeyDown = (event: KeyboardEvent) => {
    const grid = state.grid.value;
    const now = state.time.value;
    const step = (direction: -1 | 1) => (event.shiftKey ? now + direction * FRAME : stepBeat(grid, now, direction));
    const bar = (60 / (grid?.tempo ?? 120)) * (grid?.beatsPerBar ?? 4);
    const targets: Record<string, () => number> = {
      ArrowLeft: () => step(-1),
      ArrowDown: () => step(-1),
      ArrowRight: () => step(1),
      ArrowUp: () => step(1),
      PageDown: () => now + bar,
      PageUp: () => now - bar,
      Home: () => 0,
      End: () => state.duration.value,
    };
    const target = targets[event.key];
    // With Alt, Ctrl or Cmd an arrow is a key of the table.
    if (!target || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    store.seek(target());
  };

  const onPointerDown = (event: PointerEvent) => {
    if (event.button !== 0) return;
    event.stopPropagation();
    capturePointer(event, (next) => store.seek(timeAtX(store, next.clientX)));
  };

  return (
    <div class="playhead" ref={line}>
      <div
        class="playhead-grip"
        data-grab
        role="slider"
        tabIndex={0}
        aria-label="Playhead"
        aria-orientation="horizontal"
        aria-valuemin={0}
        aria-valuemax={Math.round(state.duration.value * 10) / 10}
        aria-valuenow={tenth.value}
        aria-valuetext={place.value}
        title="Playhead: arrows move by a beat, with Shift by a frame"
        onFocus={(event) => {
          if (event.currentTarget.matches(':focus-visible')) store.revealTime(state.time.value);
        }}
        onKeyDown={onKeyDown}
        onPointerDown={onPointerDown}
      />
    </div>
  );
}
