import { describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import { keepOffline, type OfflineBrowser } from '../../web/app/offline';
import { createStore } from '../../web/app/store';
import { fakeReporter, fakeServices, settled, type Services } from './support/app';

const BASE = 'https://host.example/some/path/';

/** A browser whose service workers do what the test says. */
function browser(controlled: boolean) {
  const sent: unknown[] = [];
  const worker = (state: string) => {
    const target = new EventTarget();
    return Object.assign(target, { state, postMessage: vi.fn((message: unknown) => void sent.push(message)) });
  };
  const registration = Object.assign(new EventTarget(), {
    waiting: null as ReturnType<typeof worker> | null,
    installing: null as ReturnType<typeof worker> | null,
    update: () => Promise.resolve(),
  });
  const container = Object.assign(new EventTarget(), {
    controller: controlled ? worker('activated') : null,
    ready: Promise.resolve(registration),
    register: vi.fn(() => Promise.resolve(registration)),
  });
  const reload = vi.fn();
  const loaded = () => [
    `${BASE}assets/index.js`,
    `${BASE}demo/song.mp3`,
    `${BASE}models/light.onnx`,
    'https://other.example/x',
  ];
  const fake = { serviceWorker: container, base: BASE, loaded, reload } as unknown as OfflineBrowser;
  return { fake, container, registration, worker, reload, sent };
}

function page(change: (services: Services) => void = () => undefined) {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  change(services);
  return createStore(services, fakeReporter());
}

describe('a page that is kept for offline', () => {
  it('is registered under its own path, and hands over what it had loaded before', async () => {
    const { fake, container, worker, sent } = browser(false);
    await keepOffline(page(), fake);
    expect(container.register).toHaveBeenCalledWith(new URL(`${BASE}sw.js`), { updateViaCache: 'none' });
    Object.assign(container, { controller: Object.assign(worker('activated')) });
    container.dispatchEvent(new Event('controllerchange'));
    // The model has a cache of its own; what is not ours is not kept.
    expect(sent).toEqual([
      { type: 'CACHE_URLS', payload: { urlsToCache: [`${BASE}assets/index.js`, `${BASE}demo/song.mp3`] } },
    ]);
  });

  it('does not care when the browser refuses', async () => {
    const { fake, container } = browser(false);
    container.register.mockRejectedValue(new DOMException('no', 'SecurityError'));
    const store = page();
    await keepOffline(store, fake);
    expect(store.state.update.value).toBeNull();
    expect(store.state.notices.value).toEqual([]);
  });
});

describe('a newer page', () => {
  it('is offered, saves first, and comes in only when it is let in', async () => {
    const { fake, container, registration, worker, reload, sent } = browser(true);
    const saveDocument = vi.fn(() => Promise.resolve());
    const store = page((services) => (services.storage.saveDocument = saveDocument));
    await store.start();
    await store.loadSong(new File(['song'], 'a.mp3'));
    await keepOffline(store, fake);
    const installing = worker('installing');
    registration.installing = installing;
    registration.dispatchEvent(new Event('updatefound'));
    expect(store.state.update.value).toBeNull();
    installing.state = 'installed';
    installing.dispatchEvent(new Event('statechange'));
    expect(store.state.update.value).not.toBeNull();
    expect(reload).not.toHaveBeenCalled();

    store.setDial('variation', 0.9);
    await store.state.update.value!();
    expect(saveDocument).toHaveBeenLastCalledWith(store.state.document.value);
    expect(sent).toEqual([{ type: 'SKIP_WAITING' }]);
    container.dispatchEvent(new Event('controllerchange'));
    expect(reload).toHaveBeenCalledOnce();
  });

  it('that already waits is offered at once, and can be put off', async () => {
    const { fake, registration, worker } = browser(true);
    registration.waiting = worker('installed');
    const store = page();
    await keepOffline(store, fake);
    expect(store.state.update.value).not.toBeNull();
    store.laterUpdate();
    expect(store.state.update.value).toBeNull();
  });

  it('asks again where work could not be saved', async () => {
    const { fake, registration, worker, sent } = browser(true);
    registration.waiting = worker('installed');
    const store = page((services) => {
      services.storage.saveDocument = () => Promise.reject(new Error('private window'));
    });
    await store.start();
    await store.loadSong(new File(['song'], 'a.mp3'));
    await keepOffline(store, fake);
    store.setDial('variation', 0.9);
    await store.state.update.value!();
    expect(store.state.updateRisk.value).toBe(true);
    expect(sent).toEqual([]);
    await store.state.update.value!();
    expect(sent).toEqual([{ type: 'SKIP_WAITING' }]);
  });

  it('let in by another tab never reloads this one by itself', async () => {
    const { fake, container, reload } = browser(true);
    const store = page();
    await keepOffline(store, fake);
    container.dispatchEvent(new Event('controllerchange'));
    await settled();
    expect(reload).not.toHaveBeenCalled();
    expect(store.state.update.value).not.toBeNull();
    await store.state.update.value!();
    expect(reload).toHaveBeenCalledOnce();
  });
});
