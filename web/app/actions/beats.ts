/** The beat grid in the visitor's hands: tap, nudge, halve, double, bars, single beats, the click. */
import { effect } from '@preact/signals';
import { Metronome } from '../../audio/metronome';
import type { ProjectDocument } from '../../core/document';
import {
  deleteBeat,
  doubleGrid,
  firstBar,
  halveGrid,
  insertBeat,
  moveBeat,
  setBarOne,
  setMeter,
  setTempo,
  shiftGrid,
} from '../../core/grid-edit';
import { followBeats, rippleKeys, rippleRanges, type Warp } from '../../core/grid-ripple';
import { nearestIndex } from '../../core/snap';
import spec from '../../core/spec.json';
import type { BeatGrid } from '../../core/types';
import type { Context } from '../context';
import { curvesOnGrid } from './curves';

/** After other beats the report is measured anew, once nothing moved for so long, milliseconds. */
const MEASURE_DELAY = 400;
/** Moments stay where they are in the music: the same beats are only counted otherwise. */
const STAY: Warp = (time) => time;

/** How far beats are nudged, seconds: about what an ear tells apart, and a picture. */
export const NUDGE = { fine: 0.01, frame: 1 / spec.fps } as const;
/** A step of nudging. */
export type NudgeUnit = keyof typeof NUDGE;

