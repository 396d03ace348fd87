/** How a pressed pointer is followed until it is let go. */

/** What a drag does with what it hears. */
export interface DragEvents {
  move: (event: PointerEvent) => void;
  /** The pointer was let go (`pointerup`), or taken away (`pointercancel`). */
  end: (event: PointerEvent) => void;
  /** Keys pressed meanwhile, before anybody else hears of them. */
  key: (event: KeyboardEvent) => void;
  /** Keys let go meanwhile. */
  keyUp?: (event: KeyboardEvent) => void;
  /** Another finger comes down. */
  secondFinger?: () => void;
}

/**
 * Follows the pointer of a press wherever it goes. On the window, not the element: what is dragged may be drawn anew under the pointer,
 * which would end a capture.
 * @returns stops that; the end of the press does not by itself
 */
export function followPointer({ pointerId }: PointerEvent, events: DragEvents): () => void {
  const listening = new AbortController();
  const { signal } = listening;
  const own = (act: (event: PointerEvent) => void) => (event: PointerEvent) => {
    if (event.pointerId === pointerId) act(event);
  };
  const { move, end, key, keyUp, secondFinger } = events;
  window.addEventListener('pointermove', own(move), { signal });
  window.addEventListener('pointerup', own(end), { signal });
  window.addEventListener('pointercancel', own(end), { signal });
  window.addEventListener('keydown', key, { signal, capture: true });
  if (keyUp) window.addEventListener('keyup', keyUp, { signal, capture: true });
  if (secondFinger) {
    const other = (event: PointerEvent) => event.pointerId !== pointerId && secondFinger();
    window.addEventListener('pointerdown', other, { signal, capture: true });
  }
  return () => listening.abort();
}

/** Gives a pressed pointer to the element it was pressed on, and tells of its moves until it is let go. */
export function capturePointer(event: PointerEvent, move: (event: PointerEvent) => void): void {
  const element = event.currentTarget as HTMLElement;
  element.setPointerCapture(event.pointerId);
  element.addEventListener('pointermove', move);
  const stop = () => element.removeEventListener('pointermove', move);
  element.addEventListener('pointerup', stop, { once: true });
  element.addEventListener('pointercancel', stop, { once: true });
}
