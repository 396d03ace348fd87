/** The curves of a dance in the visitor's hands: changes are in the document, the dance on stage follows them at once. */
import { effect, untracked } from '@preact/signals';
import { beatCount } from '../../core/beat-count';
import { knotBefore, sampleChannels, sampleCurves } from '../../core/curves';
import type { CurveAnchor, CurveDance, CurveTrack } from '../../core/curves';
import {
  applyEdits,
  findEdit,
  intervalOf,
  isBlank,
  NO_EDITS,
  rippleEdits,
  SHAPE_NAMES,
  trackName,
  trackOf,
  withEdit,
  withoutOrphans,
  type CurveEdit,
  type Triple,
} from '../../core/curves-edit';
import { MAX_CURVE_EDITS, type ProjectDocument } from '../../core/document';
import type { Warp } from '../../core/grid-ripple';
import type { BeatGrid, Motion } from '../../core/types';
import { writeCurvesGlb } from '../../core/formats/curves-glb';
import { writeCurvesJson } from '../../core/formats/curves-json';
import { messageOf, type Context } from '../context';
import type { DanceCache } from '../dance-cache';
import { fileName, saveFile } from '../download';
import { loadGlbFigure } from './export';
import { originOf } from '../motion-origin';
import type { Dance, State } from '../state';
import type { DanceActions } from './dance';

/** With more changed curves than this all is sampled anew. */
const FEW = 12;

/** What a curve is changed by; what is left out stays. */
export type CurveChange = Partial<Pick<CurveEdit, 'knots' | 'tension' | 'continuity' | 'bias'>>;

/** The curves on stage with the visitor's changes; null where the dance has none. */
export function curvesOnStage(state: State): { base: CurveDance; shown: CurveDance } | null {
  const dance = state.dance.value;
  if (!dance?.curves) return null;
  return { base: dance.curves, shown: applyEdits(dance.curves, state.document.value.curveEdits ?? NO_EDITS) };
}

/** The interval at a time: what is edited is what the playhead is in; -1 without curves. */
export function intervalInHand(state: State, time = state.time.value): number {
  const curves = state.dance.value?.curves;
  if (!curves || curves.times.length < 2) return -1;
  // A frame may lie a hair before its key pose.
  return Math.max(0, knotBefore(curves.times, time + 1e-4));
}

/** Changes to curves keep to their beats when the grid is another. */
export function curvesOnGrid(document: ProjectDocument, before: BeatGrid | null, warp: Warp, after: BeatGrid | null) {
  const { curveEdits } = document;
  if (!curveEdits) return document;
  const [from, to] = [beatCount(before), beatCount(after)];
  const moved = rippleEdits(
    curveEdits,
    (beat) => from.time(beat),
    warp,
    (time) => to.of(time),
  );
  return moved === curveEdits ? document : { ...document, curveEdits: moved };
}

/** Key poses that the curves on stage run through: they may be gone, yet their curves can be changed still, so their ids are not free. */
export function idsOnStage(state: State): string[] {
  return state.dance.value?.curves?.anchors.filter((anchor) => typeof anchor === 'string') ?? [];
}

/** A document without the changes of curves whose key poses are gone. */
export function withOwnCurves(document: ProjectDocument): ProjectDocument {
  const { curveEdits, keyPoses } = document;
  const kept = curveEdits && withoutOrphans(curveEdits, keyPoses);
  if (kept === curveEdits) return document;
  const next = { ...document, curveEdits: kept };
  if (!kept?.length) delete next.curveEdits;
  return next;
}

