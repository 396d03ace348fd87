import { signal } from '@preact/signals';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { barAndBeat } from '../../app/snapping';
import type { KeyPose } from '../../core/types';
import { useStore } from '../store-context';
import { PosePicture } from '../thumbs';
import { COMPACT_WIDTH, KEY_WIDTH, LANES, placeKeys, timeToX } from './geometry';
import { beginKeyDrag } from './key-drag';
import { dropTime } from './surface';

/** The key pose that has the keyboard, so that it stays drawn and focused when it moves past others. */
const focused = signal<string | null>(null);

/** Key poses as a list of buttons, placed on their times. */
export function KeyLane() {
  const store = useStore();
  const { state } = store;
  const keys = state.document.value.keyPoses;
  const list = useRef<HTMLDivElement>(null);
  const keep = new Set(focused.value ? [focused.value] : []);
  const placed = placeKeys(keys, state.view.value, state.viewWidth.value, keep);
  const landing = dropTime.value;

  useLayoutEffect(() => {
    // Moving an element in the list takes its focus away: give it back.
    const id = focused.value;
    if (!id || document.activeElement !== document.body) return;
    list.current?.querySelector<HTMLElement>(`[data-key="${CSS.escape(id)}"]`)?.focus({ preventScroll: true });
  });

  return (
    <div
      class="key-lane"
      role="list"
      aria-label={`Key poses, ${keys.length}`}
      ref={list}
      style={{ top: `${LANES.keys.top}px`, height: `${LANES.keys.height}px` }}
    >
      {keys.length === 0 && landing === null && state.duration.value > 0 && (
        <p class="lane-hint">Drag a pose here, or choose one in the list: it lands on a beat.</p>
      )}
      {placed.map(({ key, x, compact }) => (
        <KeyButton key={key.id} pose={key} x={x} compact={compact} />
      ))}
      {landing !== null && (
        <div class="landing" style={{ transform: `translateX(${timeToX(state.view.value, landing)}px)` }} />
      )}
    </div>
  );
}

function KeyButton({ pose, x, compact }: { pose: KeyPose; x: number; compact: boolean }) {
  const store = useStore();
  const { state } = store;
  const chosen = state.selection.value.has(pose.id);
  const place = barAndBeat(state.grid.value, pose.time);
  const name = pose.name ?? 'Key pose';
  const where = `${place ? `bar ${place.bar} beat ${place.beat}, ` : ''}${pose.time.toFixed(2)} s`;
  const width = compact ? COMPACT_WIDTH : KEY_WIDTH;

  const onKeyDown = (event: KeyboardEvent) => {
    const act: Record<string, () => void> = {
      ArrowLeft: () => store.nudgeKeys(-1, event.shiftKey ? 'frame' : 'beat'),
      ArrowRight: () => store.nudgeKeys(1, event.shiftKey ? 'frame' : 'beat'),
      Delete: () => store.deleteKeys(),
      Backspace: () => store.deleteKeys(),
    };
    if (event.key === 'Enter' && event.shiftKey) act.Enter = () => store.deleteKeys();
    else if (event.key === 'Enter') act.Enter = () => store.editKey(pose.id);
    const run = act[event.key];
    if (!run) return;
    event.preventDefault();
    event.stopPropagation();
    if (!chosen) store.selectKey(pose.id);
    run();
  };

  return (
    <div role="listitem" class="key-item" style={{ transform: `translateX(${x - width / 2}px)` }}>
      <button
        type="button"
        class={`key-pose ${chosen ? 'chosen' : ''} ${compact ? 'compact' : ''}`}
        data-grab
        data-key={pose.id}
        aria-pressed={chosen}
        aria-label={`${name}, ${where}`}
        title={`${name}, ${where}. Arrows move it, Enter edits it, Delete deletes it.`}
        style={{ width: `${width}px` }}
        onPointerDown={(event) => beginKeyDrag(event, pose.id, store)}
        onDblClick={() => store.editKey(pose.id)}
        onKeyDown={onKeyDown}
        onFocus={() => {
          focused.value = pose.id;
          if (!chosen) store.selectKey(pose.id);
        }}
        onBlur={() => {
          if (focused.value === pose.id && document.hasFocus()) queueMicrotask(() => releaseFocus(pose.id));
        }}
      >
        {compact ? <span class="diamond" /> : <PosePicture rotations={pose.rotations} />}
      </button>
    </div>
  );
}

/** Forgets the focused key pose once something else really has the focus. */
function releaseFocus(id: string): void {
  if (focused.value === id && document.activeElement !== document.body) focused.value = null;
}
