import { useSignalEffect } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { capturePointer } from '../pointer';
import { useStore } from '../store-context';

/** The thumb is never shorter, CSS pixels. */
const MIN_THUMB = 24;

/** Which part of the song is in sight; drag to scroll. */
export function ScrollBar() {
  const store = useStore();
  const { view, viewWidth, duration } = store.state;
  const track = useRef<HTMLDivElement>(null);
  const thumb = useRef<HTMLDivElement>(null);

  const shown = () => {
    const { start, pixelsPerSecond } = view.value;
    const span = pixelsPerSecond > 0 ? viewWidth.value / pixelsPerSecond : 0;
    const whole = Math.max(duration.value, span, 1e-6);
    return { start: Math.max(0, start), span, whole, share: Math.min(1, span / whole) };
  };
  // Straight to the elements, and by transforms alone while panning: nothing is rendered or laid out.
  useSignalEffect(() => {
    const { start, whole, share } = shown();
    if (!thumb.current || !track.current) return;
    const length = Math.max(0, viewWidth.value - 16);
    const width = Math.max(MIN_THUMB, share * length);
    const free = Math.max(0, length - width);
    const left = share >= 1 ? 0 : Math.min(1, start / Math.max(1e-6, whole * (1 - share))) * free;
    if (thumb.current.style.width !== `${width}px`) thumb.current.style.width = `${width}px`;
    thumb.current.style.transform = `translateX(${left}px)`;
    track.current.classList.toggle('whole', share >= 1);
  });

  const onPointerDown = (event: PointerEvent) => {
    if (event.button !== 0) return;
    const { left, width } = (event.currentTarget as HTMLElement).getBoundingClientRect();
    const { start, span, whole } = shown();
    const under = ((event.clientX - left) / width) * whole;
    // On the thumb it stays under the finger; beside it, it comes there.
    const grip = under >= start && under <= start + span ? under - start : span / 2;
    const go = (clientX: number) =>
      store.setView(((clientX - left) / width) * whole - grip, view.value.pixelsPerSecond);
    go(event.clientX);
    capturePointer(event, (next) => go(next.clientX));
  };

  return (
    <div class="scrollbar" aria-hidden="true" ref={track} onPointerDown={onPointerDown}>
      <div class="scrollbar-thumb" ref={thumb} />
    </div>
  );
}
