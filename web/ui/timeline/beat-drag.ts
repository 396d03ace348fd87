/** Dragging one beat along the timeline. */
import type { Store } from '../../app/store';
import { followPointer } from '../pointer';

const DRAG_THRESHOLD = { mouse: 3, touch: 8 };

/** Press on a beat: go there; move: drag it, with Shift all later ones too; Escape: never happened. */
export function beginBeatDrag(event: PointerEvent, index: number, store: Store): void {
  if (event.button !== 0) return;
  event.stopPropagation();
  const { state } = store;
  const origin = state.grid.value?.beats[index];
  if (origin === undefined) return;
  const { clientX: startX } = event;
  const startView = state.view.value.start;
  const threshold = event.pointerType === 'touch' ? DRAG_THRESHOLD.touch : DRAG_THRESHOLD.mouse;
  let dragging = false;

  const move = (next: PointerEvent) => {
    if (!dragging) {
      if (Math.abs(next.clientX - startX) < threshold) return;
      if (!store.beginBeatDrag(index)) {
        stop();
        return;
      }
      dragging = true;
    }
    const { start, pixelsPerSecond } = state.view.value;
    store.previewBeatDrag(origin + (next.clientX - startX) / pixelsPerSecond + start - startView, next.shiftKey);
  };
  const end = (next: PointerEvent) => {
    stop();
    if (!dragging) {
      if (next.type === 'pointerup') store.seek(origin);
    } else if (next.type === 'pointerup') store.commitBeatDrag();
    else store.discardBeatDrag();
  };
  const escape = (next: KeyboardEvent) => {
    if (next.key !== 'Escape' || !dragging) return;
    next.preventDefault();
    stop();
    store.discardBeatDrag();
  };
  const stop = followPointer(event, { move, end, key: escape });
}
