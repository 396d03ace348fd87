/** The drawing of pictures, fetched when somebody wants one. */
import type { PictureCall } from './protocol';

/** As `drawInWorker` of the video client. */
export async function drawInWorkerLater(
  call: PictureCall,
  progress: (done: number) => void,
  signal: AbortSignal,
): Promise<Blob> {
  const { drawInWorker } = await import('./video-client');
  return drawInWorker(call, progress, signal);
}
