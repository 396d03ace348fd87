/** Decoder and analyse worker behind the app's own port. */
import { decodeSong } from '../audio/decode';
import { AnalyseClient } from '../workers/analyse-client';
import type { Listener } from './ports';

/** The worker starts with the first song. */
export function createListener(client = new AnalyseClient()): Listener {
  return {
    async decode(bytes, signal) {
      const buffer = await decodeSong(bytes, signal);
      return { buffer, duration: buffer.duration };
    },
    analyse: (buffer, hooks, signal) => client.analyse(buffer, { ...hooks, signal }),
  };
}