/** Actions on the curves of the dance. */
export function curveActions(
  context: Context,
  dances: DanceActions,
  cache: DanceCache,
  reveal: (time: number) => void,
) {
  const { state, history, services } = context;
  let dragging = false;

  // The dance on stage has the changes that the document says, also after undo, or when a former dance comes back.
  effect(() => {
    const dance = state.dance.value;
    const edits = state.document.value.curveEdits ?? NO_EDITS;
    if (!dance?.curves || dance.curveEdits === edits) return;
    untracked(() => {
      state.dance.value = { ...dance, motion: reshaped(dance, edits), curveEdits: edits };
      if (!history.capturing) rest();
    });
  });

  /** Nothing is dragged any more: the dance is measured and kept. */
  function rest(): void {
    const dance = state.dance.value;
    if (!dance?.curves) return;
    if (dance.byDials) cache.remember(dance, state.song.value?.reference.hash ?? '');
    dances.saveShown();
    void dances.measureShown();
  }

  const place = (interval: number, track: CurveTrack) => {
    const curves = state.dance.value?.curves;
    if (!curves || interval < 0 || interval + 1 >= curves.times.length) return null;
    const [from, to] = [curves.anchors[interval], curves.anchors[interval + 1]];
    const ids = new Set<CurveAnchor>(state.document.value.keyPoses.map(({ id }) => id));
    if ([from, to].some((anchor) => typeof anchor === 'string' && !ids.has(anchor))) {
      context.notify('info', 'A key pose of this stretch is gone: generate the dance anew, then change its curves.');
      return null;
    }
    const edits = state.document.value.curveEdits ?? NO_EDITS;
    const known = findEdit(edits, curves, interval, track);
    return { edits, edit: known ?? ({ from, to, track: trackName(track) } satisfies CurveEdit) };
  };

  /** The document with a change of one curve. */
  const changed = (document: ProjectDocument, edits: readonly CurveEdit[]): ProjectDocument => {
    if (edits === (document.curveEdits ?? NO_EDITS)) return document;
    const next: ProjectDocument = { ...document, curveEdits: edits };
    if (edits.length === 0) delete next.curveEdits;
    return next;
  };

  const fits = (edits: readonly CurveEdit[]): boolean => {
    if (edits.length <= MAX_CURVE_EDITS) return true;
    context.notify('info', `At most ${MAX_CURVE_EDITS} curves can be changed: set some back first.`);
    return false;
  };

  const actions = {
    /** The curve view under the timeline. */
    toggleCurveView(open = !state.curvesOpen.value): void {
      state.curvesOpen.value = open;
      // On small screens the panel lies over the timeline.
      if (open) state.sheetOpen.value = false;
      if (open && !state.dance.value?.curves) {
        context.announce('There are no curves yet: choose editable curves in the Dance panel and generate.');
      }
    },

    /** The joint whose curves are shown. */
    showCurvesOf(track: CurveTrack): void {
      state.curveTrack.value = track;
      context.announce(`Curves of ${track === 'root' ? 'the way of the body' : trackName(track).replace('_', ' ')}.`);
    },

    /** The stretch before (-1) or after (1) the one at the playhead: the playhead goes into its middle. */
    stepCurveInterval(direction: -1 | 1): void {
      const curves = state.dance.value?.curves;
      const interval = intervalInHand(state) + direction;
      if (!curves || interval < 0 || interval + 1 >= curves.times.length) return;
      const [from, to] = [curves.times[interval], curves.times[interval + 1]];
      services.player.seek((from + to) / 2);
      state.time.value = (from + to) / 2;
      reveal(state.time.value);
      context.announce(`Stretch from ${from.toFixed(2)} to ${to.toFixed(2)} seconds.`);
    },

    /** A drag of a knot or a handle begins. */
    beginCurveDrag(): void {
      history.capture();
      dragging = true;
    },

    /** The curve as it would be, live on the figure. */
    previewCurve(interval: number, track: CurveTrack, change: CurveChange): void {
      const here = place(interval, track);
      if (!here || !dragging || !history.capturing) return;
      const edits = withEdit(here.edits, merged(here.edit, change));
      if (edits.length > MAX_CURVE_EDITS) return;
      history.preview(changed(history.present, edits));
      context.sync();
    },

    /** The drag ends where it is: one step of undo. */
    commitCurveDrag(label = 'Edit curve'): void {
      if (!dragging) return;
      dragging = false;
      history.commit(label);
      context.sync();
      rest();
    },

    /** The drag never happened. */
    discardCurveDrag(): void {
      if (!dragging) return;
      dragging = false;
      history.discard();
      context.sync();
    },

    /** One change of a curve: one step of undo. */
    changeCurve(interval: number, track: CurveTrack, change: CurveChange, label = 'Edit curve'): void {
      const here = place(interval, track);
      if (!here) return;
      const edits = withEdit(here.edits, merged(here.edit, change));
      if (fits(edits)) context.change(label, (document) => changed(document, edits));
    },

    /** The curve as it was generated, of one stretch; without an interval of the joint's whole dance. */
    resetCurve(track: CurveTrack, interval?: number): void {
      const edits = state.document.value.curveEdits ?? NO_EDITS;
      const here = interval === undefined ? null : place(interval, track);
      const name = trackName(track);
      const kept = here
        ? withEdit(edits, { from: here.edit.from, to: here.edit.to, track: name })
        : edits.filter((edit) => edit.track !== name);
      if (kept.length === edits.length) return;
      context.change('Set curve back', (document) => changed(document, kept));
      context.announce('The curve is as it was generated.');
    },
    /**
     * The curves of the dance on stage, changes included, as a file: our JSON, or a GLB animation of cubic splines, with our figure where
     * it is wished.
     * @throws Error when the dance on stage has no curves
     */
    async exportCurves(as: 'json' | 'glb' = 'json', { figure = false } = {}): Promise<Blob> {
      if (as !== 'json' && as !== 'glb') throw new Error('as must be "json" or "glb".');
      const dance = state.onStage.value;
      if (!dance?.curves) throw new Error('This dance has no curves: generate it with the engine "curves" first.');
      const curves = applyEdits(dance.curves, dance.curveEdits ?? NO_EDITS);
      const name = state.document.value.song?.name ?? 'dance';
      const origin = await originOf(state, dance);
      if (as === 'json') return new Blob([writeCurvesJson(curves, origin)], { type: 'application/json' });
      const body = figure ? await bodyOf(dance.motion, state.document.value.look) : {};
      return new Blob([writeCurvesGlb(curves, name, { origin, ...body })], { type: 'model/gltf-binary' });
    },

    /** Saves the curves as a file for the visitor to keep; what is wrong becomes a notice. */
    async saveCurves(as: 'json' | 'glb', options: { figure?: boolean } = {}): Promise<void> {
      try {
        const blob = await actions.exportCurves(as, options);
        const name = fileName(state.document.value.song?.name ?? 'dance', `curves.${as}`);
        saveFile(blob, name);
        context.announce(`${name} is saved.`);
      } catch (error) {
        context.notify('error', messageOf(error));
      }
    },
  };
  return actions;
}

