import { afterEach, describe, expect, it, vi } from 'vitest';
import { createStore } from '../../web/app/store';
import { Player } from '../../web/audio/player';
import { evenGrid } from '../../web/core/grid-edit';
import { withGrid } from '../../web/core/features';
import type { DanceRequest, Services } from './support/app';
import { fakeReport, fakeReporter, fakeServices, settled, SONG_SECONDS } from './support/app';

const pose = (value = 0.1) => new Array<number>(72).fill(value);

async function withSong(change: (services: Services) => void = () => undefined) {
  const clock = { now: 0 };
  const player = new Player(
    () => ({}) as AudioContext,
    () => clock.now,
  );
  player.setMuted(true);
  const services = fakeServices(player);
  change(services);
  const reporter = fakeReporter();
  const measure = vi.spyOn(reporter, 'measure');
  const store = createStore(services, reporter);
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  const times = () => store.state.document.value.keyPoses.map(({ time }) => time);
  const beats = () => store.state.grid.value!.beats;
  return { store, services, player, clock, measure, times, beats };
}

afterEach(() => vi.useRealTimers());

describe('changes of the beats', () => {
  it('are one step each, take key poses along, and undo puts both back', async () => {
    const { store, times, beats } = await withSong();
    store.addKey(pose(), 1);
    store.addKey(pose(), 2);
    const before = store.state.document.value;
    store.nudgeBeats(1, 'fine');
    expect(beats().slice(0, 3)).toEqual([0.01, 0.51, 1.01]);
    expect(times()).toEqual([1.01, 2.01]);
    expect(store.state.undoLabel.value).toBe('Shift beats');
    store.undo();
    expect(store.state.document.value).toBe(before);
    expect(beats()[0]).toBe(0);
  });

  it('leave key poses at their times when they are not to go along, and locked ones always', async () => {
    const { store, times } = await withSong();
    store.setKeyPoses([
      { time: 1, rotations: pose() },
      { time: 2, rotations: pose(), locked: true },
    ]);
    store.setTempo(100);
    expect(times()).toEqual([1.2, 2]);
    store.undo();
    store.toggleRipple(false);
    store.setTempo(100);
    expect(times()).toEqual([1, 2]);
  });

  it('that only count the same beats otherwise move nothing', async () => {
    const { store, times } = await withSong();
    store.addKey(pose(), 1.5);
    for (const edit of [store.halveBeats, store.doubleBeats, () => store.setMeter(3), () => store.setBarOne(2)]) edit();
    expect(times()).toEqual([1.5]);
    expect(store.state.grid.value).toMatchObject({ beatsPerBar: 3, tempo: 120 });
  });

  it('set bar 1 on the beat nearest to the playhead', async () => {
    const { store } = await withSong();
    store.seek(0.55);
    store.tick();
    store.setBarOne();
    expect(store.state.grid.value!.downbeats.slice(0, 2)).toEqual([0.5, 2.5]);
  });

  it('are taken back to the analysis in one step, with the key poses', async () => {
    const { store, times } = await withSong();
    store.addKey(pose(), 2);
    store.setTempo(100);
    store.resetBeats();
    expect(store.state.document.value.grid).toBeNull();
    expect(times()).toEqual([2]);
  });

  it('wait for the analysis, and say so', async () => {
    const { store } = await withSong();
    store.state.song.value = { ...store.state.song.value!, complete: false };
    store.nudgeBeats(1, 'fine');
    expect(store.state.document.value.grid).toBeNull();
    expect(store.state.notices.value.at(-1)!.text).toMatch(/still being found/);
  });

  it('make the dance out of date, and the next one is made on them', async () => {
    const { store, services } = await withSong();
    const generate = vi.spyOn(services.engine, 'generate');
    await store.generate();
    expect(store.state.stale.value).toBe(false);
    store.setTempo(100);
    expect(store.state.stale.value).toBe(true);
    await store.generate();
    const request = generate.mock.calls[1][0] as DanceRequest;
    const grid = evenGrid(0.6, 0, 4, SONG_SECONDS);
    expect(request.grid).toEqual(grid);
    const features = store.state.song.value!.features!;
    expect(request.features.data).toEqual(withGrid(features, grid).data);
    expect(store.state.stale.value).toBe(false);
  });

  it('have the report measured against them', async () => {
    const { store, measure } = await withSong();
    await store.generate();
    await settled();
    store.state.report.value = fakeReport;
    vi.useFakeTimers();
    measure.mockClear();
    store.setTempo(100);
    store.nudgeBeats(1, 'fine');
    await vi.advanceTimersByTimeAsync(1000);
    expect(measure).toHaveBeenCalledTimes(1);
    expect(measure.mock.calls[0][2]).toBe(store.state.grid.value);
    store.undo();
    store.undo();
    await vi.advanceTimersByTimeAsync(1000);
    expect(store.state.document.value.grid).toBeNull();
    expect(measure).toHaveBeenCalledTimes(2);
    expect(measure.mock.calls[1][2]).toBe(store.state.song.value!.grid);
  });
});

