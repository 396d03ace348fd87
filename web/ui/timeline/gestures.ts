/** Mouse, wheel and touch on the timeline's surface. */
import type { Store } from '../../app/store';
import { beginBand } from './key-band';
import { LANES } from './geometry';
import { timeAtX } from './surface';

/** Movement that makes a drag of a press, CSS pixels. */
const DRAG_THRESHOLD = 4;
/** Wheel units that double the scale. */
const WHEEL_PER_DOUBLING = 240;
/** Pixels of a line and of a page, for wheels that count in those. */
const WHEEL_UNITS = [1, 16, 400];
/** A finger that rests this long between key poses selects instead of scrolling, milliseconds. */
const LONG_PRESS = 350;

type Lane = 'ruler' | 'keys' | 'music' | 'none';

const inLane = (y: number, { top, height }: { top: number; height: number }) => y >= top && y < top + height;

/** What a press at a height is about: the music and the curves are for going there. */
function laneAt(y: number): Lane {
  if (inLane(y, LANES.ruler)) return 'ruler';
  if (inLane(y, LANES.keys)) return 'keys';
  return inLane(y, LANES.ranges) ? 'none' : 'music';
}

/** Binds seeking, loop ranges, selecting, panning and zooming. Returns the way to stop that. */
export function bindGestures(element: HTMLElement, store: Store): () => void {
  const touches = new Map<number, { x: number; y: number }>();
  let press: { x: number; y: number; lane: Lane; moved: boolean; id: number; pans: boolean; touch: boolean } | null =
    null;
  let wasPlaying = false;
  let rest: ReturnType<typeof setTimeout> | undefined;

  /** Every finger counts for pinching, also one on a key pose. */
  const onTouch = (event: PointerEvent) => {
    if (event.pointerType === 'touch') touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
  };

  const onDown = (event: PointerEvent) => {
    const middle = event.button === 1;
    if ((event.button !== 0 && !middle) || (!middle && (event.target as HTMLElement).closest('[data-grab]'))) return;
    if (middle) event.preventDefault();
    const touch = event.pointerType === 'touch';
    const lane = laneAt(event.clientY - element.getBoundingClientRect().top);
    const pans = middle || (touch && lane !== 'ruler');
    press = { x: event.clientX, y: event.clientY, lane, moved: false, id: event.pointerId, pans, touch };
    element.setPointerCapture(event.pointerId);
    if (pans && lane === 'keys' && !middle) {
      rest = setTimeout(() => {
        if (!press || press.moved || touches.size > 1) return;
        press = null;
        navigator.vibrate?.(10);
        beginBand(event, store);
      }, LONG_PRESS);
    } else if (!pans && lane === 'keys') {
      press = null;
      beginBand(event, store);
    } else if (!pans && lane === 'music') {
      wasPlaying = store.state.playing.value;
      store.seek(timeAtX(store, event.clientX));
    }
  };

  const onMove = (event: PointerEvent) => {
    const before = touches.get(event.pointerId);
    if (before && touches.size === 2) {
      const other = [...touches].find(([id]) => id !== event.pointerId)![1];
      const apart = Math.max(24, Math.abs(event.clientX - other.x));
      const wasApart = Math.max(24, Math.abs(before.x - other.x));
      store.scrollBy((before.x - event.clientX) / 2);
      store.zoomAt(apart / wasApart, timeAtX(store, (event.clientX + other.x) / 2));
      touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (press) press.moved = true;
      return;
    }
    if (!press || press.id !== event.pointerId) return;
    if (!press.moved && Math.hypot(event.clientX - press.x, event.clientY - press.y) < DRAG_THRESHOLD) return;
    const from = press.moved ? (before?.x ?? event.clientX - event.movementX) : press.x;
    press.moved = true;
    clearTimeout(rest);
    if (press.pans) {
      store.scrollBy(from - event.clientX);
      if (before) touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    } else if (press.lane === 'ruler') {
      const [a, b] = [press.x, event.clientX].map((x) => store.snapTime(timeAtX(store, x), event.altKey));
      store.setLoop({ start: Math.min(a, b), end: Math.max(a, b) });
    } else if (press.lane === 'music') {
      store.seek(timeAtX(store, event.clientX));
    }
  };

  const onUp = (event: PointerEvent) => {
    clearTimeout(rest);
    touches.delete(event.pointerId);
    if (!press || press.id !== event.pointerId) return;
    const { moved, lane, touch } = press;
    press = null;
    if (event.type === 'pointercancel') return;
    if (!moved && touch && lane === 'keys') store.selectKey(null);
    else if (!moved && (lane === 'ruler' || (touch && lane === 'music'))) store.seek(timeAtX(store, event.clientX));
    if (wasPlaying && !store.state.playing.value) store.togglePlay();
    wasPlaying = false;
  };

  const onWheel = (event: WheelEvent) => {
    event.preventDefault();
    const unit = WHEEL_UNITS[event.deltaMode] ?? 1;
    if (event.ctrlKey || event.metaKey) {
      store.zoomAt(2 ** ((-event.deltaY * unit) / WHEEL_PER_DOUBLING), timeAtX(store, event.clientX));
    } else {
      store.scrollBy(unit * (Math.abs(event.deltaX) > Math.abs(event.deltaY) ? event.deltaX : event.deltaY));
    }
  };

  element.addEventListener('pointerdown', onTouch, true);
  element.addEventListener('pointerdown', onDown);
  element.addEventListener('pointermove', onMove);
  element.addEventListener('pointerup', onUp);
  element.addEventListener('pointercancel', onUp);
  element.addEventListener('wheel', onWheel, { passive: false });
  return () => {
    clearTimeout(rest);
    element.removeEventListener('pointerdown', onTouch, true);
    element.removeEventListener('pointerdown', onDown);
    element.removeEventListener('pointermove', onMove);
    element.removeEventListener('pointerup', onUp);
    element.removeEventListener('pointercancel', onUp);
    element.removeEventListener('wheel', onWheel);
  };
}
