/** Dragging key poses along the timeline. */
import type { Store } from '../../app/store';
import { surface } from './surface';

const DRAG_THRESHOLD = { mouse: 4, touch: 8 };
/** Near the edge the view scrolls, pixels per move. */
const EDGE = 28;
const EDGE_STEP = 10;

/** Press on a key pose: select; move: drag all selected; Escape: never happened. */
export function beginKeyDrag(event: PointerEvent, id: string, store: Store): void {
  if (event.button !== 0) return;
  event.stopPropagation();
  const extend = event.shiftKey || event.ctrlKey || event.metaKey;
  const already = store.state.selection.value.has(id);
  if (extend) store.selectKey(id, true);
  else if (!already) store.selectKey(id);
  const startX = event.clientX;
  const startView = store.state.view.value.start;
  const threshold = event.pointerType === 'touch' ? DRAG_THRESHOLD.touch : DRAG_THRESHOLD.mouse;
  const { pointerId } = event;
  let dragging = false;

  const move = (next: PointerEvent) => {
    if (next.pointerId !== pointerId) return;
    if (!dragging) {
      if (Math.abs(next.clientX - startX) < threshold) return;
      dragging = true;
      if (!store.state.selection.value.has(id)) store.selectKey(id);
      store.beginMove();
    }
    const box = surface.value?.getBoundingClientRect();
    if (box && next.clientX < box.left + EDGE) store.scrollBy(-EDGE_STEP);
    if (box && next.clientX > box.right - EDGE) store.scrollBy(EDGE_STEP);
    const { start, pixelsPerSecond } = store.state.view.value;
    store.previewMove((next.clientX - startX) / pixelsPerSecond + start - startView, id, next.altKey);
  };
  const end = (next: PointerEvent) => {
    if (next.pointerId !== pointerId) return;
    stop();
    if (!dragging) {
      if (already && !extend) store.selectKey(id);
    } else if (next.type === 'pointerup') store.commitMove();
    else store.discardMove();
  };
  const escape = (next: KeyboardEvent) => {
    if (next.key !== 'Escape' || !dragging) return;
    next.preventDefault();
    stop();
    store.discardMove();
  };
  const stop = () => {
    window.removeEventListener('pointermove', move);
    window.removeEventListener('pointerup', end);
    window.removeEventListener('pointercancel', end);
    window.removeEventListener('keydown', escape, true);
  };
  // On the window, not the button: the list may reorder under the pointer, which would end a capture.
  window.addEventListener('pointermove', move);
  window.addEventListener('pointerup', end);
  window.addEventListener('pointercancel', end);
  window.addEventListener('keydown', escape, true);
}
