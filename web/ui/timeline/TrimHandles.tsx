import { clockTime } from '../../app/snapping';
import { NUDGE } from '../../app/actions/beats';
import { MIN_TRIM } from '../../app/actions/trim';
import { snapTime } from '../../core/snap';
import { useStore } from '../store-context';
import { LANES, timeToX } from './geometry';
import { timeAtX } from './surface';

type End = 'start' | 'end';

/** The two ends of the part of the song that is danced to, and a shade over what lies outside it. */
export function TrimHandles() {
  const store = useStore();
  const { view, grid, duration, document: project } = store.state;
  if (duration.value < 2 * MIN_TRIM || view.value.pixelsPerSecond <= 0) return null;
  const part = project.value.trim ?? { start: 0, end: duration.value };
  const x = { start: timeToX(view.value, part.start), end: timeToX(view.value, part.end) };
  const song = { start: timeToX(view.value, 0), end: timeToX(view.value, duration.value) };

  /** The nearest bar, or an end of the song where that is nearer. */
  const snapped = (time: number): number =>
    [0, duration.value].reduce(
      (best, each) => (Math.abs(each - time) < Math.abs(best - time) ? each : best),
      snapTime(grid.value, time, 'bar'),
    );

  const onPointerDown = (end: End) => (event: PointerEvent) => {
    if (event.button !== 0) return;
    event.stopPropagation();
    const handle = event.currentTarget as HTMLElement;
    const { pointerId } = event;
    const off = event.clientX - handle.getBoundingClientRect()[end === 'start' ? 'right' : 'left'];
    handle.setPointerCapture(pointerId);
    store.beginTrimDrag();
    const move = (next: PointerEvent) => {
      const time = timeAtX(store, next.clientX - off);
      store.previewTrimDrag(end, next.altKey ? time : snapped(time));
    };
    const stop = (keep: boolean) => {
      handle.removeEventListener('pointermove', move);
      handle.removeEventListener('pointerup', up);
      handle.removeEventListener('pointercancel', cancel);
      window.removeEventListener('keydown', escape, true);
      if (keep) store.commitTrimDrag();
      else store.discardTrimDrag();
    };
    const up = () => stop(true);
    const cancel = () => stop(false);
    const escape = (next: KeyboardEvent) => {
      if (next.key !== 'Escape') return;
      next.preventDefault();
      next.stopPropagation();
      cancel();
    };
    handle.addEventListener('pointermove', move);
    handle.addEventListener('pointerup', up);
    handle.addEventListener('pointercancel', cancel);
    window.addEventListener('keydown', escape, true);
  };

  const onKeyDown = (end: End) => (event: KeyboardEvent) => {
    const now = part[end];
    const direction = event.key === 'ArrowLeft' ? -1 : event.key === 'ArrowRight' ? 1 : 0;
    const bar = ((60 / (grid.value?.tempo ?? 120)) * (grid.value?.beatsPerBar ?? 4)) / 2;
    let target: number;
    if (event.key === 'Home') target = 0;
    else if (event.key === 'End') target = duration.value;
    else if (direction === 0) return;
    else if (event.shiftKey) target = now + direction * NUDGE.frame;
    // More than half a bar on, so that a bar line a rounding error away is not the nearest one.
    else target = snapped(now + direction * bar * 1.2);
    event.preventDefault();
    event.stopPropagation();
    store.moveTrim(end, target);
    store.revealTime((store.state.document.value.trim ?? { start: 0, end: duration.value })[end]);
  };

  const shade = (from: number, to: number) => ({
    transform: `translateX(${from}px)`,
    width: `${Math.max(0, to - from)}px`,
  });
  return (
    <>
      {project.value.trim && (
        <>
          <div class="trim-shade" style={shade(song.start, x.start)} />
          <div class="trim-shade" style={shade(x.end, song.end)} />
        </>
      )}
      {(['start', 'end'] as const).map((end) => (
        <div
          key={end}
          class={`trim-handle trim-${end} ${project.value.trim ? 'trimmed' : ''}`}
          data-grab
          role="slider"
          tabIndex={0}
          aria-label={end === 'start' ? 'Start of the part to dance to' : 'End of the part to dance to'}
          aria-valuemin={0}
          aria-valuemax={Math.round(duration.value * 10) / 10}
          aria-valuenow={Math.round(part[end] * 10) / 10}
          aria-valuetext={clockTime(part[end])}
          title={`${end === 'start' ? 'Start' : 'End'} of the part to dance to: drag it to a bar, with Alt anywhere`}
          style={{
            top: `${LANES.wave.top}px`,
            height: `${LANES.keys.top - LANES.wave.top}px`,
            transform: `translateX(${x[end]}px)`,
          }}
          onPointerDown={onPointerDown(end)}
          onDblClick={() => store.moveTrim(end, end === 'start' ? 0 : duration.value)}
          onKeyDown={onKeyDown(end)}
          onFocus={(event) => {
            if (event.currentTarget.matches(':focus-visible')) store.revealTime(part[end]);
          }}
        />
      ))}
    </>
  );
}
