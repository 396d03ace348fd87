/** Dragging a pose from the library onto the timeline, by mouse or touch. */
import type { Store } from '../app/store';
import type { LibraryPose } from '../core/types';
import { followPointer } from './pointer';
import { LANES } from './timeline/geometry';
import { dropTime, pointOfTime, timeAtPoint } from './timeline/surface';

const MOUSE_THRESHOLD = 5;
/** A finger that rests this long drags instead of scrolling, milliseconds. */
const LONG_PRESS = 220;
const TOUCH_SLOP = 10;
const FLIGHT = 260;

const calm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

/**
 * What can be dragged listens for `touchmove` with this from the start: WebKit does not ask listeners that come during a touch.
 * A finger that drags does not scroll.
 */
export function holdScroll(event: TouchEvent & { currentTarget: HTMLElement }): void {
  if (event.currentTarget.dataset.dragged && event.cancelable) event.preventDefault();
}

/**
 * Begins when the pointer has moved (mouse) or rested (touch); Escape or a drop elsewhere adds nothing.
 * @param drop what to do with the pose at a time; by default it becomes a key pose
 */
export function startPoseDrag(
  event: PointerEvent,
  pose: Pick<LibraryPose, 'name' | 'rotations'>,
  store: Store,
  drop = (time: number): void => void store.addKey(pose.rotations, time, { name: pose.name, exact: true }),
): void {
  if (event.button !== 0) return;
  const tile = event.currentTarget as HTMLElement;
  delete tile.dataset.dragged;
  const { clientX: startX, clientY: startY } = event;
  const touch = event.pointerType === 'touch';
  let ghost: HTMLElement | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;

  const lift = (x: number, y: number) => {
    ghost = makeGhost(tile);
    tile.dataset.dragged = 'yes';
    place(x, y, false);
    if (touch) navigator.vibrate?.(10);
  };
  const place = (x: number, y: number, exact: boolean) => {
    if (!ghost) return;
    // Under a finger the ghost would be hidden: it is held above.
    ghost.style.transform = `translate(${x}px, ${y - (touch ? 56 : 0)}px) translate(-50%, -50%)`;
    dropTime.value = timeAtPoint(store, x, y, exact);
    ghost.classList.toggle('over', dropTime.value !== null);
  };
  const move = (next: PointerEvent) => {
    const distance = Math.hypot(next.clientX - startX, next.clientY - startY);
    if (!ghost) {
      // On a busy page a move comes before the timer that was due first: the finger's own clock decides.
      if (touch && next.timeStamp - event.timeStamp >= LONG_PRESS) lift(next.clientX, next.clientY);
      else if (touch && distance > TOUCH_SLOP) stop();
      else if (!touch && distance > MOUSE_THRESHOLD) lift(next.clientX, next.clientY);
      return;
    }
    place(next.clientX, next.clientY, next.altKey);
  };
  const up = (next: PointerEvent) => {
    // Alt counts as it is when the pose is let go.
    if (next.type === 'pointerup') place(next.clientX, next.clientY, next.altKey);
    const time = dropTime.value;
    const dropped = ghost !== null && time !== null && next.type === 'pointerup';
    stop();
    if (dropped) drop(time);
  };
  const escape = (next: KeyboardEvent) => {
    if (next.key !== 'Escape' || !ghost) return;
    next.preventDefault();
    stop();
  };
  const stop = () => {
    clearTimeout(timer);
    ghost?.remove();
    ghost = null;
    dropTime.value = null;
    // The click that follows a drag must not add the pose again.
    setTimeout(() => delete tile.dataset.dragged, 0);
    letGo();
  };
  if (touch) timer = setTimeout(() => lift(startX, startY), LONG_PRESS);
  const letGo = followPointer(event, { move, end: up, key: escape });
}

function makeGhost(tile: HTMLElement): HTMLElement {
  const ghost = document.createElement('div');
  ghost.className = 'pose-ghost';
  const picture = tile.querySelector('.pose-picture')?.cloneNode(true);
  if (picture) ghost.append(picture);
  document.body.append(ghost);
  return ghost;
}

/** Shows where a pose went that was added without dragging: it flies to its beat. */
export function flyToLane(store: Store, tile: HTMLElement, id: string): void {
  const key = store.state.document.value.keyPoses.find((each) => each.id === id);
  if (!key || calm()) return;
  const to = pointOfTime(store, key.time, LANES.keys.top + LANES.keys.height / 2);
  if (!to || to.x < 0 || to.x > innerWidth) return;
  const from = tile.getBoundingClientRect();
  const ghost = makeGhost(tile);
  const at = (x: number, y: number, scale: number) => `translate(${x}px, ${y}px) translate(-50%, -50%) scale(${scale})`;
  ghost
    .animate(
      [
        { transform: at(from.left + from.width / 2, from.top + from.height / 2, 1), opacity: 1 },
        { transform: at(to.x, to.y, 0.8), opacity: 0.4 },
      ],
      { duration: FLIGHT, easing: 'cubic-bezier(.3,.7,.2,1)' },
    )
    .finished.finally(() => ghost.remove());
}
