/** Dragging an inner knot of a curve up and down. */
import type { Store } from '../../app/store';
import { findEdit, NO_EDITS } from '../../core/curves-edit';
import { knotsMovedTo } from '../../core/curves-view';
import { followPointer } from '../pointer';
import { heldScale, perPixel, scaleOf, type ShownCurves } from './curve-space';

const DRAG_THRESHOLD = { mouse: 2, touch: 6 };
/** With Shift a drag goes this much slower. */
const FINE = 0.2;

/** An inner knot on one of the three curves. */
export interface KnotPlace {
  interval: number;
  /** 0 or 1. */
  n: number;
  axis: number;
}

/** The knots of the edit that brings a knot to a value, degrees or centimetres. */
export function knotsAt(store: Store, curves: ShownCurves, { interval, n, axis }: KnotPlace, value: number) {
  const { base, shown, track, picture } = curves;
  const edit = findEdit(store.state.document.value.curveEdits ?? NO_EDITS, shown, interval, track);
  return knotsMovedTo(base, picture, edit, { interval, n, track }, axis, value);
}

/** Press on a knot: the figure goes there; move: drag it, with Shift finely; Escape or a second finger: never happened. */
export function beginKnotDrag(event: PointerEvent, store: Store, curves: ShownCurves, place: KnotPlace): void {
  if (event.button !== 0) return;
  event.stopPropagation();
  const { clientY: startY } = event;
  const { picture, track } = curves;
  const { interval, n, axis } = place;
  const knot = interval * 3 + 1 + n;
  const threshold = event.pointerType === 'touch' ? DRAG_THRESHOLD.touch : DRAG_THRESHOLD.mouse;
  const origin = picture.knotValues[knot * 3 + axis];
  let value = origin;
  let last = startY;
  let dragging = false;
  if (store.state.playing.value) store.togglePlay();
  store.seek(picture.knots[knot]);

  const move = (next: PointerEvent) => {
    if (!dragging) {
      if (Math.abs(next.clientY - startY) < threshold) return;
      dragging = true;
      heldScale.value = { lowest: picture.lowest, highest: picture.highest };
      store.beginCurveDrag();
    }
    value -= (next.clientY - last) * perPixel(scaleOf(picture)) * (next.shiftKey ? FINE : 1);
    last = next.clientY;
    // Always from where the drag began: what is seen of a turn past 180 degrees may be another one of the same.
    store.previewCurve(interval, track, { knots: knotsAt(store, curves, place, value) });
  };
  const end = (next: PointerEvent) => {
    stop();
    if (dragging && next.type === 'pointerup') store.commitCurveDrag('Move curve knot');
    else if (dragging) store.discardCurveDrag();
  };
  const cancel = () => {
    stop();
    if (dragging) store.discardCurveDrag();
  };
  const escape = (next: KeyboardEvent) => {
    if (next.key !== 'Escape') return;
    next.preventDefault();
    next.stopPropagation();
    cancel();
  };
  const stop = () => {
    heldScale.value = null;
    letGo();
  };
  const letGo = followPointer(event, { move, end, key: escape, secondFinger: cancel });
}
