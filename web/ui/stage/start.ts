/** The 3D stage on the page: it shows what the store's clock says, and tells the store what is posed on it. */
import { computed, effect } from '@preact/signals';
import type { Store } from '../../app/store';
import { DEFAULT_LOOK } from '../../core/figure-look';
import { framePose, type MutableFramePose } from '../../core/motion';
import type { Motion } from '../../core/types';
import type { Stage } from '../../scene/stage';
import { bindCamera } from '../stage-camera';
import { motionAt } from './motion-at';
import { bindOverlays } from './overlays';

/** Ties the stage to the store: the clock moves the figure, the editor's draft is on the gizmo. */
export async function startStage(
  container: HTMLElement,
  store: Store,
  onOpen: (stage: Stage) => void,
): Promise<() => void> {
  const { state } = store;
  const pose: MutableFramePose = { root: new Float32Array(3), quaternions: new Float32Array(96) };
  let stage: Stage | null = null;
  let lastBeat = -1;
  let shownTime = -1;
  let shownMotion: Motion | null = null;
  const besidePose: MutableFramePose = { root: new Float32Array(3), quaternions: new Float32Array(96) };
  let shownBeside: Motion | null = null;

  const onFrame = () => {
    const time = store.tick();
    store.followTime(time);
    const motion = motionAt(state, time);
    const held = state.compare.value;
    const beside = held?.beside && !state.draft.value ? held.dance.motion : null;
    // A dance that stands still is not drawn again: the graphics card may rest.
    if (stage && (beside !== shownBeside || (beside && time !== shownTime))) {
      stage.showBeside(beside && framePose(beside, time, besidePose));
      shownBeside = beside;
    }
    if (stage && motion && (motion !== shownMotion || time !== shownTime)) {
      const step = motion === shownMotion && state.playing.value ? time - shownTime : 0;
      stage.show(framePose(motion, time, pose), step);
      shownMotion = motion;
      shownTime = time;
    }
    const beat = state.playing.value ? beatIndex(store, time) : -1;
    if (beat >= 0 && beat !== lastBeat) stage?.pulse(isDownbeat(store, beat) ? 0.9 : 0.45);
    lastBeat = beat;
  };

  try {
    const { createStage } = await import('../../scene/stage');
    stage = createStage(container);
    await stage.ready;
  } catch (error) {
    store.notify('error', error instanceof Error ? error.message : 'The 3D stage could not start.');
  }
  if (!stage) return frameLoop(onFrame); // no picture, but the sound and the timeline go on

  const opened = stage;
  onOpen(opened);
  // Its own signal: the document changes with every edit, the look seldom.
  const look = computed(() => state.document.value.look ?? DEFAULT_LOOK);
  const undo: (() => void)[] = [opened.beforeFrame(onFrame)];
  let own: readonly number[] | null = null;
  undo.push(
    opened.onPoseChange((rotations, phase) => {
      own = rotations;
      store.changePose(rotations, phase);
    }),
    opened.onSelect((joint) => store.selectJoint(joint)),
    effect(() => {
      opened.follow = state.cameraFollows.value;
    }),
    bindCamera(opened, store),
    effect(() => {
      if (state.frameRequests.value > 0) opened.frameFigure();
    }),
    effect(() => {
      const draft = state.draft.value;
      opened.setMode(draft ? 'pose' : 'dance');
      if (!draft) {
        own = null;
        return;
      }
      // What the gizmo itself just did must not be loaded back under its drag.
      if (!own || !sameNumbers(own, draft.rotations)) {
        own = draft.rotations;
        opened.editPose(draft.rotations);
      }
      opened.selectJoint(draft.joint);
    }),
    effect(() => opened.setLook(look.value)),
    effect(() => opened.setPoseTools(state.poseTools.value)),
    effect(() => opened.setAvatar((state.avatarMapping.value ?? state.avatar.value)?.figure ?? null)),
    bindOverlays(opened, store),
  );
  return () => {
    for (const stop of undo) stop();
    opened.dispose();
  };
}

function beatIndex(store: Store, time: number): number {
  const beats = store.state.grid.value?.beats ?? [];
  let low = 0;
  let high = beats.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (beats[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

function isDownbeat(store: Store, beat: number): boolean {
  const grid = store.state.grid.value!;
  return grid.downbeats.includes(grid.beats[beat]);
}

function sameNumbers(a: readonly number[], b: readonly number[]): boolean {
  return a.length === b.length && a.every((value, i) => value === b[i]);
}

function frameLoop(callback: () => void): () => void {
  let request = requestAnimationFrame(function again() {
    request = requestAnimationFrame(again);
    callback();
  });
  return () => cancelAnimationFrame(request);
}