describe('one beat', () => {
  it('is dragged in one step, and Escape is as if nothing had happened', async () => {
    const { store, times, beats } = await withSong();
    store.addKey(pose(), 2);
    const before = store.state.document.value;
    store.beginBeatDrag(4);
    store.previewBeatDrag(2.2, false);
    expect(beats()[4]).toBe(2.2);
    store.discardBeatDrag();
    expect(store.state.document.value).toBe(before);
    store.beginBeatDrag(4);
    for (const time of [2.05, 2.1, 2.2]) store.previewBeatDrag(time, false);
    store.commitBeatDrag();
    expect(beats().slice(3, 6)).toEqual([1.5, 2.2, 2.5]);
    expect(times()).toEqual([2.2]);
    store.undo();
    expect(store.state.document.value).toBe(before);
  });

  it('takes all later ones along when asked to', async () => {
    const { store, times, beats } = await withSong();
    store.addKey(pose(), 1);
    store.addKey(pose(), 6);
    store.beginBeatDrag(4);
    store.previewBeatDrag(2.2, true);
    store.commitBeatDrag();
    expect(beats().slice(3, 6)).toEqual([1.5, 2.2, 2.7]);
    expect(times()).toEqual([1, 6.2]);
    store.nudgeBeat(4, -0.2, true);
    expect(beats().slice(3, 6)).toEqual([1.5, 2, 2.5]);
    expect(times()).toEqual([1, 6]);
  });

  it('that is clicked and let go is no step', async () => {
    const { store } = await withSong();
    store.beginBeatDrag(4);
    store.commitBeatDrag();
    expect(store.state.undoLabel.value).toBe('New song');
  });
});

