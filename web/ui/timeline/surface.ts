/** Where the timeline is on the page, for drags that come from elsewhere. */
import { signal } from '@preact/signals';
import type { Store } from '../../app/store';
import { timeToX, xToTime } from './geometry';

/** The element whose left edge is the view's start. */
export const surface = signal<HTMLElement | null>(null);
/** Where a pose that is dragged in would land, seconds; null when it is not over the timeline. */
export const dropTime = signal<number | null>(null);

/** The time under a point of the page, snapped unless `exact`; null outside the timeline. */
export function timeAtPoint(store: Store, clientX: number, clientY: number, exact: boolean): number | null {
  const box = surface.value?.getBoundingClientRect();
  if (!box || clientX < box.left || clientX > box.right || clientY < box.top || clientY > box.bottom) return null;
  const { view, duration } = store.state;
  const time = xToTime(view.value, clientX - box.left);
  if (time < 0 || time > duration.value) return null;
  return store.snapTime(time, exact);
}

/** The time at a page coordinate, inside the song. */
export function timeAtX(store: Store, clientX: number): number {
  const left = surface.value?.getBoundingClientRect().left ?? 0;
  return Math.min(Math.max(xToTime(store.state.view.value, clientX - left), 0), store.state.duration.value);
}

/** Page position of a time in the key-pose lane. */
export function pointOfTime(store: Store, time: number, laneTop: number): { x: number; y: number } | null {
  const box = surface.value?.getBoundingClientRect();
  if (!box) return null;
  return { x: box.left + timeToX(store.state.view.value, time), y: box.top + laneTop };
}
