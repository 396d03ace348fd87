import { describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import { motionHash } from '../../web/app/hash';
import { createStore } from '../../web/app/store';
import type { DanceRequest, DanceResult, Services } from './support/app';
import { fakeReporter, fakeServices, settled, SONG_SECONDS } from './support/app';

const pose = (value = 0.1) => new Array<number>(72).fill(value);

async function page(change: (services: Services) => void = () => undefined) {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  change(services);
  const store = createStore(services, fakeReporter());
  await store.start();
  return { store, services };
}

async function withSong(change?: (services: Services) => void) {
  const { store, services } = await page(change);
  await store.loadSong(new File(['song'], 'a.mp3'));
  return { store, services };
}

describe('key poses', () => {
  it('snap to the nearest beat unless placed exactly', async () => {
    const { store } = await withSong();
    store.addKey(pose(), 1.1);
    store.addKey(pose(), 2.3, { exact: true });
    expect(store.state.document.value.keyPoses.map((key) => key.time)).toEqual([1, 2.3]);
  });

  it('move as one step, several at once, and stay selected', async () => {
    const { store } = await withSong();
    const a = store.addKey(pose(), 1);
    const b = store.addKey(pose(0.2), 2);
    store.selectKey(a);
    store.selectKey(b, true);
    store.beginMove();
    for (const seconds of [0.2, 0.4, 0.9]) store.previewMove(seconds, a, false);
    store.commitMove();
    expect(store.state.document.value.keyPoses.map((key) => key.time)).toEqual([2, 3]);
    expect([...store.state.selection.value].sort()).toEqual([a, b].sort());
    store.undo();
    expect(store.state.document.value.keyPoses.map((key) => key.time)).toEqual([1, 2]);
    expect(store.state.undoLabel.value).toBe('Add key pose');
  });

  it('come back untouched when a drag is cancelled, and redo survives it', async () => {
    const { store } = await withSong();
    const a = store.addKey(pose(), 1);
    store.addKey(pose(), 3);
    store.undo();
    const before = store.state.document.value;
    store.selectKey(a);
    store.beginMove();
    store.previewMove(1, a, true);
    store.discardMove();
    expect(store.state.document.value).toBe(before);
    store.selectKey(null);
    store.redo();
    expect(store.state.document.value.keyPoses).toHaveLength(2);
  });

  it('dragged over another one only replace it where they are dropped', async () => {
    const { store } = await withSong();
    const a = store.addKey(pose(), 1);
    store.addKey(pose(0.2), 2);
    store.selectKey(a);
    store.beginMove();
    store.previewMove(1, a, false);
    expect(store.state.document.value.keyPoses).toHaveLength(1);
    store.previewMove(2, a, false);
    store.commitMove();
    expect(store.state.document.value.keyPoses.map((key) => key.time)).toEqual([2, 3]);
  });

  it('nudge by beat and by frame, inside the song', async () => {
    const { store } = await withSong();
    store.addKey(pose(), 0.5);
    store.nudgeKeys(1, 'beat');
    expect(store.state.document.value.keyPoses[0].time).toBe(1);
    store.nudgeKeys(-1, 'frame');
    expect(store.state.document.value.keyPoses[0].time).toBeCloseTo(29 / 30, 9);
    for (let i = 0; i < 40; i += 1) store.nudgeKeys(-1, 'beat');
    expect(store.state.document.value.keyPoses[0].time).toBe(0);
  });

  it('stay as they were when the API gets wrong ones', async () => {
    const { store } = await withSong();
    store.setKeyPoses([{ time: 1, rotations: pose() }]);
    const before = store.state.document.value;
    expect(() => store.setKeyPoses([{ time: SONG_SECONDS + 1, rotations: pose() }])).toThrow(/outside the song/);
    expect(store.state.document.value).toBe(before);
  });
});

describe('songs', () => {
  it('begin an empty timeline, and undo brings the former one back with its song', async () => {
    const { store } = await withSong();
    store.addKey(pose(), 1);
    await store.loadSong(new File(['other song'], 'b.mp3'));
    expect(store.state.document.value.keyPoses).toEqual([]);
    expect(store.state.song.value?.reference.name).toBe('b.mp3');
    store.undo();
    await settled();
    expect(store.state.document.value.keyPoses).toHaveLength(1);
    expect(store.state.song.value?.reference.name).toBe('a.mp3');
    store.redo();
    await settled();
    expect(store.state.song.value?.reference.name).toBe('b.mp3');
  });

  it('keep the key poses when the same song is dropped again', async () => {
    const { store } = await withSong();
    store.addKey(pose(), 1);
    await store.loadSong(new File(['song'], 'a.mp3'));
    expect(store.state.document.value.keyPoses).toHaveLength(1);
  });

  it('that fail in the middle leave everything as it was', async () => {
    const { store, services } = await withSong();
    store.addKey(pose(), 1);
    const before = store.state.document.value;
    const features = store.state.song.value!.features!;
    services.listener.analyse = async (_, hooks) => {
      hooks.onHead?.(features, { tempo: 100, beatsPerBar: 4, beats: [0, 1], downbeats: [0] });
      await settled();
      throw new Error('The song is silent.');
    };
    await expect(store.loadSong(new File(['quiet'], 'quiet.wav'))).rejects.toThrow(
      /“quiet.wav” could not be used. The song is silent/,
    );
    expect(store.state.document.value).toEqual(before);
    expect(store.state.song.value?.reference.name).toBe('a.mp3');
    expect(store.state.songJob.value).toBeNull();
    expect(store.state.undoLabel.value).toBe('Add key pose');
    expect(store.state.redoLabel.value).toBeNull();
  });

  it('that are empty are refused before anything changes', async () => {
    const { store } = await withSong();
    await expect(store.loadSong(new File([], 'nothing.mp3'))).rejects.toThrow(/empty/);
    expect(store.state.song.value?.reference.name).toBe('a.mp3');
  });

  it('give way to a newer one', async () => {
    const { store } = await page();
    const first = store.loadSong(new File(['one'], 'one.mp3'));
    const second = store.loadSong(new File(['two'], 'two.mp3'));
    await expect(first).rejects.toThrow(/Another song/);
    await second;
    expect(store.state.song.value?.reference.name).toBe('two.mp3');
  });
});

describe('dances', () => {
  it('get the document’s poses and dials, overridden by the call', async () => {
    const { store, services } = await withSong();
    const generate = vi.spyOn(services.engine, 'generate');
    store.addKey(pose(), 1);
    store.setDial('variation', 0.7);
    const summary = await store.generate({ keyStrength: 0.5, seed: 9 });
    const request = generate.mock.calls[0][0] as DanceRequest;
    expect(request.options).toEqual({ keyStrength: 0.5, variation: 0.7, seed: 9, cleanFeet: true });
    expect(request.keyPoses).toHaveLength(1);
    expect(request.frames).toBe(Math.ceil(SONG_SECONDS * 30));
    expect(summary).toMatchObject({
      backend: 'wasm',
      model: 'light',
      frames: request.frames,
      milliseconds: 5,
      windows: 1,
    });
    expect(summary.motionHash).toBe(await motionHash(store.state.dance.value!.motion));
    expect(store.state.stale.value).toBe(false);
    store.addKey(pose(), 2);
    expect(store.state.stale.value).toBe(true);
    store.undo();
    expect(store.state.stale.value).toBe(false);
  });

  it('that are cancelled leave the last good one', async () => {
    const { store, services } = await withSong();
    await store.generate();
    const good = store.state.dance.value;
    services.engine.generate = (_, __, signal) =>
      new Promise<DanceResult>((_resolve, reject) => signal.addEventListener('abort', () => reject(signal.reason)));
    const running = store.generate({ seed: 2 });
    await settled();
    expect(store.state.generation.value.status).toBe('running');
    store.cancel();
    await expect(running).rejects.toThrow(/Cancelled/);
    expect(store.state.dance.value).toBe(good);
    expect(store.state.generation.value.status).toBe('idle');
  });

  it('give way to a newer one', async () => {
    const { store } = await withSong();
    const first = store.generate({ seed: 1 });
    const second = store.generate({ seed: 2 });
    await expect(first).rejects.toThrow(/newer dance/);
    await expect(second).resolves.toMatchObject({ windows: 1 });
  });

  it.each([
    [{ engine: 'heavy' as never }, /no engine/],
    [{ keyStrength: 2 }, /0 to 1/],
    [{ seed: 1.5 }, /whole number/],
    [{ backend: 'cuda' as never }, /no backend/],
    [{ range: { start: 3, end: 1 } }, /range/],
  ])('refuse %o', async (call, message) => {
    const { store } = await withSong();
    await expect(store.generate(call)).rejects.toThrow(message);
  });

  it('try to load the model again after a failed download', async () => {
    const { store, services } = await withSong();
    const load = services.engine.load;
    services.engine.load = () => Promise.reject(new Error('The model could not be downloaded.'));
    await expect(store.generate()).rejects.toThrow(/downloaded/);
    services.engine.load = load;
    await expect(store.generate()).resolves.toMatchObject({ model: 'light' });
  });
});

describe('the pose editor', () => {
  it('has an undo of its own and writes one step to the document', async () => {
    const { store } = await withSong();
    const id = store.addKey(pose(), 1);
    store.editKey(id);
    const original = store.state.draft.value!.rotations;
    store.changePose(pose(0.1), 'start');
    store.changePose(pose(0.2), 'change');
    store.changePose(pose(0.3), 'commit');
    store.changePose(pose(0.3), 'start');
    store.changePose(pose(0.3), 'commit'); // a click that turns nothing is no step
    store.setJointDegrees(4, [90, 0, 0]);
    expect(store.state.draft.value!.rotations[12]).toBeCloseTo(Math.PI / 2, 9);
    store.undo();
    expect(store.state.draft.value!.rotations).toEqual(pose(0.3));
    store.undo();
    expect(store.state.draft.value!.rotations).toBe(original);
    store.redo();
    store.keepDraft();
    expect(store.state.document.value.keyPoses[0].rotations).toEqual(pose(0.3));
    store.undo();
    expect(store.state.document.value.keyPoses[0].rotations).toEqual(pose(0.1));
  });
});
