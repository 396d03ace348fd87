import { unzipSync } from 'fflate';
import { GLTFLoader, type GLTF } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { describe, expect, it } from 'vitest';
import { createApi } from '../../web/app/api';
import { writeMotionFile } from '../../web/app/motion-file';
import { estimateBytes, type MotionFileRequest } from '../../web/app/motion-formats';
import { projectHash } from '../../web/app/motion-origin';
import { inputsOf } from '../../web/app/recipe';
import { createStore } from '../../web/app/store';
import { Player } from '../../web/audio/player';
import { readBvh } from '../../web/core/formats/bvh-read';
import { readMotionJson } from '../../web/core/formats/motion-json';
import { swingingMotion } from './dance';
import { fakeReporter, fakeServices, settled } from './support/app';

/** A page with a song of ten seconds (120 beats a minute) and a dance to it. */
async function page() {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  const requests: MotionFileRequest[] = [];
  services.writeMotionFile = async (request, progress, signal) => {
    requests.push(request);
    progress(0.5);
    await settled();
    signal.throwIfAborted();
    return writeMotionFile(request);
  };
  const store = createStore(services, fakeReporter());
  const api = createApi(store, store.start());
  await api.ready;
  const show = () =>
    store.showDance({
      motion: swingingMotion(300),
      kind: 'generated',
      inputs: inputsOf(store.state.document.value),
      result: null,
    });
  const dance = async () => {
    await store.loadSong(new File(['song'], 'a song.mp3'));
    show();
  };
  return { store, api, requests, dance, show };
}

describe('exporting the dance', () => {
  it('says so when there is none yet', async () => {
    const { api, store } = await page();
    await expect(api.exportAs('bvh')).rejects.toThrow('no dance yet');
    expect(store.exportFrames(undefined)).toBeNull();
  });

  it('gives the whole dance in centimetres, as it is', async () => {
    const { api, dance } = await page();
    await dance();
    const blob = await api.exportAs('bvh');
    const text = await blob.text();
    const [clip] = readBvh(text).clips;
    expect(clip.frames).toBe(300);
    expect(text).toContain('Frame Time: 0.0333333333');
    expect(Number(text.split('\n').at(-2)!.split(' ')[1])).toBeCloseTo(95.5, 4);
  });

  it('takes the trimmed part, the loop, or seconds, with both ends', async () => {
    const { api, store, requests, dance } = await page();
    await dance();
    store.setTrim({ start: 2, end: 6 });
    await api.exportAs('json', { range: 'all' });
    await api.exportAs('json');
    await api.exportAs('json', { range: 'trim' });
    await api.exportAs('json', { range: { start: 1, end: 3 } });
    expect(requests.map(({ motion }) => motion.frames)).toEqual([300, 120, 120, 61]);
    expect(store.exportFrames({ start: 1, end: 3 })).toBe(61);
    await expect(api.exportAs('json', { range: 'loop' })).rejects.toThrow('No stretch is selected');
    await expect(api.exportAs('json', { range: { start: 20, end: 30 } })).rejects.toThrow('inside the dance');
    store.setTrim(null);
    await expect(api.exportAs('json', { range: 'trim' })).rejects.toThrow('not trimmed');
  });

  it('notes song, beats and key poses in the JSON, counted from its first frame', async () => {
    const { api, dance, store, show } = await page();
    await dance();
    store.setKeyPoses([
      { time: 0.5, rotations: new Array<number>(72).fill(0) },
      { time: 2, rotations: new Array<number>(72).fill(0), name: 'stand' },
    ]);
    show();
    const blob = await api.exportAs('json', { range: { start: 1, end: 3 } });
    const { motion, song, keyPoses } = readMotionJson(await blob.text());
    expect(motion.frames).toBe(61);
    expect(song).toMatchObject({ name: 'a song.mp3', start: 1, tempo: 120, beats: [0, 0.5, 1, 1.5, 2] });
    expect(keyPoses).toEqual([{ time: 1, name: 'stand' }]);
  });

  it('says in GLB, npz and JSON where the dance comes from: the hash that the page gives, and what made it', async () => {
    const { api, store } = await page();
    await store.loadSong(new File(['song'], 'a song.mp3'));
    const { motionHash } = await api.generate({ engine: 'light' });
    const bytes = async (format: 'glb' | 'npz' | 'json') =>
      new Uint8Array(await (await api.exportAs(format, { range: { start: 1, end: 3 }, figure: false })).arrayBuffer());
    const { dials, camera } = store.state.document.value;
    expect(camera).toBeNull();
    const origin = {
      motionHash,
      frames: 300,
      from: 30,
      to: 91,
      projectHash: await projectHash(store.state.document.value),
      engine: 'light',
      ...dials,
      model: 'light',
      backend: 'wasm',
    };
    expect(motionHash).toMatch(/^[0-9a-f]{64}$/);
    const { parser } = await new GLTFLoader().parseAsync((await bytes('glb')).buffer, '');
    expect((parser.json as GLTF).asset).toMatchObject({ extras: { posebeat: origin } });
    expect(readMotionJson(new TextDecoder().decode(await bytes('json'))).origin).toEqual(origin);
    // NumPy's unicode is UTF-32.
    const array = unzipSync(await bytes('npz'))['posebeat.npy'];
    const start = 10 + new DataView(array.buffer, array.byteOffset).getUint16(8, true);
    const letters = new Uint32Array(array.slice(start).buffer);
    expect(JSON.parse(String.fromCodePoint(...letters))).toEqual(origin);
    // What the project has moved on from is not called its dance, and dials that a call gave are not the project's.
    store.setDial('variation', 0.9);
    const later = readMotionJson(new TextDecoder().decode(await bytes('json'))).origin!;
    expect(later).toMatchObject({ motionHash, seed: dials.seed, variation: dials.variation });
    expect(later.projectHash).toBeUndefined();
    await api.generate({ seed: 77 });
    expect(readMotionJson(new TextDecoder().decode(await bytes('json'))).origin?.seed).toBeUndefined();
  });

  it('refuses what it does not know', async () => {
    const { api, dance } = await page();
    await dance();
    await expect(api.exportAs('bvh', { fps: 29 })).rejects.toThrow('24, 30, 60, 120');
    await expect(api.exportAs('bvh', { units: 'inch' as 'm' })).rejects.toThrow('"m" or "cm"');
    await expect(api.exportAs('dae' as 'bvh')).rejects.toThrow('no export format "dae"');
  });

  it('tells its progress; a newer file, or cancelling, ends an older one', async () => {
    const { store, dance } = await page();
    await dance();
    const first = store.exportMotion('npz');
    expect(store.state.exportJob.value).toEqual({ format: 'npz', fraction: 0 });
    while (store.state.exportJob.value?.fraction === 0) await new Promise((resolve) => setTimeout(resolve, 0));
    expect(store.state.exportJob.value).toEqual({ format: 'npz', fraction: 0.5 });
    const second = store.exportMotion('json');
    await expect(first).rejects.toThrow('Another file');
    expect(store.state.exportJob.value?.format).toBe('json');
    store.cancelExport();
    await expect(second).rejects.toThrow('Cancelled');
    expect(store.state.exportJob.value).toBeNull();
  });

  it('knows the size of a file before it is made, to a third', async () => {
    const { store, dance } = await page();
    await dance();
    const { size } = await store.exportMotion('bvh');
    expect(Math.abs(estimateBytes('bvh', 300, false) / size - 1)).toBeLessThan(1 / 3);
  });
});
