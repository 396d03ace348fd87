/** Tap tempo: taps are collected while the song plays, and become beats when no more come. */
import { effect } from '@preact/signals';
import { followBeats } from '../../core/grid-ripple';
import { fitTaps, MIN_TAPS, tapGrid } from '../../core/grid-tap';
import type { Context } from '../context';
import type { BeatActions } from './beats';

/** The taps are over when none came for so long, milliseconds; with slow beats, for so many of them. */
const END = { milliseconds: 2500, beats: 2.5 } as const;
/** Somebody who asked for tapping and then does not tap has changed their mind, milliseconds. */
const PATIENCE = 8000;
/** A tap is never dated back further than this, milliseconds: an older stamp is of another clock. */
const LATEST = 1000;

/** Actions on tap tempo. */
export function tapActions(context: Context, beats: BeatActions) {
  const { state, services } = context;
  const { player } = services;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let last = 0;

  /** Another song ends the tapping. */
  let hash: string | undefined;
  effect(() => {
    const now = state.song.value?.reference.hash;
    if (now !== hash) stop();
    hash = now;
  });

  function stop(): void {
    clearTimeout(timer);
    state.tapping.value = null;
  }

  function wait(milliseconds: number, then: () => void): void {
    clearTimeout(timer);
    timer = setTimeout(then, milliseconds);
  }

  function finish(): void {
    const taps = state.tapping.value?.times ?? [];
    stop();
    const song = state.song.value;
    if (!song?.complete || taps.length === 0) return;
    const before = state.grid.value;
    const grid = tapGrid(taps, song.grid, state.duration.value, before?.beatsPerBar);
    if (!grid) {
      context.notify('info', `Tap at least ${MIN_TAPS} times, evenly, along with the song.`);
      return;
    }
    const middle = (Math.min(...taps) + Math.max(...taps)) / 2;
    beats.setGrid('Tap tempo', grid, before ? followBeats(before, grid, middle) : undefined);
  }

  return {
    /**
     * A tap on the beat that is heard now. While the song stands still the first tap only starts it.
     * @param stamp - When the key or pointer went down, `event.timeStamp`: what the page was busy with since does not count.
     */
    tapTempo(stamp = performance.now()): void {
      if (!state.song.value?.complete) {
        context.notify('info', state.song.value ? 'The beats are still being found: a moment.' : 'Drop a song first.');
        return;
      }
      if (!player.playing) {
        player.play();
        state.tapping.value = { times: [], tempo: null };
        last = 0;
        context.announce('Tap on every beat.');
        wait(PATIENCE, stop);
        return;
      }
      const late = Math.min(Math.max(performance.now() - stamp, 0), LATEST);
      const time = player.time() - (late / 1000) * player.speed;
      const times = [...(state.tapping.value?.times ?? []), time];
      const fit = fitTaps(times);
      state.tapping.value = { times, tempo: fit ? 60 / fit.period : null };
      const step = last > 0 ? stamp - last : 0;
      last = stamp;
      if (times.length === 1) context.announce('Tap on every beat.');
      wait(Math.max(END.milliseconds, times.length > 1 ? END.beats * step : 0), finish);
    },

    /** Forgets the taps; the beats stay as they were. */
    cancelTaps: stop,
  };
}
