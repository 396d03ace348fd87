/** The page's side of the export worker: one worker per file, so that cancelling is ending it. */
import ExportWorker from './export.worker?worker';
import type { MotionFileReply } from './export.worker';
import type { MotionFileRequest } from './motion-formats';

/** Writes motion files; rejects with an AbortError when the signal fires. */
export type MotionFileWriter = (
  request: MotionFileRequest,
  progress: (fraction: number) => void,
  signal: AbortSignal,
) => Promise<Uint8Array<ArrayBuffer>>;

/** Writes a file in a worker of its own. */
export const writeInWorker: MotionFileWriter = async (request, progress, signal) => {
  signal.throwIfAborted();
  const worker = new ExportWorker();
  try {
    return await new Promise<Uint8Array<ArrayBuffer>>((resolve, reject) => {
      worker.onmessage = ({ data }: MessageEvent<MotionFileReply>) => {
        if (data.type === 'progress') progress(data.fraction);
        else if (data.type === 'done') resolve(data.bytes);
        else reject(new Error(data.message));
      };
      worker.onerror = (event) => {
        event.preventDefault();
        reject(new Error('Writing the file stopped unexpectedly: try again, or choose a shorter part.'));
      };
      signal.addEventListener('abort', () => reject(signal.reason as Error), { once: true });
      worker.postMessage(request);
    });
  } finally {
    worker.terminate();
  }
};
