/** Playing, seeking, looping. The player is the clock; the state mirrors it. */
import spec from '../../core/spec.json';
import { lowerBound } from '../snapping';
import type { Context } from '../context';

/** Actions on playback. */
export function playbackActions(context: Context, reveal: (time: number) => void) {
  const { state, services } = context;
  const { player } = services;

  player.onChange(() => {
    state.playing.value = player.playing;
    state.speed.value = player.speed;
    state.loop.value = player.loop;
    state.volume.value = player.volume;
    state.muted.value = player.muted;
    state.time.value = player.time();
  });

  const seek = (time: number) => {
    player.seek(time);
    reveal(player.time());
  };

  return {
    /** Plays or pauses. A press on Play wants to hear something: it ends the demo's silence. */
    togglePlay(): void {
      if (player.playing) player.pause();
      else player.play();
    },
    seek,
    /** Steps whole frames; playback pauses so that the step can be seen. */
    stepFrame(direction: -1 | 1): void {
      player.pause();
      seek((Math.round(player.time() * spec.fps) + direction) / spec.fps);
    },
    /** Goes to the key pose before (-1) or after (1) the playhead and selects it. */
    stepKey(direction: -1 | 1): void {
      const { keyPoses, trim } = state.document.value;
      const keys = trim ? keyPoses.filter(({ time }) => time >= trim.start && time < trim.end) : keyPoses;
      const times = keys.map((key) => key.time);
      const margin = 0.02;
      const now = player.time();
      const index = direction > 0 ? lowerBound(times, now + margin) : lowerBound(times, now - margin) - 1;
      const key = keys[index];
      if (!key) return;
      seek(key.time);
      state.selection.value = new Set([key.id]);
      context.announce(`Key pose ${index + 1} of ${keys.length} at ${key.time.toFixed(2)} seconds.`);
    },
    /** Repeats a stretch; null plays through. */
    setLoop: (range: { start: number; end: number } | null) => player.setLoop(range),
    /** Loop on: the selected key poses' stretch, else four bars around the playhead; loop off. */
    toggleLoop(): void {
      if (player.loop) {
        player.setLoop(null);
        return;
      }
      const { keyPoses } = state.document.value;
      const chosen = keyPoses.filter((key) => state.selection.value.has(key.id));
      if (chosen.length > 1) {
        player.setLoop({ start: chosen[0].time, end: chosen[chosen.length - 1].time });
        return;
      }
      const downbeats = state.grid.value?.downbeats ?? [];
      const bar = Math.max(0, lowerBound(downbeats, player.time() + 1e-3) - 1);
      const start = downbeats[bar] ?? player.time();
      player.setLoop({ start, end: downbeats[bar + 4] ?? Math.min(state.duration.value, start + 8) });
    },
    setSpeed: (speed: number) => player.setSpeed(speed),
    setVolume(volume: number): void {
      player.setVolume(volume);
      if (volume > 0 && player.muted) player.setMuted(false);
    },
    /** Mutes or unmutes; call it in a click, so that the browser lets sound through. */
    toggleMute: () => player.setMuted(!player.muted),
    /** Any click lets sound through that the browser held back. */
    unlock: () => player.unlock(),
    /** Once a frame: the time on screen follows the clock. */
    tick(): number {
      const wasPlaying = player.playing;
      player.tick();
      // The opening demo never leaves an empty stage.
      if (wasPlaying && !player.playing && state.song.value?.demo) player.play();
      const time = player.time();
      state.time.value = time;
      return time;
    },
  };
}
