/** Writes one motion file off the main thread. */
import { writeMotionFile } from './motion-file';
import type { MotionFileRequest } from './motion-formats';

/** Worker -> page. */
export type MotionFileReply =
  | { type: 'progress'; fraction: number }
  | { type: 'done'; bytes: Uint8Array<ArrayBuffer> }
  | { type: 'error'; message: string };

const reply = (message: MotionFileReply, transfer: Transferable[] = []) => self.postMessage(message, { transfer });

self.onmessage = async ({ data }: MessageEvent<MotionFileRequest>) => {
  try {
    const bytes = await writeMotionFile(data, (fraction) => reply({ type: 'progress', fraction }));
    reply({ type: 'done', bytes }, [bytes.buffer]);
  } catch (error) {
    reply({ type: 'error', message: error instanceof Error ? error.message : String(error) });
  }
};
