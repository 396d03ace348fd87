/** `window.posebeat`: the public automation API, for embedders, demo links and headless checks. */
import spec from '../core/spec.json';
import { motionToAxisAngle } from '../core/motion';
import type { ProjectDocument } from '../core/document';
import type { SetAvatarOptions } from './actions/avatar';
import type { GenerateCall, GenerateSummary } from './actions/dance';
import type { MotionFileOptions } from './actions/export';
import { MOTION_FORMATS, type MotionFormat } from './motion-formats';
import type { SuggestCall } from './actions/suggest';
import type { PictureHooks } from './actions/stills';
import type { VideoCallOptions } from './actions/video';
import type { PictureOptions } from '../video/options';
import type { DanceReport } from './report';
import type { Store } from './store';

/** What `exportAs` knows. */
export type ExportFormat = MotionFormat | 'curves' | 'project';

/** The public API. Rejected input throws an Error that says what is wrong, and leaves the document as it was. */
export interface PosebeatApi {
  /** Resolves when the page can be driven. */
  ready: Promise<void>;
  /** Decodes and analyses a song; a string is an address. All times in seconds. */
  loadSong(
    source: File | Blob | string,
  ): Promise<{ duration: number; tempo: number; beats: number[]; downbeats: number[] }>;
  /** Music features of the song, frames x 15. */
  features(): { fps: number; names: string[]; data: Float32Array };
  /** Replaces the key poses: time in seconds, 24 x 3 axis-angle radians each. */
  setKeyPoses(keys: { time: number; rotations: ArrayLike<number>; name?: string }[]): void;
  /**
   * Suggests key poses on the song's beats, puts them on the timeline and gives them back; own and locked key poses stay. `half` is half
   * a bar; `gaps` only fills between own key poses; the same seed gives the same poses.
   */
  suggestKeyPoses(options?: SuggestCall): Promise<{ time: number; rotations: number[] }[]>;
  /** Makes the dance; a later call cancels an earlier one. */
  generate(options?: GenerateCall): Promise<GenerateSummary>;
  /** The dance: rotations frames x 72 axis-angle radians, root frames x 3 metres. */
  motion(): { fps: number; rotations: Float32Array; root: Float32Array };
  report(): DanceReport;
  /**
   * A file. `bvh`, `glb`, `fbx`, `npz` (SMPL: AIST++ and AMASS names) and `json` hold the dance on stage, `avatar` the character of
   * `setAvatar` with that dance (GLB); `project` is JSON text, or with
   * `song: true` a zip with the song's own bytes inside (both open again as `.posebeat`). `curves` is the dance of engine "curves": our
   * JSON, or with `as: 'glb'` an animation of cubic splines (`figure: true`: with our figure).
   */
  exportAs(format: ExportFormat, options?: MotionFileOptions & { song?: boolean; as?: 'json' | 'glb' }): Promise<Blob>;
  /**
   * The dance on stage as a video with the song: MP4, or WebM where the browser has no encoder for MP4 (a wished format that it cannot
   * make is rejected). Every frame is drawn at its own time beside the page, and the sound begins with the first frame. A later call
   * stops an earlier one. Rejects where there is no dance or no encoder; with an AbortError when `signal` fires.
   */
  exportVideo(options?: VideoCallOptions): Promise<Blob>;
  /**
   * Lets a character of one's own dance in the place of the figure: a VRM or humanoid GLB file; null = the figure again. It is kept in
   * this browser, not in the project. Rejects when bones cannot be told: `bones` then says which node is which joint. Height in metres.
   */
  setAvatar(file: File | Blob | null, options?: SetAvatarOptions): Promise<{ name: string; height: number } | null>;
  /** The character on stage, and where our 24 joints are in its body now: 24 x 3 metres, floor at y = 0; null = the figure dances. */
  avatar(): { name: string; height: number; joints: Float32Array } | null;
  /** The stage at a moment as a PNG, at any of the video's shapes and sizes; `background: 'none'` makes it transparent. */
  exportPicture(options?: PictureOptions & PictureHooks): Promise<Blob>;
  /** The key poses as one PNG: figures in order with their names, times and bars. `scale` 1 is 2400 pixels across. */
  exportKeyPoses(options?: PictureHooks & { scale?: number }): Promise<Blob>;
  /** A few seconds of the dance as an animated GIF that goes round on the beat: the selected stretch, or the bars at the playhead. */
  exportLoop(options?: PictureHooks): Promise<Blob>;
  /** The project as an address: opening it shows the same dance. Rejects when it would be too long for one. */
  shareLink(): Promise<string>;
  /** A copy of the project document. */
  document(): ProjectDocument;
}

