import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { clicksBetween, Metronome } from '../../web/audio/metronome';
import type { Player, Score } from '../../web/audio/player';
import { passes, positionAt, type Segment } from '../../web/audio/segment';
import { evenGrid } from '../../web/core/grid-edit';

const segment = (change: Partial<Segment> = {}): Segment => ({
  clock: 'audio',
  from: 10,
  position: 3,
  rate: 1,
  loop: null,
  end: 60,
  ...change,
});
const grid = evenGrid(0.5, 0, 4, 60);

describe('passes', () => {
  it('are the stretch that is played, cut to its beginning and to the end of the song', () => {
    expect(passes(segment(), 9, 12)).toEqual([{ start: 3, end: 5, at: 10 }]);
    expect(passes(segment({ rate: 0.5 }), 12, 14)).toEqual([{ start: 4, end: 5, at: 12 }]);
    expect(passes(segment({ position: 58 }), 11, 15)).toEqual([{ start: 59, end: 60, at: 11 }]);
    expect(passes(segment({ position: 58 }), 13, 15)).toEqual([]);
  });
  it('go round a loop', () => {
    const looped = segment({ position: 5, loop: { start: 4, end: 6 } });
    expect(passes(looped, 10, 14)).toEqual([
      { start: 5, end: 6, at: 10 },
      { start: 4, end: 6, at: 11 },
      { start: 4, end: 5, at: 13 },
    ]);
    expect(passes(looped, 112, 113)).toEqual([{ start: 5, end: 6, at: 112 }]);
  });
  it('agree with the position of the player at every moment', () => {
    for (const loop of [null, { start: 2.5, end: 4 }, { start: 5, end: 7.3 }]) {
      for (const rate of [0.25, 1, 1.5]) {
        const played = segment({ loop, rate });
        for (const { start, end, at } of passes(played, 12, 22)) {
          expect(positionAt(played, at + 1e-6)).toBeCloseTo(start, 4);
          expect(positionAt(played, at + (end - start) / rate - 1e-6)).toBeCloseTo(end, 4);
        }
      }
    }
  });
});

describe('clicksBetween', () => {
  it('gives every beat its time on the clock, and bars an accent', () => {
    expect(clicksBetween(grid, segment(), 10, 12)).toEqual([
      { at: 10, accent: false },
      { at: 10.5, accent: false },
      { at: 11, accent: true },
      { at: 11.5, accent: false },
    ]);
  });
  it('gives each beat once when asked piece by piece, also slowly and around a loop', () => {
    const looped = segment({ rate: 0.75, loop: { start: 2, end: 4 } });
    const whole = clicksBetween(grid, looped, 10, 20);
    const pieces: typeof whole = [];
    for (let i = 0; i < 100; i += 1) pieces.push(...clicksBetween(grid, looped, 10 + i / 10, 10 + (i + 1) / 10));
    expect(pieces.map(({ at }) => at.toFixed(6))).toEqual(whole.map(({ at }) => at.toFixed(6)));
    expect(whole).toHaveLength(15);
  });
});

describe('Metronome', () => {
  let now = 0;
  let current: Segment | null = null;
  let sounded: { start: number; stopped: number }[] = [];
  let changed: () => void = () => undefined;
  const context = {
    get currentTime() {
      return now;
    },
    createGain: () => ({
      gain: { setValueAtTime: () => 0, exponentialRampToValueAtTime: () => 0 },
      connect: (next: unknown) => next,
      disconnect: () => undefined,
    }),
    createOscillator: () => {
      const click = { start: 0, stopped: Infinity };
      sounded.push(click);
      return {
        frequency: { value: 0 },
        connect: (next: unknown) => next,
        start: (at: number) => (click.start = at),
        stop: (at = now) => (click.stopped = at),
      };
    },
  };
  const player = {
    get score() {
      return current && ({ context, output: {}, segment: current } as unknown as Score);
    },
    onChange: (listener: () => void) => {
      changed = listener;
      return () => (changed = () => undefined);
    },
  } as unknown as Player;
  /** Clicks that were not taken back before they sounded. */
  const heard = () =>
    sounded.filter(({ start, stopped }) => stopped > start).map(({ start }) => Number(start.toFixed(6)));
  const run = (seconds: number) => {
    for (let i = 0; i < Math.round(seconds * 50); i += 1) {
      now += 0.02;
      vi.advanceTimersByTime(20);
    }
  };

  beforeEach(() => {
    vi.useFakeTimers();
    now = 10;
    sounded = [];
    current = segment();
  });
  afterEach(() => vi.useRealTimers());

  it('clicks once on every beat and is silent when switched off', () => {
    const metronome = new Metronome(player);
    metronome.follow(grid);
    metronome.set(true);
    run(2.2);
    metronome.set(false);
    run(2);
    expect(heard()).toEqual([10, 10.5, 11, 11.5, 12]);
  });
  it('takes back what it laid when the song jumps, and follows', () => {
    const metronome = new Metronome(player);
    metronome.follow(grid);
    metronome.set(true);
    run(0.4);
    current = segment({ from: now + 0.02, position: 20.25 });
    changed();
    run(1);
    metronome.set(false);
    expect(heard()).toEqual([10, 10.67, 11.17]);
  });
  it('follows other beats at once', () => {
    const metronome = new Metronome(player);
    metronome.follow(grid);
    metronome.set(true);
    run(0.4);
    metronome.follow(evenGrid(0.5, 0.2, 4, 60));
    run(0.5);
    metronome.set(false);
    expect(heard()).toEqual([10, 10.7]);
  });
  it('says nothing while the song is paused or without beats', () => {
    const metronome = new Metronome(player);
    metronome.follow(null);
    metronome.set(true);
    run(1);
    metronome.follow(grid);
    current = null;
    sounded = [];
    run(1);
    expect(heard()).toEqual([]);
  });
});
