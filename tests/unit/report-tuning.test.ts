import { describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import type { Reporter } from '../../web/app/report-client';
import { createStore } from '../../web/app/store';
import type { UncorrectedDance } from '../../web/core/finish';
import { emptyMotion } from '../../web/core/motion';
import type { DanceRequest, Services } from './support/app';
import { fakeReport, fakeReporter, fakeServices, settled } from './support/app';

const pose = new Array<number>(72).fill(0.1);

/** A store with a song, two key poses and a dance whose root x is its seed. */
async function danced(change: (services: Services, reporter: Reporter) => void = () => undefined) {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  const reporter = fakeReporter();
  const requests: DanceRequest[] = [];
  services.engine.generate = async (request, _, signal) => {
    requests.push(request);
    await settled();
    signal.throwIfAborted();
    const motion = emptyMotion(request.frames);
    motion.root[0] = request.options.seed;
    const uncorrected: UncorrectedDance = { motion: emptyMotion(request.frames), stretches: [100] };
    return { motion, uncorrected, backend: 'wasm', model: 'light', windows: 1, milliseconds: 5 };
  };
  /** Finishing marks the motion with the strength. */
  const finish = vi.spyOn(reporter, 'finish').mockImplementation(async (dance, { strength }) => {
    await settled();
    const motion = emptyMotion(dance.motion.frames);
    motion.root[1] = strength;
    return { motion, report: { ...fakeReport, jerk: strength } };
  });
  change(services, reporter);
  const store = createStore(services, reporter);
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  store.setKeyPoses([
    { time: 1, rotations: pose },
    { time: 2, rotations: pose },
  ]);
  await store.generate();
  await settled();
  const shown = () => store.state.dance.value!;
  return { store, services, reporter, requests, finish, shown };
}

describe('the key strength', () => {
  it('moves the dance at hand, which is then up to date, and never asks the network', async () => {
    const { store, services, requests, finish, shown } = await danced();
    const saved = vi.spyOn(services.storage, 'saveDance');
    store.commitStrength(0.25);
    await settled();
    await settled();
    expect(shown().motion.root[1]).toBe(0.25);
    expect(shown().keyStrength).toBe(0.25);
    expect(store.state.report.value?.jerk).toBe(0.25);
    expect(store.state.stale.value).toBe(false);
    expect(requests).toHaveLength(1);
    expect(finish).toHaveBeenCalledTimes(1);
    const { motion, uncorrected } = shown();
    const kept = { hash: expect.any(String) as string, motion, uncorrected, keyStrength: 0.25, byDials: true };
    expect(saved).toHaveBeenLastCalledWith(expect.objectContaining(kept));
  });

  it('follows undo and redo', async () => {
    const { store, shown } = await danced();
    store.commitStrength(0.25);
    await settled();
    await settled();
    store.undo();
    await settled();
    await settled();
    expect(shown().keyStrength).toBe(1);
    store.redo();
    await settled();
    await settled();
    expect(shown().keyStrength).toBe(0.25);
  });

  it('shows drafts while it is dragged and is one step of undo', async () => {
    const { store, reporter, shown } = await danced();
    const draft = emptyMotion(shown().motion.frames);
    draft.root[2] = 7;
    const spy = vi.spyOn(reporter, 'finish').mockImplementation(async (_, { onDraft }) => {
      onDraft?.(draft);
      return new Promise(() => undefined);
    });
    store.previewStrength(0.9);
    store.previewStrength(0.8);
    await settled();
    expect(spy.mock.calls.map(([, { strength, near }]) => [strength, near])).toEqual([
      [0.9, 0],
      [0.8, 0],
    ]);
    expect(store.state.strengthDraft.value).toBe(0.8);
    expect(shown().motion).toBe(draft);
    expect(store.state.document.value.dials.keyStrength).toBe(1);
    store.commitStrength(0.8);
    expect(store.state.strengthDraft.value).toBeNull();
    store.undo();
    expect(store.state.document.value.dials.keyStrength).toBe(1);
  });

  it('of a call that names another one stays as called until the dial moves', async () => {
    const { store, finish, shown } = await danced();
    await store.generate({ keyStrength: 0 });
    await settled();
    expect(shown().keyStrength).toBe(0);
    expect(finish).not.toHaveBeenCalled();
    store.commitStrength(0.5);
    await settled();
    await settled();
    expect(shown().keyStrength).toBe(0.5);
  });

  it('of a dance without its uncorrected form waits for Generate', async () => {
    const { store, finish } = await danced((services) => {
      services.engine.generate = async (request) => ({
        motion: emptyMotion(request.frames),
        backend: 'wasm',
        model: 'light',
        windows: 1,
        milliseconds: 1,
      });
    });
    store.commitStrength(0.5);
    await settled();
    expect(finish).not.toHaveBeenCalled();
    expect(store.state.stale.value).toBe(true);
  });

  it('that moved while the dance was made is caught up with', async () => {
    const { store, finish, shown } = await danced();
    store.setDial('seed', 5);
    const made = store.generate();
    store.setDial('keyStrength', 0.5);
    await made;
    await settled();
    await settled();
    expect(finish).toHaveBeenCalled();
    expect(shown().keyStrength).toBe(0.5);
  });
});

describe('takes', () => {
  it('are made once, and come back by number, by undo and at the strength of now', async () => {
    const { store, requests, shown } = await danced();
    await store.showTake(2);
    expect(requests.map(({ options }) => options.seed)).toEqual([1, 2]);
    expect(shown().motion.root[0]).toBe(2);
    await store.showTake(1);
    await settled();
    expect(shown().motion.root[0]).toBe(1);
    expect(requests).toHaveLength(2);
    store.undo();
    await settled();
    expect(shown().motion.root[0]).toBe(2);
    store.commitStrength(0.5);
    await settled();
    await settled();
    await store.showTake(1);
    await settled();
    await settled();
    expect([shown().keyStrength, shown().motion.root[1]]).toEqual([0.5, 0.5]);
    expect(requests).toHaveLength(2);
  });

  it('of other key poses are other takes, and undo of a key pose brings the former dance back', async () => {
    const { store, requests, shown } = await danced();
    store.addKey(pose, 4);
    await store.generate();
    const second = shown();
    store.undo();
    await settled();
    expect(shown()).not.toBe(second);
    expect(store.state.stale.value).toBe(false);
    await store.showTake(3);
    expect(requests).toHaveLength(3);
  });
});

describe('the trade-off plot', () => {
  it('is worked out once a dance, in the order of strength', async () => {
    const { store, reporter, shown } = await danced();
    const plot = vi.spyOn(reporter, 'plot').mockImplementation(async (_, strengths, onPoint) => {
      for (const strength of strengths) onPoint({ strength, error: 1 - strength, jerk: 100 });
    });
    await store.plotTradeOff();
    await store.plotTradeOff();
    expect(plot).toHaveBeenCalledTimes(1);
    const { of, points, complete } = store.state.tradeOff.value!;
    expect(of).toBe(shown().uncorrected);
    expect(complete).toBe(true);
    expect(points.map(({ strength }) => strength)).toEqual([0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1]);
    store.setKeyPoses([]);
    await store.generate();
    await store.plotTradeOff();
    expect(store.state.tradeOff.value).toBeNull();
  });
});

describe('a second dance for the picture', () => {
  it('is of the stretch and its lead alone, and leaves document and dance as they are', async () => {
    const { store, services, requests, shown } = await danced();
    services.assets.seeds = async () => [];
    const before = [store.state.document.value, shown()];
    const clip = store.state.seeds.value[0];
    const made = await store.secondDance({ start: 6, end: 8 }, clip.id, () => undefined, new AbortController().signal);
    expect(made.frames).toBe(60);
    const request = requests.at(-1)!;
    expect(request.frames).toBe(210); // 4 s before, 2 s of it, 1 s after
    expect(request.keyPoses.map(({ time }) => time)).toEqual([0]);
    expect(request.features.frames).toBe(210);
    expect([store.state.document.value, shown()]).toEqual(before);
  });

  it('gives way to a dance of the visitor', async () => {
    const { store } = await danced();
    const clip = store.state.seeds.value[0];
    const second = store.secondDance({ start: 2, end: 8 }, clip.id, () => undefined, new AbortController().signal);
    const stopped = expect(second).rejects.toThrow(/stopped for the new dance/);
    await store.generate();
    await stopped;
  });
});