describe('tap tempo', () => {
  /** Taps at song times while the song plays. */
  const tap = async (page: Awaited<ReturnType<typeof withSong>>, taps: number[]) => {
    for (const time of taps) {
      page.clock.now += (time - page.player.time()) * 1000;
      page.store.tapTempo();
      await vi.advanceTimersByTimeAsync(100);
    }
  };

  it('first starts a song that stands still, then counts, and ends by itself', async () => {
    const page = await withSong((services) => {
      const heard = services.listener.analyse;
      services.listener.analyse = async (...call) => {
        const analysis = await heard(...call);
        return { ...analysis, grid: evenGrid(1, 0, 4, SONG_SECONDS) };
      };
    });
    const { store, player } = page;
    store.addKey(pose(), 4);
    vi.useFakeTimers();
    store.tapTempo();
    expect(player.playing).toBe(true);
    expect(store.state.tapping.value).toEqual({ times: [], tempo: null });
    await tap(page, [1, 1.5, 2, 2.5, 3]);
    expect(store.state.tapping.value!.times).toHaveLength(5);
    expect(store.state.tapping.value!.tempo).toBeCloseTo(120, 6);
    expect(store.state.document.value.grid).toBeNull();
    await vi.advanceTimersByTimeAsync(2600);
    expect(store.state.tapping.value).toBeNull();
    expect(store.state.grid.value!.tempo).toBe(120);
    expect(store.state.grid.value!.beats[1]).toBe(0.5);
    expect(store.state.undoLabel.value).toBe('Tap tempo');
    expect(page.times()).toEqual([4]);
  });

  it('is cancelled, gives up without taps, and says when there were too few', async () => {
    const page = await withSong();
    const { store } = page;
    vi.useFakeTimers();
    store.tapTempo();
    await tap(page, [1, 1.5, 2, 2.5]);
    store.cancelTaps();
    await vi.advanceTimersByTimeAsync(5000);
    expect(store.state.document.value.grid).toBeNull();
    expect(store.state.notices.value.some(({ text }) => text.includes('Tap'))).toBe(false);
    await tap(page, [3, 3.5]);
    await vi.advanceTimersByTimeAsync(5000);
    expect(store.state.document.value.grid).toBeNull();
    expect(store.state.notices.value.at(-1)!.text).toMatch(/at least 4 times/);
  });

  it('does not count what the page was busy with since the tap', async () => {
    const page = await withSong();
    vi.useFakeTimers();
    page.store.tapTempo();
    await tap(page, [1]);
    page.clock.now += 500;
    page.store.tapTempo(performance.now() - 60);
    expect(page.store.state.tapping.value!.times[1]).toBeCloseTo(1.44, 6);
  });
});

describe('the trim', () => {
  it('is one step, kept inside the song and long enough; the player keeps to it', async () => {
    const { store, player } = await withSong();
    store.setTrim({ start: 2, end: 6 });
    expect(store.state.document.value.trim).toEqual({ start: 2, end: 6 });
    expect(player.bounds).toEqual({ start: 2, end: 6 });
    expect(player.time()).toBe(2);
    store.setTrim({ start: 8, end: 8.5 });
    expect(store.state.document.value.trim).toEqual({ start: 8, end: 10 });
    store.setTrim({ start: -4, end: 99 });
    expect(store.state.document.value.trim).toBeNull();
    expect(player.bounds).toBeNull();
    store.undo();
    expect(player.bounds).toEqual({ start: 8, end: 10 });
  });

  it('is dragged by one end in one step, never past the other', async () => {
    const { store } = await withSong();
    store.setTrim({ start: 2, end: 6 });
    store.beginTrimDrag();
    store.previewTrimDrag('start', 3);
    store.previewTrimDrag('start', 9);
    expect(store.state.document.value.trim).toEqual({ start: 4, end: 6 });
    store.discardTrimDrag();
    expect(store.state.document.value.trim).toEqual({ start: 2, end: 6 });
    store.beginTrimDrag();
    store.previewTrimDrag('end', 10);
    store.commitTrimDrag();
    expect(store.state.document.value.trim).toEqual({ start: 2, end: 10 });
    store.undo();
    expect(store.state.document.value.trim).toEqual({ start: 2, end: 6 });
  });

  it('comes from the loop, which ends with it', async () => {
    const { store, player } = await withSong();
    store.setLoop({ start: 3, end: 7 });
    store.trimToLoop();
    expect(store.state.document.value.trim).toEqual({ start: 3, end: 7 });
    expect(player.loop).toBeNull();
  });

  it('keeps key poses outside it, and steps over them', async () => {
    const { store, player } = await withSong();
    for (const time of [1, 4, 5, 9]) store.addKey(pose(), time);
    store.setTrim({ start: 3, end: 7 });
    expect(store.state.document.value.keyPoses).toHaveLength(4);
    store.seek(3);
    const visited = [1, 2, 3].map(() => {
      store.stepKey(1);
      return player.time();
    });
    expect(visited).toEqual([4, 5, 5]);
  });
});
