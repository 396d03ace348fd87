/** Ties the overlays of the stage to the store: ghosts of the neighbouring key poses and the path of a joint. */
import { computed, effect } from '@preact/signals';
import type { Store } from '../../app/store';
import { JointPath, neighbouringKeys } from '../../core/joint-path';
import { spec } from '../../core/spec';
import type { Stage } from '../../scene/stage';
import { motionAt } from './motion-at';
import {
  createPicture,
  draftStretch,
  draftTime,
  fillPicture,
  ghostsAround,
  keysWithDraft,
  markPicture,
  REACH,
} from './overlay-data';

/** Keeps the overlays up to date. Returns the way to stop that. */
export function bindOverlays(stage: Stage, store: Store): () => void {
  const { state } = store;
  const stops = [bindGhosts(stage, store), bindPath(stage, store)];

  let unlisten: (() => void) | null = null;
  stops.push(
    effect(() => {
      const choosing = state.pathJoint.value !== null && state.draft.value === null;
      unlisten?.();
      unlisten = choosing ? stage.onBodyClick((joint) => store.showPathOf(joint)) : null;
    }),
    () => unlisten?.(),
  );
  return () => stops.forEach((stop) => stop());
}

function bindGhosts(stage: Stage, { state }: Store): () => void {
  /** Middle of the onion skin; in the dance it changes only when the playhead passes a key pose, so that playing costs nothing. */
  const middle = computed(() => {
    if (!state.onionShown.value) return null;
    const { keyPoses } = state.document.value;
    const draft = state.draft.value;
    if (draft) return { time: draftTime(draft, keyPoses, state.time.value), ids: 'draft' };
    const { before, after } = neighbouringKeys(keyPoses, state.time.value, spec.fps);
    return { time: state.time.value, ids: `${before?.id} ${after?.id}` };
  });
  const when = computed(() => {
    const now = middle.value;
    return now && `${now.ids} ${now.ids === 'draft' ? now.time : ''}`;
  });
  return effect(() => {
    if (when.value === null) return stage.setGhosts(null);
    const { time } = middle.peek()!;
    const { keyPoses } = state.document.value;
    if (state.draft.value) return stage.setGhosts(ghostsAround(keyPoses, time, null, false));
    const motion = state.onStage.value?.motion ?? null;
    stage.setGhosts(ghostsAround(keyPoses, time, motion?.frames ? motion : null, !state.stale.value));
  });
}

function bindPath(stage: Stage, { state }: Store): () => void {
  const picture = createPicture();
  let path: JointPath | null = null;

  /** The path through the edited pose, anew with every change of it. */
  const edited = computed(() => {
    const draft = state.draft.value;
    const chosen = state.pathJoint.value;
    if (!draft || chosen === null) return null;
    const { keyPoses } = state.document.value;
    const time = draftTime(draft, keyPoses, state.time.value);
    const stretch = draftStretch(draft, keyPoses, state.dance.value, time);
    if (!stretch) return null;
    const path = new JointPath(stretch.motion, draft.joint ?? chosen);
    path.ensure(0, stretch.motion.frames);
    return { path, first: stretch.first, time, keys: keysWithDraft(draft, keyPoses, time) };
  });

  return effect(() => {
    const joint = state.pathJoint.value;
    if (joint === null) {
      path = null;
      return stage.setPath(null);
    }
    if (state.draft.value) {
      const through = edited.value;
      if (!through) return stage.setPath(null);
      const { first, time, keys } = through;
      const { frames, fps } = through.path.motion;
      fillPicture(picture, through.path.points, first, first, first + frames, time, fps);
      markPicture(picture, first, fps, state.grid.value, keys);
      return stage.setPath(picture);
    }
    const time = state.time.value;
    const motion = motionAt(state, time);
    if (!motion) return stage.setPath(null);
    if (path?.motion !== motion || path.joint !== joint) path = new JointPath(motion, joint);
    const now = Math.round(time * motion.fps);
    const reach = Math.round(REACH * motion.fps);
    const from = Math.max(0, Math.min(now, motion.frames - 1) - reach);
    const to = Math.min(motion.frames, now + reach + 1);
    path.ensure(from, to);
    fillPicture(picture, path.points, 0, from, to, time, motion.fps);
    markPicture(picture, from, motion.fps, state.grid.value, state.document.value.keyPoses);
    stage.setPath(picture);
  });
}
