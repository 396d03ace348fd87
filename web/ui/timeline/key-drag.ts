/** Dragging key poses along the timeline. */
import type { Store } from '../../app/store';
import { followPointer } from '../pointer';
import { dragHint } from './lane-signals';
import { surface } from './surface';

const DRAG_THRESHOLD = { mouse: 4, touch: 8 };
/** A finger that rests this long adds to the selection, or takes out of it, milliseconds. */
const LONG_PRESS = 450;
/** Near the edge the view scrolls, pixels per move. */
const EDGE = 28;
const EDGE_STEP = 10;

/** The key pose that a pointer is on, while it is. */
export const pressedKey: { current: string | null } = { current: null };

/** Near an edge of the timeline the view goes on under a drag. */
export function scrollAtEdge(store: Store, clientX: number): void {
  const box = surface.value?.getBoundingClientRect();
  if (box && clientX < box.left + EDGE) store.scrollBy(-EDGE_STEP);
  if (box && clientX > box.right - EDGE) store.scrollBy(EDGE_STEP);
}

/**
 * Press on a key pose: select (with Ctrl or Cmd one more, with Shift up to it); move: drag all selected, with Ctrl or Cmd copies of
 * them, with Alt off the grid; Escape or a second finger: never happened.
 */
export function beginKeyDrag(event: PointerEvent, id: string, store: Store): void {
  if (event.button !== 0) return;
  event.stopPropagation();
  const { clientX: startX, clientY: startY } = event;
  const touch = event.pointerType === 'touch';
  const toggle = event.ctrlKey || event.metaKey;
  const already = store.state.selection.value.has(id);
  pressedKey.current = id;
  if (event.shiftKey) store.selectTo(id);
  else if (toggle && !already) store.selectKey(id, true);
  else if (!toggle && !already && !touch) store.selectKey(id);
  const startView = store.state.view.value.start;
  let dragging = false;
  let held = false;
  let at = startX;

  const preview = (modifiers: { altKey: boolean; ctrlKey: boolean; metaKey: boolean }) => {
    const { start, pixelsPerSecond } = store.state.view.value;
    const copy = modifiers.ctrlKey || modifiers.metaKey;
    const seconds = (at - startX) / pixelsPerSecond + start - startView;
    const time = store.previewMove(seconds, id, modifiers.altKey, copy);
    dragHint.value = time === null ? null : { time, copy };
  };
  const move = (next: PointerEvent) => {
    at = next.clientX;
    if (!dragging) {
      const far = touch ? Math.hypot(at - startX, next.clientY - startY) : Math.abs(at - startX);
      if (far < (touch ? DRAG_THRESHOLD.touch : DRAG_THRESHOLD.mouse)) return;
      clearTimeout(timer);
      dragging = true;
      if (!store.state.selection.value.has(id)) store.selectKey(id);
      store.beginMove();
    }
    scrollAtEdge(store, at);
    preview(next);
  };
  const end = (next: PointerEvent) => {
    stop();
    if (dragging && next.type === 'pointerup') store.commitMove();
    else if (dragging) store.discardMove();
    else if (next.type !== 'pointerup' || held || event.shiftKey) return;
    else if (toggle && already) store.selectKey(id, true);
    else if (!toggle) store.selectKey(id);
  };
  const cancel = () => {
    stop();
    if (dragging) store.discardMove();
  };
  const key = (next: KeyboardEvent) => {
    if (!dragging) return;
    if (next.type === 'keydown' && next.key === 'Escape') {
      next.preventDefault();
      next.stopPropagation();
      cancel();
    } else if (['Alt', 'Control', 'Meta'].includes(next.key)) {
      next.preventDefault();
      preview(next);
    }
  };
  const stop = () => {
    clearTimeout(timer);
    dragHint.value = null;
    letGo();
    // The focus that a tap brings comes after it.
    setTimeout(() => (pressedKey.current = pressedKey.current === id ? null : pressedKey.current), 0);
  };
  const timer = touch
    ? setTimeout(() => {
        held = true;
        store.selectKey(id, true);
        navigator.vibrate?.(10);
      }, LONG_PRESS)
    : undefined;
  const letGo = followPointer(event, { move, end, key, keyUp: key, ...(touch ? { secondFinger: cancel } : {}) });
}
