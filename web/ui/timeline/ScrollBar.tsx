import { useStore } from '../store-context';

/** Which part of the song is in sight; drag to scroll. */
export function ScrollBar() {
  const store = useStore();
  const { view, viewWidth, duration } = store.state;
  const { start, pixelsPerSecond } = view.value;
  const span = pixelsPerSecond > 0 ? viewWidth.value / pixelsPerSecond : 0;
  const whole = Math.max(duration.value, span, 1e-6);
  const share = Math.min(1, span / whole);

  const onPointerDown = (event: PointerEvent) => {
    if (event.button !== 0) return;
    const track = event.currentTarget as HTMLElement;
    track.setPointerCapture(event.pointerId);
    const go = (clientX: number) => {
      const box = track.getBoundingClientRect();
      store.setView(((clientX - box.left) / box.width) * whole - span / 2, pixelsPerSecond);
    };
    go(event.clientX);
    const move = (next: PointerEvent) => go(next.clientX);
    track.addEventListener('pointermove', move);
    const stop = () => track.removeEventListener('pointermove', move);
    track.addEventListener('pointerup', stop, { once: true });
    track.addEventListener('pointercancel', stop, { once: true });
  };

  return (
    <div class={`scrollbar ${share >= 1 ? 'whole' : ''}`} aria-hidden="true" onPointerDown={onPointerDown}>
      <div class="scrollbar-thumb" style={{ left: `${Math.max(0, start / whole) * 100}%`, width: `${share * 100}%` }} />
    </div>
  );
}
