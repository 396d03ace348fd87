/** Pictures of the dance: a still, a contact sheet of its key poses, a small animation. They only read the project. */
import { drawInWorkerLater } from '../../video/draw-later';
import { loopPlan, LOOP_SIZE } from '../../video/loop-plan';
import { framePlan, pictureSettings, videoSize, type PictureOptions } from '../../video/options';
import type { PictureCall, SceneRequest } from '../../video/protocol';
import { MOST_POSES, type SheetPose } from '../../video/sheet-layout';
import type { Context } from '../context';
import { dancerOf, documentOnStage } from '../on-stage';
import { barAndBeat, clockTime } from '../snapping';

/** How the maker of a picture hears of it. */
export interface PictureHooks {
  /** 0..1 */
  onProgress?: (fraction: number) => void;
  /** Stops the picture; the call is rejected with an AbortError. */
  signal?: AbortSignal;
}

/** Draws a picture beside the page. */
export type Drawer = (call: PictureCall, progress: (done: number) => void, signal: AbortSignal) => Promise<Blob>;

/** Actions on pictures. */
export function stillActions({ state, services }: Context) {
  const draw: Drawer = services.draw ?? drawInWorkerLater;
  const make = (call: PictureCall, { onProgress, signal }: PictureHooks) =>
    draw(call, (done) => onProgress?.(done), signal ?? new AbortController().signal);

  const scene = (): Pick<SceneRequest, 'motion' | 'view' | 'look' | 'avatar' | 'grid'> => {
    const dance = state.onStage.value;
    if (!dance || dance.kind === 'preview') {
      throw new Error('There is no dance yet: drop a song and press Generate, then save a picture of it.');
    }
    const document = state.document.value;
    return {
      motion: dance.motion,
      view: document.camera,
      ...dancerOf(state, document),
      grid: state.grid.value,
    };
  };

  return {
    /**
     * The stage at a moment as a PNG.
     * @throws Error with what is wrong and what to do: no dance, an unknown option, no 3D; AbortError when it is stopped
     */
    async exportPicture(options: PictureOptions & PictureHooks = {}): Promise<Blob> {
      const { aspect, size, camera, background, time } = pictureSettings(options);
      const { motion, ...rest } = scene();
      const length = motion.frames / motion.fps;
      const at = time ?? state.time.value;
      if (at > length + 1e-6) throw new Error(`time must be inside the dance (0 to ${length.toFixed(2)} s).`);
      const plan = framePlan({ start: at, end: at + 1 / motion.fps }, motion.fps);
      return make(
        { type: 'still', request: { motion, ...rest, plan, ...videoSize(aspect, size), camera, background } },
        options,
      );
    },

    /**
     * The key poses on stage as one PNG: figures in order, each with its name, time and bar. More than {@link MOST_POSES} are cut off.
     * @param options.scale - 1 (when left out) is 2400 pixels across.
     * @throws Error when there are no key poses
     */
    async exportKeyPoses(options: PictureHooks & { scale?: number } = {}): Promise<Blob> {
      const document = documentOnStage(state);
      const { keyPoses } = document;
      if (keyPoses.length === 0) throw new Error('There are no key poses yet: place some on the timeline first.');
      const grid = state.grid.value;
      const { scale = 1 } = options;
      if (!(scale >= 0.1 && scale <= 2)) throw new Error('scale must be a number from 0.1 to 2.');
      const poses = keyPoses.slice(0, MOST_POSES).map(({ rotations, name, time }, i): SheetPose => {
        const place = barAndBeat(grid, time);
        return {
          rotations,
          name: name ? `${i + 1}  ${name}` : `Pose ${i + 1}`,
          when: clockTime(time) + (place ? `, bar ${place.bar}, beat ${place.beat}` : ''),
        };
      });
      const title = (state.song.value?.reference.name ?? 'Dance').replace(/\.[a-z0-9]{2,5}$/i, '');
      return make(
        { type: 'sheet', request: { title, tempo: grid?.tempo ?? null, poses, ...dancerOf(state, document), scale } },
        options,
      );
    },

    /**
     * A few seconds of the dance as an animated GIF that goes round on the beat: the selected stretch where it is short, else the bars at
     * the playhead.
     * @throws Error when there is no dance
     */
    async exportLoop(options: PictureHooks = {}): Promise<Blob> {
      const { motion, ...rest } = scene();
      const end = motion.frames / motion.fps;
      const trim = state.document.value.trim;
      const within = trim ? { start: trim.start, end: Math.min(trim.end, end) } : { start: 0, end };
      const plan = loopPlan(state.time.value, state.loop.value, rest.grid, within);
      return make(
        {
          type: 'loop',
          request: {
            motion,
            ...rest,
            plan,
            width: LOOP_SIZE,
            height: LOOP_SIZE,
            camera: 'follow',
            background: 'stage',
          },
        },
        options,
      );
    },
  };
}
