/** The page's side of the video worker: one worker per job. */
import VideoWorker from './video.worker?worker';
import type { VideoFormat } from './options';
import {
  VIDEO_TYPES,
  type EncoderWish,
  type FilmRequest,
  type PictureCall,
  type VideoCall,
  type VideoReply,
  type VideoSupport,
} from './protocol';

/** A finished video. `blob` is missing where it went straight to the disk. */
export interface Film {
  format: VideoFormat;
  blob?: Blob;
}

/** Makes videos. */
export interface Filmer {
  /** What this browser can make. */
  probe(wish: EncoderWish): Promise<VideoSupport>;
  /** Rejects with an AbortError when the signal fires; `file` is then as it was before. */
  film(
    request: FilmRequest,
    file: FileSystemFileHandle | undefined,
    progress: (done: number) => void,
    signal: AbortSignal,
  ): Promise<Film>;
}

/** A cancelled worker that does not answer is ended after this long, milliseconds. */
const PATIENCE = 3000;
const STOPPED = 'Making the video stopped unexpectedly: close other tabs, or choose a smaller size or a shorter part.';

/** Waits for the answer of a worker; progress is no answer. */
function answer(worker: Worker, progress: (done: number) => void): Promise<VideoReply> {
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }: MessageEvent<VideoReply>) => {
      if (data.type === 'progress') progress(data.done);
      else resolve(data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      reject(new Error(STOPPED));
    };
  });
}

/** Makes videos in workers. */
export const filmer: Filmer = {
  async probe(wish) {
    const worker = new VideoWorker();
    try {
      const answered = answer(worker, () => undefined);
      worker.postMessage({ type: 'probe', wish });
      const reply = await answered;
      if (reply.type !== 'support') throw new Error(STOPPED);
      return reply.support;
    } finally {
      worker.terminate();
    }
  },

  async film(request, file, progress, signal) {
    const songs = (request.sound?.channels ?? []).map(({ buffer }) => buffer);
    const reply = await job({ type: 'film', request, file }, songs, progress, signal);
    if (reply.type !== 'done') throw new Error(STOPPED);
    const { format, bytes } = reply;
    return { format, ...(bytes ? { blob: new Blob([bytes], { type: VIDEO_TYPES[format] }) } : {}) };
  },
};

/** Draws pictures in workers. Rejects with an AbortError when the signal fires. */
export async function drawInWorker(
  call: PictureCall,
  progress: (done: number) => void,
  signal: AbortSignal,
): Promise<Blob> {
  const reply = await job(call, [], progress, signal);
  if (reply.type !== 'picture') throw new Error(STOPPED);
  return reply.blob;
}

/** One call, one worker, which is ended after it. */
async function job(
  call: VideoCall,
  transfer: Transferable[],
  progress: (done: number) => void,
  signal: AbortSignal,
): Promise<VideoReply> {
  signal.throwIfAborted();
  const worker = new VideoWorker();
  let patience: ReturnType<typeof setTimeout> | undefined;
  try {
    const reply = await new Promise<VideoReply>((resolve, reject) => {
      answer(worker, progress).then(resolve, reject);
      signal.addEventListener(
        'abort',
        () => {
          // The worker puts the file away itself; one that hangs is not waited for.
          worker.postMessage({ type: 'cancel' });
          patience = setTimeout(() => reject(signal.reason as Error), PATIENCE);
        },
        { once: true },
      );
      worker.postMessage(call, transfer);
    });
    if (reply.type !== 'error') return reply;
    if (signal.aborted) throw signal.reason as Error;
    throw new Error(reply.message);
  } finally {
    clearTimeout(patience);
    worker.terminate();
  }
}
