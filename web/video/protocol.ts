/** What the page and the video worker say to each other. */
import type { BeatGrid, Motion } from '../core/types';
import type { FramePlan, VideoCamera, VideoFormat } from './options';
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

/** All that a video is made from. */
export interface FilmRequest {
  motion: Motion;
  plan: FramePlan;
  width: number;
  height: number;
  camera: VideoCamera;
  background: string;
  grid: BeatGrid | null;
  sound: Sound | null;
  /** Without it the first that this browser can. */
  format: VideoFormat | null;
  /** Name of the song, written into the file. */
  title: string;
}

/** Page -> worker; a worker does one job. */
export type VideoCall =
  | { type: 'probe'; wish: EncoderWish }
  | { type: 'film'; request: FilmRequest; file?: FileSystemFileHandle }
  | { type: 'cancel' };

/** Worker -> page. */
export type VideoReply =
  | { type: 'support'; support: VideoSupport }
  | { type: 'progress'; done: number }
  /** `bytes` is missing where the video went straight to the disk. */
  | { type: 'done'; format: VideoFormat; bytes?: ArrayBuffer }
  | { type: 'error'; message: string; aborted: boolean };

/** What browsers call the formats. */
export const VIDEO_TYPES: Readonly<Record<VideoFormat, string>> = { mp4: 'video/mp4', webm: 'video/webm' };
