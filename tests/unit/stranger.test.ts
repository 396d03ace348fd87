import { describe, expect, it, vi } from 'vitest';
import { createApi, type PosebeatApi } from '../../web/app/api';
import { followAddress } from '../../web/app/link-address';
import { createStore, type Store } from '../../web/app/store';
import { Player } from '../../web/audio/player';
import { openDropped } from '../../web/ui/files';
import { fakeReporter, fakeServices } from './support/app';

const page = () => createStore(fakeServices(new Player(() => ({}) as AudioContext)), fakeReporter());

describe('a script that calls with the wrong thing', () => {
  const calls: [keyof PosebeatApi, (api: PosebeatApi, options: never) => unknown][] = [
    ['generate', (api, options) => api.generate(options)],
    ['suggestKeyPoses', (api, options) => api.suggestKeyPoses(options)],
    ['exportAs', (api, options) => api.exportAs('project', options)],
    ['exportVideo', (api, options) => api.exportVideo(options)],
    ['exportPicture', (api, options) => api.exportPicture(options)],
    ['exportKeyPoses', (api, options) => api.exportKeyPoses(options)],
    ['exportLoop', (api, options) => api.exportLoop(options)],
    ['setAvatar', (api, options) => api.setAvatar(null, options)],
  ];

  it.each(calls)('is told by %s that options are an object', async (method, call) => {
    const api = createApi(page(), Promise.resolve());
    for (const options of [null, 'fast', 3, [1]]) {
      const run = async () => call(api, options as never);
      await expect(run()).rejects.toThrow(`The options of ${method} must be an object, or left out.`);
    }
  });

  it('is told what a range is', async () => {
    const api = createApi(page(), Promise.resolve());
    for (const range of [null, 5, [1, 2], {}, { start: '1', end: '2' }]) {
      const wrong = { range: range as never };
      for (const run of [api.generate(wrong), api.suggestKeyPoses(wrong), api.exportAs('bvh', wrong)])
        await expect(run).rejects.toThrow('range must be {start, end} in seconds.');
    }
  });
});

describe('the address of a page that opened with a link', () => {
  /** What stands after the path once the page is ready and shows its own project. */
  const left = async (hash: string) => {
    const store = page();
    const replaceState = vi.fn();
    const location = { hash, pathname: '/', search: '' };
    followAddress(store, { location, history: { replaceState }, addEventListener: vi.fn() } as unknown as Window);
    await store.start(hash);
    return replaceState.mock.calls.length > 0 ? '' : hash;
  };

  it('loses a damaged one', async () => {
    expect(await left('#d=1.AAAA')).toBe('');
  });

  it('keeps one of a newer version, so that reloading, which the message asks for, can open it', async () => {
    expect(await left('#d=9.AAAA')).toBe('#d=9.AAAA');
  });
});

describe('files dropped together', () => {
  it('are opened one at a time, and that is said', () => {
    const store = { dropSong: vi.fn(), notify: vi.fn() };
    const [one, two] = ['one.wav', 'two.wav'].map((name) => new File(['x'], name));
    openDropped(store as unknown as Store, [one]);
    expect(store.notify).not.toHaveBeenCalled();
    openDropped(store as unknown as Store, [one, two]);
    expect(store.dropSong.mock.calls).toEqual([[one], [one]]);
    expect(store.notify).toHaveBeenCalledWith(
      'info',
      expect.stringContaining('Of these 2 files only the first, “one.wav”'),
    );
    openDropped(store as unknown as Store, []);
    expect(store.dropSong).toHaveBeenCalledTimes(2);
  });
});
