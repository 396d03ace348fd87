/** Selecting key poses by dragging over them in their lane. */
import type { Store } from '../../app/store';
import { scrollAtEdge } from './key-drag';
import { band } from './lane-signals';
import { timeAtX } from './surface';

const THRESHOLD = 4;

/** Press between key poses: select none; move: select what is dragged over, with Shift, Ctrl or Cmd besides; Escape: as before. */
export function beginBand(event: PointerEvent, store: Store): void {
  const { pointerId, clientX: startX } = event;
  const start = timeAtX(store, startX);
  const before = store.state.selection.value;
  const beside = event.shiftKey || event.ctrlKey || event.metaKey ? before : new Set<string>();
  let moved = false;
  if (beside.size === 0) store.selectKey(null);

  const move = (next: PointerEvent) => {
    if (next.pointerId !== pointerId) return;
    if (!moved && Math.abs(next.clientX - startX) < THRESHOLD) return;
    moved = true;
    scrollAtEdge(store, next.clientX);
    const now = timeAtX(store, next.clientX);
    band.value = { start: Math.min(start, now), end: Math.max(start, now) };
    store.selectBetween(start, now, beside);
  };
  const up = (next: PointerEvent) => {
    if (next.pointerId === pointerId) stop();
  };
  const escape = (next: KeyboardEvent) => {
    if (next.key !== 'Escape') return;
    next.preventDefault();
    next.stopPropagation();
    stop();
    store.selectOnly(before);
  };
  const stop = () => {
    band.value = null;
    window.removeEventListener('pointermove', move);
    window.removeEventListener('pointerup', up);
    window.removeEventListener('pointercancel', up);
    window.removeEventListener('keydown', escape, true);
  };
  window.addEventListener('pointermove', move);
  window.addEventListener('pointerup', up);
  window.addEventListener('pointercancel', up);
  window.addEventListener('keydown', escape, true);
}
