import { analyse } from '../core/features';
import type { Listener } from './ports';

export function createListener(): Listener {
  return {
    async decode(bytes) {
      const buffer = await new OfflineAudioContext(2, 1, 44100).decodeAudioData(bytes);
      return { buffer, duration: buffer.duration };
    },
    async analyse(buffer, hooks) {
      const a = analyse(buffer.getChannelData(0), buffer.sampleRate);
      hooks.onHead?.(a.features, a.grid);
      return { ...a, milliseconds: 0 };
    },
  };
}