/** Actions on the curves of the dance. */
export type CurveActions = ReturnType<typeof curveActions>;

/** Our figure for a file, and how its helper bones move in a dance: frame by frame, for nobody edits them. */
async function bodyOf(motion: Motion, look: ProjectDocument['look']) {
  const [figure, { helperSamplers }] = await Promise.all([loadGlbFigure(look), import('../../scene/skin-samplers')]);
  return { figure, helpers: helperSamplers(motion) };
}

/** An edit with some of it changed; what says nothing any more is left out, so that equal edits are equal. */
function merged(edit: CurveEdit, change: CurveChange): CurveEdit {
  const all = { ...edit, ...change };
  const { knots } = all;
  const made: CurveEdit = { from: all.from, to: all.to, track: all.track };
  if (knots?.some((triple: Triple) => triple.some((value) => value !== 0))) made.knots = knots;
  for (const name of SHAPE_NAMES) if (all[name] !== undefined) made[name] = all[name];
  return isBlank(made) ? { from: all.from, to: all.to, track: all.track } : made;
}

/** The motion of a dance of curves with other changes: only what they touch is sampled anew. */
function reshaped(dance: Dance, edits: readonly CurveEdit[]): Motion {
  const curves = dance.curves!;
  const { motion } = dance;
  const before = dance.curveEdits ?? NO_EDITS;
  const known = new Set(before);
  const now = new Set(edits);
  const touched = [...before.filter((edit) => !now.has(edit)), ...edits.filter((edit) => !known.has(edit))];
  const shaped = applyEdits(curves, edits);
  if (touched.length > FEW) return sampleCurves(shaped, motion.fps, motion.frames);
  const made: Motion = { ...motion, root: motion.root.slice(), quaternions: motion.quaternions.slice() };
  const last = curves.times.length - 1;
  for (const edit of touched) {
    const interval = intervalOf(curves, edit);
    const track = trackOf(edit.track);
    if (interval < 0 || track === null) continue;
    // A knot bends the curve up to the second knot away, and the shape of an interval that of its neighbours.
    const start = Math.max(0, Math.floor(curves.times[Math.max(0, interval - 1)] * motion.fps));
    const end = Math.ceil(curves.times[Math.min(last, interval + 2)] * motion.fps) + 1;
    sampleChannels(shaped, made, [track], start, Math.min(motion.frames, end));
  }
  return made;
}
