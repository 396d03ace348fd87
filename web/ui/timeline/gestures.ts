/** Mouse, wheel and touch on the timeline's surface. */
import type { Store } from '../../app/store';
import { nearestBeat } from '../../app/snapping';
import { LANES } from './geometry';
import { timeAtX } from './surface';

/** Movement that makes a drag of a press, CSS pixels. */
const DRAG_THRESHOLD = 4;
/** Wheel units that double the scale. */
const WHEEL_PER_DOUBLING = 240;

/** A press on the music or on the curves goes there; one between key poses does not. */
const seeks = (y: number) => y < LANES.keys.top || y >= LANES.curves.top;

/** Binds seeking, loop ranges, panning and zooming. Returns the way to stop that. */
export function bindGestures(element: HTMLElement, store: Store): () => void {
  const touches = new Map<number, { x: number; y: number }>();
  let press: { x: number; y: number; lane: 'ruler' | 'body'; moved: boolean; id: number; touch: boolean } | null = null;
  let wasPlaying = false;

  const onDown = (event: PointerEvent) => {
    if (event.button !== 0 || (event.target as HTMLElement).closest('[data-grab]')) return;
    const touch = event.pointerType === 'touch';
    if (touch) touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const y = event.clientY - element.getBoundingClientRect().top;
    const lane = y < LANES.ruler.top + LANES.ruler.height ? 'ruler' : 'body';
    press = { x: event.clientX, y: event.clientY, lane, moved: false, id: event.pointerId, touch };
    element.setPointerCapture(event.pointerId);
    if (!touch && lane === 'body') {
      if (seeks(y)) {
        wasPlaying = store.state.playing.value;
        store.seek(timeAtX(store, event.clientX));
      } else {
        store.selectKey(null);
      }
    }
  };

  const onMove = (event: PointerEvent) => {
    const before = touches.get(event.pointerId);
    if (before && touches.size === 2) {
      const other = [...touches].find(([id]) => id !== event.pointerId)![1];
      const apart = Math.max(24, Math.abs(event.clientX - other.x));
      const wasApart = Math.max(24, Math.abs(before.x - other.x));
      store.zoomAt(apart / wasApart, timeAtX(store, (event.clientX + other.x) / 2));
      touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (press) press.moved = true;
      return;
    }
    if (!press || press.id !== event.pointerId) return;
    if (!press.moved && Math.hypot(event.clientX - press.x, event.clientY - press.y) < DRAG_THRESHOLD) return;
    press.moved = true;
    if (press.touch && press.lane === 'body') {
      store.scrollBy((before?.x ?? event.clientX) - event.clientX);
      touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    } else if (press.lane === 'ruler') {
      const grid = event.altKey ? null : store.state.grid.value;
      const [a, b] = [press.x, event.clientX].map((x) => nearestBeat(grid, timeAtX(store, x)));
      store.setLoop({ start: Math.min(a, b), end: Math.max(a, b) });
    } else if (seeks(press.y - element.getBoundingClientRect().top)) {
      store.seek(timeAtX(store, event.clientX));
    }
  };

  const onUp = (event: PointerEvent) => {
    touches.delete(event.pointerId);
    if (!press || press.id !== event.pointerId) return;
    const { moved, lane, touch } = press;
    press = null;
    if (event.type === 'pointercancel') return;
    if (!moved && (lane === 'ruler' || touch)) store.seek(timeAtX(store, event.clientX));
    if (wasPlaying && !store.state.playing.value) store.togglePlay();
    wasPlaying = false;
  };

  const onWheel = (event: WheelEvent) => {
    event.preventDefault();
    if (event.ctrlKey || event.metaKey) {
      store.zoomAt(2 ** (-event.deltaY / WHEEL_PER_DOUBLING), timeAtX(store, event.clientX));
    } else {
      store.scrollBy(Math.abs(event.deltaX) > Math.abs(event.deltaY) ? event.deltaX : event.deltaY);
    }
  };

  element.addEventListener('pointerdown', onDown);
  element.addEventListener('pointermove', onMove);
  element.addEventListener('pointerup', onUp);
  element.addEventListener('pointercancel', onUp);
  element.addEventListener('wheel', onWheel, { passive: false });
  return () => {
    element.removeEventListener('pointerdown', onDown);
    element.removeEventListener('pointermove', onMove);
    element.removeEventListener('pointerup', onUp);
    element.removeEventListener('pointercancel', onUp);
    element.removeEventListener('wheel', onWheel);
  };
}
