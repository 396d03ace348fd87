import { clockTime, stepBeat } from '../../app/snapping';
import { capturePointer } from '../pointer';
import { useStore } from '../store-context';
import { timeToX } from './geometry';
import { timeAtX } from './surface';

/** The two ends of the loop: drag (snaps to beats, Alt does not) or arrow keys. */
export function LoopHandles() {
  const store = useStore();
  const { loop, view, grid, duration } = store.state;
  const range = loop.value;
  if (!range) return null;
  const ends = ['start', 'end'] as const;

  const move = (end: 'start' | 'end', time: number) => {
    const now = store.state.loop.value;
    if (now) store.setLoop({ ...now, [end]: time });
  };
  const onPointerDown = (end: 'start' | 'end') => (event: PointerEvent) => {
    if (event.button !== 0) return;
    event.stopPropagation();
    capturePointer(event, (next) => {
      const time = timeAtX(store, next.clientX);
      const target = store.snapTime(time, next.altKey);
      const now = store.state.loop.value;
      if (now && (end === 'start' ? target < now.end : target > now.start)) move(end, target);
    });
  };

  return (
    <>
      {ends.map((end) => (
        <div
          key={end}
          class={`loop-handle loop-${end}`}
          data-grab
          role="slider"
          tabIndex={0}
          aria-label={end === 'start' ? 'Loop start' : 'Loop end'}
          aria-valuemin={0}
          aria-valuemax={Math.round(duration.value * 10) / 10}
          aria-valuenow={Math.round(range[end] * 10) / 10}
          aria-valuetext={clockTime(range[end])}
          style={{ transform: `translateX(${timeToX(view.value, range[end])}px)` }}
          onPointerDown={onPointerDown(end)}
          onKeyDown={(event) => {
            const direction = event.key === 'ArrowLeft' ? -1 : event.key === 'ArrowRight' ? 1 : 0;
            if (direction === 0) return;
            event.preventDefault();
            move(end, stepBeat(grid.value, range[end], direction));
          }}
        />
      ))}
    </>
  );
}
