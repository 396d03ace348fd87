/** What the page and the video worker say to each other. */
import type { CameraView } from '../core/document';
import type { FigureLook } from '../core/figure-look';
import type { BeatGrid, Motion } from '../core/types';
import type { AvatarSource } from '../scene/avatar';
import type { FramePlan, VideoCamera, VideoFormat } from './options';
import type { SheetPose } from './sheet-layout';
import type { Sound } from './sound';

/** Picture and sound as an encoder is asked for them. */
export interface EncoderWish {
  width: number;
  height: number;
  fps: number;
  /** Missing = no sound. */
  sound?: { sampleRate: number; channels: number };
}

/** What one format would be made with; null = this browser cannot. */
export interface FormatSupport {
  video: string | null;
  audio: string | null;
}

/** What this browser can make. */
export interface VideoSupport {
  /** False where there is no video encoder at all, or nothing to draw with. */
  any: boolean;
  formats: Readonly<Record<VideoFormat, FormatSupport>>;
}

/** What is seen, and from where: of a video, a still picture or a moving preview. */
export interface SceneRequest {
  motion: Motion;
  plan: FramePlan;
  width: number;
  height: number;
  camera: VideoCamera;
  /** The visitor's own view, for the camera `stage`; null = the opening view. */
  view: CameraView | null;
  /** `stage`, `none` for a transparent picture, or `#rrggbb`. */
  background: string;
  /** What our own figure wears. */
  look: FigureLook;
  /** A character of the visitor's own in the figure's place. */
  avatar?: AvatarSource;
  grid: BeatGrid | null;
}

/** All that a video is made from. */
export interface FilmRequest extends SceneRequest {
  sound: Sound | null;
  /** Without it the first that this browser can. */
  format: VideoFormat | null;
  /** Name of the song, written into the file. */
  title: string;
}

/** All that a contact sheet is made from. */
export interface SheetRequest {
  /** Name of the song. */
  title: string;
  /** Beats per minute. */
  tempo: number | null;
  poses: readonly SheetPose[];
  look: FigureLook;
  /** A character of the visitor's own in the figure's place. */
  avatar?: AvatarSource;
  /** 1 = 2400 pixels across. */
  scale: number;
}

/** Pictures that are drawn beside the page. */
export type PictureCall =
  /** `rows` are drawn at once; without it as many as come quickly. */
  | { type: 'still'; request: SceneRequest; rows?: number }
  | { type: 'sheet'; request: SheetRequest }
  /** The frames of the plan as an animation that goes round and round. */
  | { type: 'loop'; request: SceneRequest };

/** Page -> worker; a worker does one job. */
export type VideoCall =
  | { type: 'probe'; wish: EncoderWish }
  | { type: 'film'; request: FilmRequest; file?: FileSystemFileHandle }
  | PictureCall
  | { type: 'cancel' };

/** Worker -> page. */
export type VideoReply =
  | { type: 'support'; support: VideoSupport }
  /** Frames of a video; 0..1 of a picture. */
  | { type: 'progress'; done: number }
  /** `bytes` is missing where the video went straight to the disk. */
  | { type: 'done'; format: VideoFormat; bytes?: ArrayBuffer }
  | { type: 'picture'; blob: Blob }
  | { type: 'error'; message: string; aborted: boolean };

/** What browsers call the formats. */
export const VIDEO_TYPES: Readonly<Record<VideoFormat, string>> = { mp4: 'video/mp4', webm: 'video/webm' };
