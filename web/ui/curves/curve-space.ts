/** Where curves are in their lane: pure functions of the view, and what the lane's parts share. */
import { computed, signal, type ReadonlySignal } from '@preact/signals';
import type { Store } from '../../app/store';
import { curvesOnStage } from '../../app/actions/curves';
import type { CurveDance, CurveTrack } from '../../core/curves';
import { trackPicture, type TrackPicture } from '../../core/curves-view';
import { jointLabel } from '../../scene/pose-edit';

/** Height of the lane, CSS pixels, and the room for curves in it. */
export const CURVE_LANE = { height: 148, head: 24, foot: 8 };

/** One of the three curves of a track. */
export interface Axis {
  name: 'X' | 'Y' | 'Z';
  colour: string;
  /** Of its line, so that colour is not all that tells them apart. */
  dash: readonly number[];
}

/** The three curves. */
export const AXES: readonly Axis[] = [
  { name: 'X', colour: '#ff9a8d', dash: [] },
  { name: 'Y', colour: '#9be38c', dash: [7, 3] },
  { name: 'Z', colour: '#8fc1ff', dash: [2, 3] },
];

/** What is seen in the lane. */
export interface ShownCurves {
  base: CurveDance;
  shown: CurveDance;
  track: CurveTrack;
  picture: TrackPicture;
}

/** Axes that are not shown. */
export const hiddenAxes = signal<ReadonlySet<number>>(new Set());
/** Bottom and top of the lane while a knot is dragged, so that the curve does not shrink away under the pointer. */
export const heldScale = signal<{ lowest: number; highest: number } | null>(null);

const known = new WeakMap<Store, ReadonlySignal<ShownCurves | null>>();

/** The curves in the lane; null where the dance has none. */
export function shownCurves(store: Store): ReadonlySignal<ShownCurves | null> {
  let shown = known.get(store);
  if (!shown) {
    shown = computed(() => {
      if (!store.state.curvesOpen.value) return null;
      const curves = curvesOnStage(store.state);
      if (!curves || curves.shown.times.length < 2) return null;
      const track = store.state.curveTrack.value;
      return { ...curves, track, picture: trackPicture(curves.shown, track) };
    });
    known.set(store, shown);
  }
  return shown;
}

/** Bottom and top of the lane, degrees or centimetres. */
export function scaleOf(picture: TrackPicture): { lowest: number; highest: number } {
  return heldScale.value ?? picture;
}

/** Pixels from the lane's top. */
export function valueToY(value: number, { lowest, highest }: { lowest: number; highest: number }): number {
  const room = CURVE_LANE.height - CURVE_LANE.head - CURVE_LANE.foot;
  return CURVE_LANE.head + (1 - (value - lowest) / (highest - lowest)) * room;
}

/** Degrees or centimetres of a pixel. */
export function perPixel({ lowest, highest }: { lowest: number; highest: number }): number {
  return (highest - lowest) / (CURVE_LANE.height - CURVE_LANE.head - CURVE_LANE.foot);
}

/** The name of a track for people. */
export function trackLabel(track: CurveTrack): string {
  return track === 'root' ? 'Way of the body' : jointLabel(track);
}

/** A value for people: whole degrees, or centimetres. */
export function valueText(value: number, track: CurveTrack): string {
  const whole = Math.round(value) + 0;
  return track === 'root' ? `${whole} cm` : `${whole}°`;
}
