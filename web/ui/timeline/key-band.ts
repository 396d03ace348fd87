/** Selecting key poses by dragging over them in their lane. */
import type { Store } from '../../app/store';
import { followPointer } from '../pointer';
import { scrollAtEdge } from './key-drag';
import { band } from './lane-signals';
import { timeAtX } from './surface';

const THRESHOLD = 4;

/** Press between key poses: select none; move: select what is dragged over, with Shift, Ctrl or Cmd besides; Escape: as before. */
export function beginBand(event: PointerEvent, store: Store): void {
  const { clientX: startX } = event;
  const start = timeAtX(store, startX);
  const before = store.state.selection.value;
  const beside = event.shiftKey || event.ctrlKey || event.metaKey ? before : new Set<string>();
  let moved = false;
  if (beside.size === 0) store.selectKey(null);

  const move = (next: PointerEvent) => {
    if (!moved && Math.abs(next.clientX - startX) < THRESHOLD) return;
    moved = true;
    scrollAtEdge(store, next.clientX);
    const now = timeAtX(store, next.clientX);
    band.value = { start: Math.min(start, now), end: Math.max(start, now) };
    store.selectBetween(start, now, beside);
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
    letGo();
  };
  const letGo = followPointer(event, { move, end: stop, key: escape });
}
