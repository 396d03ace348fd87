/** What a video can be: shapes, sizes, rates, cameras; and which moments its frames show. Pure: no DOM, no three. */
import type { TimeRange } from '../core/document';

/** Width to height. */
export const ASPECTS = ['16:9', '1:1', '9:16'] as const;
/** One of them. */
export type VideoAspect = (typeof ASPECTS)[number];
/** Pixels along the shorter edge. */
export const VIDEO_SIZES = [180, 360, 720, 1080, 1440, 2160] as const;
/** Frames per second. */
export const VIDEO_RATES = [30, 60] as const;
/** How the camera moves: along with the dancer, from the audience's seat, round the dancer, in shots that change on bars, as on stage. */
export const VIDEO_CAMERAS = ['follow', 'front', 'orbit', 'cuts', 'stage'] as const;
/** One of them. */
export type VideoCamera = (typeof VIDEO_CAMERAS)[number];
/** Containers. */
export const VIDEO_FORMATS = ['mp4', 'webm'] as const;
/** One of them. */
export type VideoFormat = (typeof VIDEO_FORMATS)[number];
/** Longest video, seconds: beyond it a file gets too large for what plays it. */
export const LONGEST = 3600;

/** How a video is made; everything may be left out. */
export interface VideoOptions {
  /** Without it MP4, or WebM where the browser has no encoder for MP4. */
  format?: VideoFormat;
  /** Width to height; 16:9 when left out. */
  aspect?: VideoAspect;
  /** Pixels along the shorter edge: 180, 360, 720 (when left out), 1080, 1440 or 2160. */
  size?: number;
  /** Frames per second: 30 (when left out) or 60; the pose of every frame is worked out for its own time. */
  fps?: number;
  /**
   * `follow` (when left out) goes along with the dancer, `front` stands still, `orbit` circles, `cuts` changes the shot on bars, `stage`
   * looks from where the visitor does.
   */
  camera?: VideoCamera;
  /** The stage with its floor (when left out), or one colour as `#rrggbb`. */
  background?: string;
  /**
   * What of the dance: all of it, the part that the song is trimmed to, the selected stretch (the loop), or seconds of the song. Without
   * it, the trimmed part, or all where nothing is trimmed.
   */
  range?: 'all' | 'trim' | 'loop' | TimeRange;
  /** With the song's sound; true when left out. */
  sound?: boolean;
}

/** Options with nothing left open but the format. */
export interface VideoSettings {
  format: VideoFormat | null;
  aspect: VideoAspect;
  size: number;
  fps: number;
  camera: VideoCamera;
  background: string;
  sound: boolean;
}

/** Which moments of the song the frames show: frame i is at `start + i / fps` seconds. */
export interface FramePlan {
  /** Seconds of the song. */
  start: number;
  fps: number;
  frames: number;
}

const oneOf = <T>(name: string, value: T, known: readonly T[]): T => {
  if (known.includes(value)) return value;
  const list = known.map((each) => JSON.stringify(each)).join(', ');
  throw new Error(`${name} must be one of ${list}.`);
};

/**
 * Fills in what was left out.
 * @throws Error that names the first option that cannot be and what it can be
 */
export function videoSettings(options: VideoOptions): VideoSettings {
  const { format, aspect = '16:9', size = 720, fps = 30, camera = 'follow', background = 'stage' } = options;
  if (background !== 'stage' && !/^#[0-9a-f]{6}$/i.test(background)) {
    throw new Error('background must be "stage" or a colour such as "#00b140".');
  }
  return {
    format: format === undefined ? null : oneOf('format', format, VIDEO_FORMATS),
    aspect: oneOf('aspect', aspect, ASPECTS),
    size: oneOf<number>('size', size, VIDEO_SIZES),
    fps: oneOf<number>('fps', fps, VIDEO_RATES),
    camera: oneOf('camera', camera, VIDEO_CAMERAS),
    background,
    sound: options.sound !== false,
  };
}

/** Width and height in pixels, both even, as encoders want them. */
export function videoSize(aspect: VideoAspect, size: number): { width: number; height: number } {
  const [across, down] = aspect.split(':').map(Number);
  const even = (pixels: number) => Math.round(pixels / 2) * 2;
  return across >= down
    ? { width: even((size * across) / down), height: even(size) }
    : { width: even(size), height: even((size * down) / across) };
}

/**
 * The frames of a stretch of the song; one at least.
 * @throws Error when the stretch is longer than a video may be
 */
export function framePlan(range: TimeRange, fps: number): FramePlan {
  const seconds = range.end - range.start;
  if (seconds > LONGEST) throw new Error('A video can be an hour long at most: choose a shorter part.');
  return { start: range.start, fps, frames: Math.max(1, Math.round(seconds * fps)) };
}

/** Seconds of the song that a frame shows. */
export function frameTime({ start, fps }: FramePlan, frame: number): number {
  return start + frame / fps;
}

/** Bits per second of the picture: enough for a figure on a calm ground, whatever the encoder. */
export function videoBitrate(width: number, height: number, fps: number): number {
  // Twice the frames are half as different from one another.
  return Math.max(400_000, Math.round(width * height * (fps > 30 ? 1.5 : 1) * 3.6));
}

/** Bits per second of the sound. */
export const AUDIO_BITRATE = 160_000;

/** About how many bytes a video has. */
export function videoBytes(width: number, height: number, plan: FramePlan, sound: boolean): number {
  const rate = videoBitrate(width, height, plan.fps) + (sound ? AUDIO_BITRATE : 0);
  return (rate * plan.frames) / plan.fps / 8;
}

/** How long the rest takes at the pace so far, seconds; null while there is too little to tell. */
export function timeLeft(elapsed: number, done: number, all: number): number | null {
  return done < 3 || elapsed < 1 ? null : (elapsed / done) * (all - done);
}

/** Cameras of a still picture. */
export const PICTURE_CAMERAS = ['stage', 'follow', 'front'] as const;

/** How a still picture is made; everything may be left out. */
export interface PictureOptions {
  /** Width to height; 16:9 when left out. */
  aspect?: VideoAspect;
  /** Pixels along the shorter edge: 180, 360, 720, 1080 (when left out), 1440 or 2160. */
  size?: number;
  /** `stage` (when left out) looks from where the visitor does, `follow` shows all of the dancer, `front` from the audience's seat. */
  camera?: (typeof PICTURE_CAMERAS)[number];
  /** `stage` with its floor (when left out), `none` for a transparent picture, or one colour as `#rrggbb`. */
  background?: string;
  /** Seconds of the song; without it, where the playhead is. */
  time?: number;
}

/**
 * Fills in what was left out.
 * @throws Error that names the first option that cannot be and what it can be
 */
export function pictureSettings(options: PictureOptions) {
  const { aspect = '16:9', size = 1080, camera = 'stage', background = 'stage', time } = options;
  if (!/^(stage|none|#[0-9a-f]{6})$/i.test(background)) {
    throw new Error('background must be "stage", "none" or a colour such as "#00b140".');
  }
  if (time !== undefined && !(time >= 0 && Number.isFinite(time))) {
    throw new Error('time must be a number of seconds from 0 on.');
  }
  return {
    aspect: oneOf('aspect', aspect, ASPECTS),
    size: oneOf<number>('size', size, VIDEO_SIZES),
    camera: oneOf('camera', camera, PICTURE_CAMERAS),
    background,
    time,
  };
}
