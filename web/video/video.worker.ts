/** Films one dance, draws one picture, or tells what could be filmed, off the main thread. */
import { probe } from './codecs';
import { film } from './film';
import { drawPicture } from './pictures';
import type { VideoCall, VideoReply } from './protocol';

const stop = new AbortController();
const reply = (message: VideoReply, transfer: Transferable[] = []) => self.postMessage(message, { transfer });

self.onmessage = async ({ data }: MessageEvent<VideoCall>) => {
  try {
    if (data.type === 'cancel') stop.abort(new DOMException('Cancelled.', 'AbortError'));
    else if (data.type === 'probe') reply({ type: 'support', support: await probe(data.wish) });
    else if (data.type !== 'film') {
      const blob = await drawPicture(data, (done) => reply({ type: 'progress', done }), stop.signal);
      reply({ type: 'picture', blob });
    } else {
      const made = await film(data.request, data.file, (done) => reply({ type: 'progress', done }), stop.signal);
      reply({ type: 'done', ...made }, made.bytes ? [made.bytes] : []);
    }
  } catch (error) {
    const message = error instanceof Error ? error.message : String(error);
    reply({ type: 'error', message, aborted: stop.signal.aborted });
  }
};
