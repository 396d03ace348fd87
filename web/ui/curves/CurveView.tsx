import { useComputed, useSignalEffect } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { intervalInHand } from '../../app/actions/curves';
import { INNER_KNOTS } from '../../core/curves';
import { useStore } from '../store-context';
import { usePainter } from '../timeline/use-painter';
import {
  AXES,
  CURVE_LANE,
  heldScale,
  hiddenAxes,
  scaleOf,
  shownCurves,
  trackLabel,
  valueText,
  valueToY,
  type ShownCurves,
} from './curve-space';
import { drawTrack } from './draw-track';
import { beginKnotDrag, knotsAt, type KnotPlace } from './knot-drag';

/** Degrees or centimetres of an arrow key, and with Shift. */
const KEY_STEP = { plain: 1, large: 10 };

/** The curves of one joint under the timeline; those of the stretch at the playhead can be bent. */
export function CurveView({ top }: { top: number }) {
  const store = useStore();
  const { state } = store;
  const shown = shownCurves(store);
  const interval = useComputed(() => intervalInHand(state));
  const scene = useComputed(() => ({
    view: state.view.value,
    width: state.viewWidth.value,
    curves: shown.value,
    interval: interval.value,
    hidden: hiddenAxes.value,
    scale: heldScale.value,
  }));
  const canvas = usePainter(scene, drawTrack);
  const curves = shown.value;
  return (
    <div
      class="curve-view"
      role="group"
      aria-label={`Curves of ${curves ? trackLabel(curves.track) : 'a joint'}`}
      style={{ top: `${top}px`, height: `${CURVE_LANE.height}px` }}
    >
      <canvas ref={canvas} class="timeline-canvas" style={{ height: `${CURVE_LANE.height}px` }} aria-hidden="true" />
      {curves ? <Knots curves={curves} interval={interval.value} /> : <NoCurves />}
    </div>
  );
}

/** The inner knots of the stretch in hand. */
function Knots({ curves, interval }: { curves: ShownCurves; interval: number }) {
  const store = useStore();
  const { state } = store;
  const layer = useRef<HTMLDivElement>(null);
  const scale = useComputed(() => state.view.value.pixelsPerSecond);
  // Straight to the element: a render per frame would be waste.
  useSignalEffect(() => {
    const { start, pixelsPerSecond } = state.view.value;
    if (layer.current) layer.current.style.transform = `translateX(${-start * pixelsPerSecond}px)`;
  });
  if (interval < 0) return null;
  const places = AXES.flatMap((_, axis) =>
    hiddenAxes.value.has(axis) ? [] : Array.from({ length: INNER_KNOTS }, (__, n) => ({ interval, n, axis })),
  );
  return (
    <div class="curve-knots" ref={layer} role="presentation">
      {places.map((place) => (
        <Knot key={`${place.axis} ${place.n}`} curves={curves} place={place} pixelsPerSecond={scale.value} />
      ))}
    </div>
  );
}

function Knot(props: { curves: ShownCurves; place: KnotPlace; pixelsPerSecond: number }) {
  const { curves, place, pixelsPerSecond } = props;
  const store = useStore();
  const { picture, track } = curves;
  const index = place.interval * (INNER_KNOTS + 1) + 1 + place.n;
  const value = picture.knotValues[index * 3 + place.axis];
  const scale = scaleOf(picture);
  const { name, colour } = AXES[place.axis];

  const onKeyDown = (event: KeyboardEvent) => {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const step = event.shiftKey ? KEY_STEP.large : KEY_STEP.plain;
    const steps: Record<string, number> = { ArrowUp: step, ArrowDown: -step, PageUp: 10, PageDown: -10 };
    const change = steps[event.key];
    if (event.key === 'ArrowLeft' || event.key === 'ArrowRight') {
      focusNeighbour(event.currentTarget as HTMLElement, event.key === 'ArrowRight' ? 1 : -1);
    } else if (change !== undefined) {
      const knots = knotsAt(store, curves, place, value + change);
      store.changeCurve(place.interval, track, { knots }, 'Move curve knot');
    } else if (event.key === 'Delete' || event.key === 'Backspace') {
      store.resetCurve(track, place.interval);
    } else return;
    event.preventDefault();
    event.stopPropagation();
  };

  return (
    <div
      class="curve-knot"
      data-grab
      role="slider"
      tabIndex={0}
      aria-orientation="vertical"
      aria-label={`${trackLabel(track)} ${name}, ${place.n === 0 ? 'first' : 'second'} inner knot`}
      aria-valuemin={Math.round(scale.lowest)}
      aria-valuemax={Math.round(scale.highest)}
      aria-valuenow={Math.round(value)}
      aria-valuetext={valueText(value, track)}
      title={`${name}: ${valueText(value, track)}. Drag it up or down; Shift goes finely, Delete sets the stretch back.`}
      style={{
        left: `${picture.knots[index] * pixelsPerSecond}px`,
        top: `${valueToY(value, scale)}px`,
        '--knot': colour,
      }}
      onPointerDown={(event) => beginKnotDrag(event, store, curves, place)}
      onFocus={() => {
        // The figure shows what the keys do to it.
        if (!store.state.playing.value && intervalInHand(store.state) === place.interval)
          store.seek(picture.knots[index]);
      }}
      onKeyDown={onKeyDown}
    >
      <span aria-hidden="true">{name}</span>
    </div>
  );
}

function focusNeighbour(element: HTMLElement, direction: -1 | 1): void {
  const all = [...(element.parentElement?.querySelectorAll<HTMLElement>('.curve-knot') ?? [])];
  all[(all.indexOf(element) + direction + all.length) % all.length]?.focus();
}

/** What to do where the dance on stage has no curves. */
function NoCurves() {
  const store = useStore();
  const { song, generation, document, dance } = store.state;
  const busy = generation.value.status !== 'idle';
  const made = dance.value?.curves !== undefined;
  return (
    <div class="curve-none">
      <p>
        {made
          ? 'One pose makes no curve: place another key pose and generate again.'
          : 'This dance is made of frames. As curves it can be bent here, joint by joint.'}
      </p>
      {song.value && !made && (
        <button
          type="button"
          class="secondary"
          data-grab
          disabled={busy}
          onClick={() => {
            if (document.value.engine !== 'curves') store.setEngine('curves');
            void store.generateForPage();
          }}
        >
          Make it of curves
        </button>
      )}
    </div>
  );
}
