import { describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import { createStore } from '../../web/app/store';
import { createApi } from '../../web/app/api';
import type { Suggester } from '../../web/app/suggester';
import { TIMBRE_SIZE } from '../../web/core/mfcc';
import { poseToQuaternions, quaternionsToSixD } from '../../web/core/rotation';
import { jointIndex } from '../../web/core/skeleton';
import { alternatePoses, suggestPoses, type StepRunner } from '../../web/core/suggest';
import { ROW_SIZE } from '../../web/core/suggest-pose';
import type { SuggestReply } from '../../web/workers/suggest-protocol';
import { SuggestClient } from '../../web/workers/suggest-client';
import { FakeWorker } from './support/worker';
import { fakeReporter, fakeServices, settled } from './support/app';

const pose = (turn: number) => {
  const rotations = new Array<number>(72).fill(0);
  rotations[jointIndex('left_shoulder') * 3 + 2] = turn;
  return rotations;
};
/** A network that raises the left arm by the code that the noise names. */
const network: StepRunner = async ({ noise }) => {
  const batch = noise.dims[0];
  const poses = new Float32Array(batch * ROW_SIZE);
  const codes = Float32Array.from({ length: batch }, (_, i) => {
    const row = noise.data.subarray(i * 512, (i + 1) * 512);
    return row.indexOf(Math.max(...row));
  });
  codes.forEach((code, i) => poses.set(quaternionsToSixD(poseToQuaternions(pose(code / 300 - 1.2))), i * ROW_SIZE));
  return { poses, codes };
};

/** Answers as the worker does, with a breath after every pose. */
function fakeSuggester() {
  const asked: { seed: number; density: string }[] = [];
  const suggester: Suggester = {
    load: vi.fn(async () => undefined),
    async suggest(request, { onLoading, onPoses, signal }) {
      asked.push(request);
      onLoading?.({ fraction: 0.5, bytes: 1, totalBytes: 2, cached: false });
      const run: StepRunner = async (inputs) => {
        await settled();
        signal?.throwIfAborted();
        return network(inputs);
      };
      await suggestPoses(request, run, { signal, onPose: (found, fraction) => onPoses?.([found], fraction) });
      return { backend: 'wasm', model: 'suggest', steps: 1, milliseconds: 1 };
    },
    alternates: (request, key, signal) => alternatePoses(request, key, network, signal),
  };
  return { suggester, asked };
}

async function page() {
  const { suggester, asked } = fakeSuggester();
  const services = { ...fakeServices(new Player(() => ({}) as AudioContext)), suggester };
  const { analyse } = services.listener;
  services.listener.analyse = async (...args) => {
    const heard = await analyse(...args);
    const timbre = Float32Array.from({ length: heard.features.frames * TIMBRE_SIZE }, (_, i) => Math.sin(i * 7.1));
    return { ...heard, features: { ...heard.features, timbre } };
  };
  const store = createStore(services, fakeReporter());
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  const keys = () => store.state.document.value.keyPoses;
  return { store, asked, keys, suggester };
}

describe('suggesting key poses', () => {
  it('fills the timeline as they come, around own key poses, in one step of undo', async () => {
    const { store, keys } = await page();
    store.addKey(pose(0.2), 3);
    store.addKey(pose(0.4), 6);
    store.toggleLock();
    const before = keys();
    const seen: number[] = [];
    const working = store.suggestKeyPoses({ density: 'half' });
    const watch = setInterval(() => seen.push(keys().length), 1);
    const found = await working;
    clearInterval(watch);
    expect(new Set(seen).size).toBeGreaterThan(4);
    // Two in each bar of two seconds; 3 s and 6 s are taken.
    expect(found.map(({ time }) => time)).toEqual([0, 1, 2, 4, 5, 7, 8, 9]);
    expect(keys().map(({ time }) => time)).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
    for (const own of before) expect(keys()).toContain(own);
    expect(keys().filter(({ suggested }) => suggested)).toHaveLength(8);
    expect(new Set(keys().map(({ id }) => id)).size).toBe(10);
    expect(store.state.undoLabel.value).toBe('Suggest key poses');
    store.undo();
    expect(keys()).toEqual(before);
    store.redo();
    expect(keys()).toHaveLength(10);
  });

  it('puts new suggestions in the place of old ones, but not of those that were edited since', async () => {
    const { store, keys } = await page();
    const first = await store.suggestKeyPoses({ density: 'beat' });
    const edited = first[4];
    store.updateKey(edited.id, pose(0.9));
    await store.suggestKeyPoses({ density: 'bar', seed: 5 });
    expect(keys().filter(({ suggested }) => !suggested)).toHaveLength(1);
    expect(keys().find(({ time }) => time === edited.time)?.rotations).toEqual(pose(0.9));
    expect(keys().map(({ time }) => time)).toEqual([0, 2, 4, 6, 8]);
  });

  it('keeps to a range, and leaves the suggestions outside it', async () => {
    const { store, keys } = await page();
    await store.suggestKeyPoses({ density: 'bar' });
    const outside = keys().filter(({ time }) => time < 4);
    await store.suggestKeyPoses({ density: 'beat', range: { start: 4, end: 5.9 }, seed: 9 });
    expect(keys().filter(({ time }) => time < 4)).toEqual(outside);
    expect(keys().map(({ time }) => time)).toEqual([0, 2, 4, 4.5, 5, 5.5, 6, 8]);
  });

  it('goes back to what was there when it is stopped', async () => {
    const { store, keys } = await page();
    store.addKey(pose(0.2), 3);
    const before = keys();
    const working = store.suggestKeyPoses({ density: 'beat' });
    await vi.waitFor(() => expect(keys().length).toBeGreaterThan(3));
    expect(store.state.suggestion.value.status).toBe('running');
    store.cancelSuggestion();
    await expect(working).rejects.toMatchObject({ name: 'AbortError' });
    expect(keys()).toEqual(before);
    expect(store.state.suggestion.value.status).toBe('idle');
    expect(store.state.undoLabel.value).toBe('Add key pose');
  });

  it('stops where the visitor goes on by hand or takes it back', async () => {
    for (const act of ['add', 'undo'] as const) {
      const { store, keys } = await page();
      const working = store.suggestKeyPoses({ density: 'beat' });
      const over = expect(working).rejects.toMatchObject({ name: 'AbortError' });
      await vi.waitFor(() => expect(keys().length).toBeGreaterThan(3));
      if (act === 'add') store.addKey(pose(1.1), 9.5);
      else store.undo();
      const after = keys();
      await over;
      expect(keys()).toEqual(after);
      expect(act === 'add' ? after.at(-1)?.rotations : after).toEqual(act === 'add' ? pose(1.1) : []);
    }
  });

  it('gives other poses at each press of the button, the same ones through the API, and offers the dance', async () => {
    const { store, asked, keys } = await page();
    await store.suggestForPage();
    await store.suggestForPage();
    expect(asked.map(({ seed }) => seed)).toEqual([asked[0].seed, asked[0].seed + 1]);
    const notice = store.state.notices.value.at(-1)!;
    expect(notice.text).toMatch(/^\d+ key poses suggested/);
    // Whatever the number, only the last suggestion is spoken of.
    store.chooseSuggestion({ density: 'bar' });
    await store.suggestForPage();
    const said = store.state.notices.value.filter(({ text }) => text.includes('suggested'));
    expect(said.map(({ text }) => text)).toEqual(['5 key poses suggested.']);
    notice.action!.run();
    await vi.waitFor(() => expect(store.state.dance.value?.kind).toBe('generated'));
    const api = createApi(store, Promise.resolve());
    const one = await api.suggestKeyPoses({ density: 'bar', variation: 0.3 });
    expect(await api.suggestKeyPoses({ density: 'bar', variation: 0.3 })).toEqual(one);
    expect(one[0].rotations).toHaveLength(72);
    expect(keys()).toHaveLength(5);
  });

  it('says what is wrong with a call, and changes nothing', async () => {
    const { store, keys } = await page();
    const attempt = (call: object) => expect(store.suggestKeyPoses(call)).rejects;
    await attempt({ density: 'often' }).toThrow(/"beat", "half" or "bar"/);
    await attempt({ range: { start: 5, end: 4 } }).toThrow(/inside the song/);
    await attempt({ variation: 2 }).toThrow(/from 0 to 1/);
    await attempt({ seed: 0.5 }).toThrow(/whole number/);
    await attempt({ style: 'foxtrot' }).toThrow(/waltz/);
    await attempt({ gaps: true }).toThrow(/two key poses/);
    expect(keys()).toEqual([]);
    const without = createStore(fakeServices(new Player(() => ({}) as AudioContext)), fakeReporter());
    await expect(without.suggestKeyPoses()).rejects.toThrow(/no song/);
  });
});

describe('alternates', () => {
  it('are flipped through, each one step of undo, and back to the first', async () => {
    const { store, keys } = await page();
    const found = await store.suggestKeyPoses({ density: 'bar' });
    store.selectKey(found[2].id);
    const now = () => keys().find(({ id }) => id === found[2].id)!;
    expect(store.alternateOf(now())).toBeNull();
    await store.stepAlternate(1);
    expect(now().rotations).not.toEqual(found[2].rotations);
    expect(now().suggested).toBe(true);
    expect(store.alternateOf(now())).toEqual({ number: 2, count: 5 });
    await store.stepAlternate(1);
    store.undo();
    expect(store.alternateOf(now())?.number).toBe(2);
    await store.stepAlternate(-1);
    expect(now().rotations).toEqual(found[2].rotations);
    for (let i = 0; i < 5; i++) await store.stepAlternate(1);
    expect(now().rotations).toEqual(found[2].rotations);
    // Everything else is as it was.
    expect(keys().filter(({ id }) => id !== found[2].id)).toEqual(found.filter(({ id }) => id !== found[2].id));
  });

  it('are of suggestions only', async () => {
    const { store, keys, suggester } = await page();
    store.addKey(pose(0.2), 3);
    const spy = vi.spyOn(suggester, 'alternates');
    await store.stepAlternate(1);
    expect(keys()[0].rotations).toEqual(pose(0.2));
    expect(spy).not.toHaveBeenCalled();
    expect(store.state.notices.value.at(-1)?.text).toMatch(/Select one suggested key pose/);
  });
});

describe('the client of the suggesting worker', () => {
  const start = () => {
    const worker = new FakeWorker<{ type: string; job: number }, SuggestReply>();
    const client = new SuggestClient(() => worker as unknown as Worker);
    return { worker, client };
  };
  const model = { baseUrl: 'https://example.test/app/' };

  it('hands on progress, poses and the result', async () => {
    const { worker, client } = start();
    const onLoading = vi.fn();
    const onPoses = vi.fn();
    const work = client.suggest(model, {} as never, { onLoading, onPoses });
    const { job } = worker.sent[0];
    worker.reply({ type: 'loading', job, fraction: 0.5, bytes: 1, totalBytes: 2, cached: false });
    worker.reply({ type: 'poses', job, poses: [{ time: 1, rotations: [] }], fraction: 0.5 });
    worker.reply({ type: 'done', job, backend: 'wasm', model: 'suggest', steps: 3, milliseconds: 4 });
    expect(await work).toMatchObject({ steps: 3 });
    expect(onLoading).toHaveBeenCalledTimes(1);
    expect(onPoses).toHaveBeenCalledWith([{ time: 1, rotations: [] }], 0.5);
    const other = client.alternates(model, {} as never, {} as never);
    worker.reply({ type: 'alternates', job: worker.sent[1].job, poses: [[1]] });
    expect(await other).toEqual([[1]]);
  });

  it('tells the worker to stop, passes errors on, and survives a worker that dies', async () => {
    const { worker, client } = start();
    const controller = new AbortController();
    const stopped = client.suggest(model, {} as never, { signal: controller.signal });
    controller.abort();
    await expect(stopped).rejects.toMatchObject({ name: 'AbortError' });
    expect(worker.sent.at(-1)).toEqual({ type: 'cancel', job: worker.sent[0].job });
    const failing = client.load(model);
    worker.reply({ type: 'error', job: worker.sent.at(-1)!.job, message: 'what to do' });
    await expect(failing).rejects.toThrow('what to do');
    const dying = client.load(model);
    worker.onerror?.({ message: 'out of memory', preventDefault: () => undefined } as unknown as ErrorEvent);
    await expect(dying).rejects.toThrow(/stopped unexpectedly \(out of memory\)/);
  });
});
