import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import { createStorage } from '../../web/app/storage';
import { createStore } from '../../web/app/store';
import { createDocument } from '../../web/core/document';
import { fakeReporter, fakeServices } from './support/app';

/** The database's one table, and writes that wait for a word. */
const database = vi.hoisted(() => ({ work: new Map<string, unknown>(), waiting: [] as (() => void)[], holds: false }));

vi.mock('idb', () => ({
  openDB: async () => ({
    get: async (_: string, key: string) => database.work.get(key),
    transaction: () => {
      const done = new Promise<void>((resolve) =>
        database.holds ? database.waiting.push(resolve) : queueMicrotask(resolve),
      );
      return {
        store: { put: (value: unknown, key: string) => done.then(() => void database.work.set(key, value)) },
        commit: () => undefined,
        done,
      };
    },
  }),
}));

/** Room in the local storage, characters. */
let room = Infinity;
const local = new Map<string, string>();

beforeEach(() => {
  room = Infinity;
  local.clear();
  database.work.clear();
  database.waiting = [];
  database.holds = false;
  vi.stubGlobal('window', new EventTarget());
  vi.stubGlobal('document', Object.assign(new EventTarget(), { visibilityState: 'visible' }));
  vi.stubGlobal('localStorage', {
    getItem: (key: string) => local.get(key) ?? null,
    setItem: (key: string, value: string) => {
      if (value.length > room) throw new DOMException('full', 'QuotaExceededError');
      local.set(key, value);
    },
    removeItem: (key: string) => local.delete(key),
  });
});
afterEach(() => vi.unstubAllGlobals());

/** A page with a song, whose work is kept by the storage that the page has. */
async function page(writes = true) {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  const { saveDocument, noteDocument, load } = createStorage('test', () => writes);
  Object.assign(services.storage, { saveDocument, noteDocument, load });
  const store = createStore(services, fakeReporter());
  await store.start();
  if (!store.state.document.value.song) await store.loadSong(new File(['song'], 'a.mp3'));
  return store;
}
const leave = () => window.dispatchEvent(new Event('pagehide'));
const kept = async () => (await createStorage('test').load())?.document;
const tick = () => new Promise((resolve) => setTimeout(resolve, 0));

describe('a page that goes away', () => {
  it('loses nothing, though the database never comes to an end with it', async () => {
    const store = await page();
    leave();
    await tick();
    database.holds = true;
    store.setDial('variation', 0.9);
    leave();
    expect(await kept()).toEqual(store.state.document.value);
    expect(database.work.get('document')).not.toEqual(store.state.document.value);
  });

  it('loses nothing that autosave had begun with', async () => {
    const store = await page();
    leave();
    await tick();
    database.holds = true;
    store.setDial('variation', 0.9);
    document.dispatchEvent(new Event('visibilitychange'));
    expect(local.size, 'a page that is seen stays').toBe(0);
    leave();
    local.clear();
    leave();
    expect(await kept()).toEqual(store.state.document.value);
  });

  it('that lives on after all takes its note away when the work is saved, and no newer one', async () => {
    const store = await page();
    leave();
    await tick();
    expect(local.size).toBe(0);
    database.holds = true;
    store.setDial('variation', 0.8);
    leave();
    store.setDial('variation', 0.9);
    leave();
    const [first, second] = database.waiting;
    first();
    await tick();
    expect(local.size).toBe(1);
    expect(await kept()).toEqual(store.state.document.value);
    second();
    await tick();
    expect(local.size).toBe(0);
    expect(database.work.get('document')).toEqual(store.state.document.value);
  });

  it('notes nothing when all is saved, and nothing where another tab has the project', async () => {
    const store = await page();
    leave();
    await tick();
    leave();
    expect(local.size).toBe(0);
    const reader = await page(false);
    reader.setDial('variation', 0.3);
    leave();
    await tick();
    expect(await kept()).not.toEqual(reader.state.document.value);
    expect(store.state.unkept.value).toBe(false);
  });
});

describe('a note of a page that is gone', () => {
  const noted = createDocument({ name: 'a.mp3', hash: 'f'.repeat(64), duration: 10 });

  it('gives way to what is saved after it', async () => {
    createStorage('test').noteDocument!(noted);
    expect(await kept()).toEqual(noted);
    await createStorage('test').saveDocument(createDocument());
    expect(await kept()).toEqual(createDocument());
  });

  it('never stands for a newer one that found no room', async () => {
    const storage = createStorage('test');
    await storage.saveDocument(createDocument());
    storage.noteDocument!(noted);
    room = 10;
    storage.noteDocument!({ ...noted });
    expect(await kept()).toEqual(createDocument());
  });

  it('that cannot be read is none', async () => {
    await createStorage('test').saveDocument(createDocument());
    local.set('test.leaving', '{"format":');
    expect(await kept()).toEqual(createDocument());
  });
});