declare global {
  interface Window {
    posebeat: PosebeatApi;
  }
}

/**
 * The options of a call from a script or a message, which may be anything.
 * @throws Error where they, or the stretch that they name, are none
 */
function checked<T extends object>(method: string, options: T): T {
  if (typeof options !== 'object' || options === null || Array.isArray(options)) {
    throw new Error(`The options of ${method} must be an object, or left out.`);
  }
  const { range } = options as { range?: unknown };
  if (range === undefined || typeof range === 'string') return options;
  const { start, end } = (range ?? {}) as { start?: unknown; end?: unknown };
  if (typeof start !== 'number' || typeof end !== 'number') throw new Error('range must be {start, end} in seconds.');
  return options;
}

/** Makes the API of a page. */
export function createApi(store: Store, ready: Promise<void>): PosebeatApi {
  const { state } = store;
  const onStage = () => {
    const dance = state.dance.value;
    if (!dance || dance.kind === 'preview') throw new Error('There is no dance yet: call generate first.');
    return dance.motion;
  };
  return {
    ready,
    async loadSong(source) {
      const song = await store.loadSong(source);
      const grid = state.grid.value ?? song.grid!;
      return {
        duration: song.reference.duration,
        tempo: grid.tempo,
        beats: [...grid.beats],
        downbeats: [...grid.downbeats],
      };
    },
    features() {
      const song = state.song.value;
      if (!song?.complete || !song.features) throw new Error('There is no analysed song yet: call loadSong first.');
      return { fps: song.features.fps, names: [...spec.features.names], data: song.features.data.slice() };
    },
    setKeyPoses: (keys) => store.setKeyPoses(keys),
    async suggestKeyPoses(options = {}) {
      const found = await store.suggestKeyPoses(checked('suggestKeyPoses', options));
      return found.map(({ time, rotations }) => ({ time, rotations: [...rotations] }));
    },
    generate: async (options = {}) => store.generate(checked('generate', options)),
    motion() {
      const motion = onStage();
      return { fps: motion.fps, rotations: motionToAxisAngle(motion), root: motion.root.slice() };
    },
    report() {
      onStage();
      return store.reportNow();
    },
    async exportAs(format, options = {}) {
      checked('exportAs', options);
      if (format === 'project') return store.projectFile(options.song === true);
      if ((MOTION_FORMATS as readonly string[]).includes(format)) {
        return store.exportMotion(format as MotionFormat, options);
      }
      if (format === 'curves') return store.exportCurves(options.as, { figure: options.figure === true });
      throw new Error(
        `There is no export format "${String(format)}": use bvh, glb, fbx, npz, json, avatar, curves or project.`,
      );
    },
    exportVideo: async (options = {}) => store.exportVideo(checked('exportVideo', options)),
    exportPicture: async (options = {}) => store.exportPicture(checked('exportPicture', options)),
    exportKeyPoses: async (options = {}) => store.exportKeyPoses(checked('exportKeyPoses', options)),
    exportLoop: async (options = {}) => store.exportLoop(checked('exportLoop', options)),
    setAvatar: async (file, options = {}) => store.setAvatar(file, checked('setAvatar', options)),
    avatar() {
      const shown = state.avatar.value;
      return shown && { name: shown.name, height: shown.figure.height, joints: shown.figure.pose.joints.slice() };
    },
    shareLink: async () => store.shareLink(location.href),
    document: () => structuredClone(state.document.value),
  };
}
