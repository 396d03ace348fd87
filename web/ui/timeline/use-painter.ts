import { useSignalEffect, type ReadonlySignal } from '@preact/signals';
import type { RefObject } from 'preact';
import { useRef } from 'preact/hooks';

/**
 * A canvas that is painted again whenever its picture changes, once a turn.
 * @param draw gets the canvas, the picture and device pixels per CSS pixel
 */
export function usePainter<T>(
  picture: ReadonlySignal<T>,
  draw: (canvas: HTMLCanvasElement, picture: T, ratio: number) => void,
): RefObject<HTMLCanvasElement | null> {
  const canvas = useRef<HTMLCanvasElement>(null);
  const waiting = useRef(false);
  useSignalEffect(() => {
    void picture.value;
    if (waiting.current) return;
    waiting.current = true;
    // In the same turn as the elements move, so that poses never part from their stems.
    queueMicrotask(() => {
      waiting.current = false;
      if (canvas.current) draw(canvas.current, picture.peek(), Math.min(devicePixelRatio || 1, 2));
    });
  });
  return canvas;
}
