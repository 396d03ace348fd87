/** The dance as a video with the song. Only reads the project: whatever happens here, it stays as it is. */
import type { TimeRange } from '../../core/document';
import { isAbort, messageOf, type Context } from '../context';
import { fileName, saveFile } from '../download';
import { dancerOf } from '../on-stage';
import {
  framePlan,
  timeLeft,
  videoSettings,
  videoSize,
  type FramePlan,
  type VideoFormat,
  type VideoOptions,
  type VideoSettings,
} from '../../video/options';
import { soundOf } from '../../video/sound';
import type { EncoderWish, VideoSupport } from '../../video/protocol';
import type { Film, Filmer } from '../../video/video-client';

/** A video call: what is made, and how its maker hears of it. */
export interface VideoCallOptions extends VideoOptions {
  /** 0..1, as frames are done. */
  onProgress?: (fraction: number) => void;
  /** Stops the video; the call is rejected with an AbortError. */
  signal?: AbortSignal;
}

/** What the video panel makes: a video, a still picture, a contact sheet of the key poses. */
export type VideoTab = 'video' | 'picture' | 'keys';

/** A video in the making. */
export interface VideoJob {
  /** Frames done, and all of them. */
  done: number;
  frames: number;
  /** Seconds; null while it cannot be told. */
  left: number | null;
}

type SavePicker = (options: {
  suggestedName: string;
  types: { description: string; accept: Record<string, string[]> }[];
}) => Promise<FileSystemFileHandle>;

const inWorker: Filmer = {
  probe: async (...call) => (await import('../../video/video-client')).filmer.probe(...call),
  film: async (...call) => (await import('../../video/video-client')).filmer.film(...call),
};

/**
 * Asks where the video shall go, so that a long one needs no memory. Has to be called in the click itself.
 * @returns null where the browser cannot ask, or may not here
 * @throws AbortError when the visitor closes the question
 */
async function askForFile(name: string, format: VideoFormat): Promise<FileSystemFileHandle | null> {
  const ask = (globalThis as { showSaveFilePicker?: SavePicker }).showSaveFilePicker;
  if (!ask) return null;
  try {
    return await ask({
      suggestedName: name,
      types: [
        {
          description: format === 'mp4' ? 'MP4 video' : 'WebM video',
          accept: { [`video/${format}`]: [`.${format}`] },
        },
      ],
    });
  } catch (error) {
    if (isAbort(error)) throw error;
    return null;
  }
}

/** Actions on videos. */
export function videoActions(context: Context) {
  const { state, services } = context;
  const filmer = services.filmer ?? inWorker;
  let running: AbortController | null = null;

  const shown = () => {
    const dance = state.onStage.value;
    if (!dance || dance.kind === 'preview') {
      throw new Error('There is no dance yet: drop a song and press Generate, then save it as a video.');
    }
    return dance;
  };

  /** Seconds of the song that a wish for a part means. */
  const rangeOf = (wish: VideoOptions['range']): TimeRange => {
    const { motion } = shown();
    const end = Math.min(state.duration.value || Infinity, motion.frames / motion.fps);
    const { trim } = state.document.value;
    if (wish === 'all' || (wish === undefined && !trim)) return { start: 0, end };
    if (wish === 'trim' && !trim) throw new Error('The song is not trimmed: make a video of all of the dance.');
    const range = wish === 'trim' || wish === undefined ? trim : wish === 'loop' ? state.loop.value : wish;
    if (!range) throw new Error('No stretch is selected: drag one on the timeline’s beats first.');
    if (!(range.start >= 0 && range.end > range.start && range.start < end)) {
      throw new Error(`range must be {start, end} in seconds inside the dance (0 to ${end.toFixed(2)}).`);
    }
    return { start: range.start, end: Math.min(range.end, end) };
  };

  const planOf = (settings: VideoSettings, range: VideoOptions['range']): FramePlan =>
    framePlan(rangeOf(range), settings.fps);

  const wishOf = ({ aspect, size, fps, sound }: VideoSettings): EncoderWish => {
    const buffer = sound ? state.song.value?.buffer : null;
    const heard = buffer && { sampleRate: buffer.sampleRate, channels: Math.min(2, buffer.numberOfChannels) };
    return { ...videoSize(aspect, size), fps, ...(heard ? { sound: heard } : {}) };
  };

  async function make(options: VideoCallOptions, file?: FileSystemFileHandle): Promise<Film> {
    const settings = videoSettings(options);
    const plan = planOf(settings, options.range);
    const { motion } = shown();
    const song = state.song.value;
    if (settings.sound && song && !song.buffer) {
      throw new Error(
        `The sound of “${song.reference.name}” is not here yet: wait for it, or make the video without sound.`,
      );
    }
    running?.abort(new DOMException('Another video was asked for.', 'AbortError'));
    const own = (running = new AbortController());
    const signal = options.signal ? AbortSignal.any([own.signal, options.signal]) : own.signal;
    const began = performance.now();
    const job = (done: number) => {
      if (running !== own) return;
      const left = timeLeft((performance.now() - began) / 1000, done, plan.frames);
      state.videoJob.value = { done, frames: plan.frames, left };
      options.onProgress?.(done / plan.frames);
    };
    job(0);
    try {
      return await filmer.film(
        {
          motion,
          plan,
          ...videoSize(settings.aspect, settings.size),
          camera: settings.camera,
          background: settings.background,
          view: state.document.value.camera,
          ...dancerOf(state, state.document.value),
          grid: state.grid.value,
          sound: settings.sound && song?.buffer ? soundOf(song.buffer, plan) : null,
          format: settings.format,
          title: song?.reference.name ?? 'Dance',
        },
        file,
        job,
        signal,
      );
    } finally {
      if (running === own) {
        running = null;
        state.videoJob.value = null;
      }
    }
  }

  return {
    /**
     * The dance on stage as a video, drawn frame by frame beside the page.
     * @throws Error with what is wrong and what to do: no dance, an unknown option, no encoder; AbortError when it is stopped
     */
    async exportVideo(options: VideoCallOptions = {}): Promise<Blob> {
      return (await make(options)).blob!;
    },

    /** What this browser can make of these options. */
    videoSupport: (options: VideoOptions): Promise<VideoSupport> => filmer.probe(wishOf(videoSettings(options))),

    /** The frames that a video would have; null when there is no dance or no such part. */
    videoPlan(options: VideoOptions): FramePlan | null {
      try {
        return planOf(videoSettings(options), options.range);
      } catch {
        return null;
      }
    },

    /** Saves the dance as a video for the visitor to keep: straight to the disk where the browser can. What is wrong becomes a notice. */
    async saveVideo(options: VideoOptions & { format: VideoFormat }): Promise<void> {
      const name = fileName(state.document.value.song?.name ?? 'dance', options.format);
      try {
        const file = await askForFile(name, options.format);
        const { blob } = await make(options, file ?? undefined);
        if (blob) saveFile(blob, name);
        context.notify('info', `${file?.name ?? name} is saved.`);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },

    /** Stops the video. */
    cancelVideo(): void {
      if (!running) return;
      running.abort(new DOMException('Cancelled.', 'AbortError'));
      context.announce('The video is cancelled.');
    },

    /** Opens or closes the video panel. */
    toggleVideo(open = !state.videoOpen.value, tab: VideoTab = 'video'): void {
      if (open) state.videoTab.value = tab;
      state.videoOpen.value = open;
    },
  };
}