/** Actions on the beat grid. */
export function beatActions(context: Context, measureShown: () => Promise<void>) {
  const { state, services, history } = context;
  const metronome = new Metronome(services.player);
  let dragged: { document: ProjectDocument; grid: BeatGrid; index: number } | null = null;

  effect(() => metronome.follow(state.grid.value));
  measureOnChange();

  /** The report follows the visitor's own beats, undone ones too; a new song brings its own report. */
  function measureOnChange(): void {
    let seen: { hash?: string; grid: BeatGrid | null } = { grid: null };
    let timer: ReturnType<typeof setTimeout> | undefined;
    effect(() => {
      const hash = state.song.value?.reference.hash;
      const { grid } = state.document.value;
      const changed = hash === seen.hash && grid !== seen.grid;
      seen = { hash, grid };
      if (!changed) return;
      clearTimeout(timer);
      timer = setTimeout(() => {
        if (state.report.peek()) void measureShown();
      }, MEASURE_DELAY);
    });
  }

  /** The beats to work on; null, with a word why, while the song is not there yet. */
  const current = (): BeatGrid | null => {
    if (state.song.value?.complete && state.grid.value) return state.grid.value;
    context.notify('info', state.song.value ? 'The beats are still being found: a moment.' : 'Drop a song first.');
    return null;
  };

  const onGrid = (from: ProjectDocument, grid: BeatGrid | null, warp: Warp): ProjectDocument => {
    const heard = state.song.value?.grid ?? null;
    const document = curvesOnGrid(from, from.grid ?? heard, warp, grid ?? heard);
    if (!state.ripple.value || warp === STAY) return { ...document, grid };
    const duration = state.duration.value;
    return {
      ...document,
      grid,
      keyPoses: rippleKeys(document.keyPoses, warp, duration),
      ranges: rippleRanges(document.ranges, warp, duration),
    };
  };

  const say = (grid: BeatGrid | null) =>
    grid && context.announce(`${Math.round(grid.tempo * 10) / 10} beats per minute, ${grid.beatsPerBar} in a bar.`);

  /**
   * Other beats: one step of undo.
   * @param grid - null = as analysed.
   * @param warp - Where moments go that were placed on the former beats; left out, they stay on their beats, counted from bar 1.
   */
  const setGrid = (label: string, grid: BeatGrid | null, warp?: Warp): void => {
    const before = state.grid.value;
    const after = grid ?? state.song.value?.grid ?? null;
    if (before === after) return;
    const anchor = after?.beats[firstBar(after)] ?? 0;
    const move = warp ?? (before && after ? followBeats(before, after, anchor) : STAY);
    context.change(label, (document) => onGrid(document, grid, move));
    say(after);
  };

  /** One tool: nothing happens where it gives the same grid back. Returns whether it did something. */
  const apply = (label: string, edit: (grid: BeatGrid) => BeatGrid, warp?: Warp): boolean => {
    const grid = current();
    if (!grid) return false;
    const next = edit(grid);
    if (next === grid) return false;
    setGrid(label, next, warp);
    return true;
  };

  const moved = (grid: BeatGrid, index: number, time: number, rest: boolean) => {
    const next = moveBeat(grid, index, time, rest, state.duration.value);
    const by = (next.beats[index] ?? grid.beats[index]) - grid.beats[index];
    const from = grid.beats[index];
    // With the rest shifted, all behind the beat goes along; what lies before it is stretched up to it.
    const follow = followBeats(grid, next, grid.beats[0]);
    const warp: Warp = (at) => (rest && at >= from ? at + by : follow(at));
    return { next, warp };
  };

  return {
    setGrid,

    /** All beats 10 ms or one frame earlier (-1) or later (1). */
    nudgeBeats(direction: -1 | 1, unit: NudgeUnit): void {
      const seconds = direction * NUDGE[unit];
      const moves = (grid: BeatGrid) => shiftGrid(grid, seconds, state.duration.value);
      if (!apply('Shift beats', moves, (time) => time + seconds)) return;
      context.announce(`Beats ${Math.round(NUDGE[unit] * 1000)} milliseconds ${direction < 0 ? 'earlier' : 'later'}.`);
    },

    /** Half as many beats. */
    halveBeats(): void {
      if (!apply('Halve tempo', halveGrid, STAY) && state.grid.value) context.announce('The tempo cannot be halved.');
    },

    /** Twice as many beats. */
    doubleBeats(): void {
      if (!apply('Double tempo', doubleGrid, STAY) && state.grid.value)
        context.announce('The tempo cannot be doubled.');
    },

    /** Even beats at a tempo; bar 1 stays. */
    setTempo(tempo: number): void {
      const grid = current();
      if (!grid || !(tempo > 0) || Math.abs(tempo - grid.tempo) < 0.005) return;
      apply('Set tempo', () => setTempo(grid, tempo, state.duration.value));
    },

    /** Bars begin on this beat; without an index on the one nearest to the playhead. */
    setBarOne(index?: number): void {
      apply(
        'Set bar 1',
        (grid) => {
          const beat = index ?? nearestIndex(grid.beats, state.time.value);
          return beat in grid.beats ? setBarOne(grid, beat) : grid;
        },
        STAY,
      );
    },

    /** Three or four beats in a bar. */
    setMeter(beatsPerBar: 3 | 4): void {
      if (state.grid.value?.beatsPerBar === beatsPerBar) return;
      apply(`Set ${beatsPerBar}/4`, (grid) => setMeter(grid, beatsPerBar), STAY);
    },

    /** A missed beat, at a time or the playhead. */
    insertBeat(time = state.time.value): void {
      apply('Add beat', (grid) => insertBeat(grid, time), STAY);
    },

    /** One beat less. */
    deleteBeat(index: number): void {
      apply('Delete beat', (grid) => deleteBeat(grid, index), STAY);
    },

    /** The beats as analysed. */
    resetBeats(): void {
      if (state.document.value.grid && current()) setGrid('Beats as analysed', null);
    },

    /** Moves one beat by seconds; with `rest` all later ones too. */
    nudgeBeat(index: number, seconds: number, rest = false): void {
      const grid = current();
      if (!grid || !(index in grid.beats)) return;
      const { next, warp } = moved(grid, index, grid.beats[index] + seconds, rest);
      if (next === grid) return;
      context.change('Move beat', (document) => onGrid(document, next, warp));
      context.announce(`Beat at ${next.beats[index].toFixed(2)} seconds.`);
    },

    /** A drag of one beat begins. Returns false when there is nothing to drag. */
    beginBeatDrag(index: number): boolean {
      const grid = current();
      if (!grid || !(index in grid.beats)) return false;
      dragged = { document: history.present, grid, index };
      history.capture();
      return true;
    },

    /** The dragged beat at a time, seconds; with `rest` all later ones along. */
    previewBeatDrag(time: number, rest: boolean): void {
      if (!dragged || !history.capturing) return;
      const { next, warp } = moved(dragged.grid, dragged.index, time, rest);
      history.preview(next === dragged.grid ? dragged.document : onGrid(dragged.document, next, warp));
      context.sync();
    },

    /** The drag ends where it is: one step of undo. */
    commitBeatDrag(): void {
      if (!dragged) return;
      if (history.present === dragged.document) history.discard();
      else history.commit('Move beat');
      dragged = null;
      context.sync();
    },

    /** The drag never happened. */
    discardBeatDrag(): void {
      if (!dragged) return;
      dragged = null;
      history.discard();
      context.sync();
    },

    /** Key poses go with the beats, or stay at their times. */
    toggleRipple: (on = !state.ripple.value) => (state.ripple.value = on),

    /** A click on every beat, to hear whether they fit. */
    toggleMetronome(on = !state.metronome.value): void {
      state.metronome.value = on;
      metronome.set(on);
      if (on && services.player.muted) context.notify('info', 'The sound is off: turn it on to hear the click.');
      context.announce(on ? 'Click on.' : 'Click off.');
    },
  };
}

/** Actions on the beat grid. */
export type BeatActions = ReturnType<typeof beatActions>;
