import { describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import { createStore } from '../../web/app/store';
import { createDocument, type ProjectDocument } from '../../web/core/document';
import { readLink, writeLink } from '../../web/core/formats/share-link';
import { emptyMotion } from '../../web/core/motion';
import { standIn } from '../../web/core/stand-in';
import { fakeReporter, fakeServices, settled, SONG_SECONDS, type Services } from './support/app';

const pose = (value: number) => new Array<number>(72).fill(value);
const every = (gap: number, count: number) => Array.from({ length: count }, (_, i) => i * gap);
const demo: ProjectDocument = {
  ...createDocument({ name: 'Demo', hash: 'demo-hash', duration: SONG_SECONDS }),
  grid: { tempo: 120, beatsPerBar: 4, beats: every(0.5, 20), downbeats: every(2, 5) },
  keyPoses: [{ id: 'k1', time: 2, rotations: pose(0.1) }],
};
/** What a link says, for a song of this hash. */
const linked = (hash: string, name = 'Theirs.mp3'): ProjectDocument => ({
  ...createDocument({ name, hash, duration: 30 }),
  keyPoses: [1, 3, 5].map((time, i) => ({ id: `k${i + 1}`, time, rotations: pose(0.3 * i) })),
});
const times = (document: ProjectDocument) => document.keyPoses.map(({ time }) => time);

/** A player that makes no sound: there is no audio in these tests. */
const silentPlayer = () => {
  const player = new Player(() => ({}) as AudioContext);
  player.setMuted = player.play = player.unlock = vi.fn();
  return player;
};

/** A page that has a demo and keeps what it saves in memory. */
function page(change: (services: Services) => void = () => undefined) {
  const services = fakeServices(silentPlayer());
  const kept: { document: ProjectDocument | null; aside: ProjectDocument[]; songs: Map<string, Blob> } = {
    document: null,
    aside: [],
    songs: new Map(),
  };
  services.assets.demo = () =>
    Promise.resolve({ document: demo, motion: emptyMotion(SONG_SECONDS * 30), songUrl: 'demo/song.mp3' });
  services.storage = {
    ...services.storage,
    load: () => Promise.resolve(kept.document && { document: kept.document, dance: null }),
    saveSong: async (hash, song) => void kept.songs.set(hash, song),
    loadSong: (hash) => Promise.resolve(kept.songs.get(hash) ?? null),
    setAside: (document) => Promise.resolve(kept.aside.push(document)),
    takeAside: () => {
      const document = kept.aside.pop();
      return Promise.resolve(document ? { document, left: kept.aside.length } : null);
    },
    countAside: () => Promise.resolve(kept.aside.length),
  };
  vi.stubGlobal('fetch', () => Promise.resolve(new Response(new Blob(['demo song']))));
  change(services);
  return { store: createStore(services, fakeReporter()), services, kept };
}

/** SHA-256 of the text that the tests' songs hold. */
async function hashOf(text: string): Promise<string> {
  const digest = await crypto.subtle.digest('SHA-256', new TextEncoder().encode(text));
  return Buffer.from(digest).toString('hex');
}

const notices = (store: ReturnType<typeof page>['store']) => store.state.notices.value.map(({ text }) => text);

describe('a page that opens with a link', () => {
  it('to the demo’s song shows its poses at once, plays, and makes the dance', async () => {
    const { store, services } = page();
    await store.start(writeLink({ ...linked('demo-hash'), song: demo.song }));
    expect(times(store.state.document.value)).toEqual([1, 3, 5]);
    expect(services.player.play).toHaveBeenCalled();
    expect(store.isGuest.value).toBe(true);
    expect(store.state.wanted.value).toBeNull();
    expect(notices(store)).toEqual([]);
    await vi.waitFor(() => expect(store.state.dance.value?.kind).toBe('generated'));
    expect(store.state.stale.value).toBe(false);
    store.undo();
    expect(store.state.document.value.keyPoses).toEqual(demo.keyPoses);
  });

  it('to a song of its maker’s asks for it, dances to the demo’s meanwhile, and knows it when it comes', async () => {
    const { store } = page();
    const document = linked(await hashOf('their song'));
    await store.start(writeLink(document));
    expect(store.state.wanted.value?.name).toBe('Theirs.mp3');
    expect(store.state.song.value?.demo).toBe(true);
    expect(store.state.document.value.song?.hash).toBe('demo-hash');
    expect(store.state.document.value.keyPoses).toHaveLength(3);
    // Passed on before the song came, it is still the whole dance.
    expect(readLink(new URL(store.shareLink('https://example.org/page/?embed=1')).hash).document.song).toEqual(
      document.song,
    );

    await store.dropSong(new File(['their song'], 'renamed.mp3'));
    expect(store.state.wanted.value).toBeNull();
    expect(times(store.state.document.value)).toEqual([1, 3, 5]);
    expect(store.state.document.value.song?.hash).toBe(await hashOf('their song'));
    expect(store.state.dance.value?.kind).toBe('generated');
  });

  it('offers to use another song for it', async () => {
    const { store } = page();
    await store.start(writeLink(linked(await hashOf('their song'))));
    await store.dropSong(new File(['another song'], 'b.mp3'));
    const offer = store.state.notices.value.find(({ action }) => action?.label === 'Use it for that project');
    expect(offer?.text).toBe('“b.mp3” is not “Theirs.mp3”, the song of the project that you opened.');
    offer!.action!.run();
    expect(times(store.state.document.value)).toEqual([1, 3, 5]);
    expect(store.state.document.value.song?.hash).toBe(await hashOf('another song'));
  });

  it('to a song that is kept here opens with it', async () => {
    const { store } = page((services) => {
      services.storage.loadSong = () => Promise.resolve(new Blob(['their song']));
    });
    await store.start(writeLink(linked(await hashOf('their song'))));
    expect(store.state.wanted.value).toBeNull();
    expect(times(store.state.document.value)).toEqual([1, 3, 5]);
    expect(store.state.song.value?.reference.name).toBe('Theirs.mp3');
  });

  it('loses nothing of the project kept here: one undo, or later from the ones put aside', async () => {
    const { store, kept } = page();
    const own = {
      ...linked(await hashOf('own song'), 'Own.mp3'),
      keyPoses: [{ id: 'k1', time: 7, rotations: pose(0.5) }],
    };
    kept.document = own;
    kept.songs.set(own.song!.hash, new Blob(['own song']));
    await store.start(writeLink({ ...linked('demo-hash'), song: demo.song }));
    expect(kept.aside).toEqual([own]);
    expect(store.state.aside.value).toBe(1);
    const notice = store.state.notices.value.find(({ action }) => action?.label === 'Undo');
    expect(notice?.text).toBe('The dance of the link is open. Your own project is kept.');
    notice!.action!.run();
    await settled();
    await settled();
    expect(store.state.document.value).toEqual(own);
    expect(store.state.song.value?.reference.hash).toBe(own.song!.hash);
    store.redo();
    await settled();
    expect(times(store.state.document.value)).toEqual([1, 3, 5]);
    await store.openAside();
    expect(times(store.state.document.value)).toEqual([7]);
    expect(store.state.aside.value).toBe(0);
  });

  it('that is damaged opens as ever and says so', async () => {
    const { store } = page();
    await store.start(`${writeLink(linked('demo-hash')).slice(0, -3)}`);
    expect(store.state.document.value).toEqual(demo);
    expect(store.isGuest.value).toBe(false);
    expect(notices(store)).toEqual(['This link is damaged or was not copied completely: copy it again, whole.']);
  });

  it('without a song dances to the demo’s and asks for none', async () => {
    const { store } = page();
    await store.start(writeLink({ ...linked('x'), song: null }));
    expect(store.state.wanted.value).toBeNull();
    expect(store.state.document.value.song?.hash).toBe('demo-hash');
    expect(store.state.document.value.keyPoses).toHaveLength(3);
  });
});

describe('the model of a link', () => {
  it('that is another one than here is told of, once the dance is there', async () => {
    const { store } = page();
    await store.start(writeLink({ ...linked('demo-hash'), song: demo.song }, 'large (fp16)'));
    await vi.waitFor(() =>
      expect(notices(store).join()).toContain('made by another model (large (fp16); here it is light)'),
    );
    const same = page().store;
    await same.start(writeLink({ ...linked('demo-hash'), song: demo.song }, 'light'));
    await vi.waitFor(() => expect(same.state.dance.value?.kind).toBe('generated'));
    await settled();
    expect(notices(same)).toEqual([]);
  });
});

describe('a link in a page that is open', () => {
  it('is one step that can be undone, and the work before is put aside', async () => {
    const { store, kept } = page();
    await store.start();
    await store.loadSong(new File(['own song'], 'own.mp3'));
    store.addKey(pose(0.4), 4);
    const before = store.state.document.value;
    expect(await store.openLink(writeLink({ ...linked('demo-hash'), song: demo.song }))).toBe(true);
    expect(times(store.state.document.value)).toEqual([1, 3, 5]);
    expect(kept.aside).toEqual([before]);
    store.undo();
    await settled();
    expect(store.state.document.value).toBe(before);
    expect(store.state.song.value?.reference.name).toBe('own.mp3');
  });

  it('that is damaged changes nothing: 100 of them', async () => {
    const { store } = page();
    await store.start();
    await store.loadSong(new File(['own song'], 'own.mp3'));
    store.addKey(pose(0.4), 4);
    const before = store.state.document.value;
    const label = store.state.undoLabel.value;
    const link = writeLink({ ...linked('demo-hash'), song: demo.song });
    for (let i = 0; i < 100; i += 1) {
      const at = 5 + ((i * 37) % (link.length - 5));
      const other = link[at] === 'A' ? 'B' : 'A';
      expect(await store.openLink(link.slice(0, at) + other + link.slice(at + 1))).toBe(false);
    }
    expect(store.state.document.value).toBe(before);
    expect(store.state.undoLabel.value).toBe(label);
    expect(store.state.song.value?.reference.name).toBe('own.mp3');
  });

  it('is no longer a guest when it is changed, but still one when the camera is turned', async () => {
    const { store } = page();
    await store.start(writeLink({ ...linked('demo-hash'), song: demo.song }));
    store.keepCamera({ follows: true, position: [1, 1, 1], target: [0, 1, 0] });
    expect(store.state.document.value.camera).not.toBeNull();
    expect(store.isGuest.value).toBe(true);
    store.setDial('variation', 0.8);
    expect(store.isGuest.value).toBe(false);
    store.undo();
    expect(store.isGuest.value).toBe(true);
  });
});

describe('the link of a project', () => {
  it('is the page’s address without its question, and brings the project back', async () => {
    const { store } = page();
    await store.start();
    const link = store.shareLink('https://example.org/some/path/?embed=1&backend=wasm#d=1.old');
    expect(link.startsWith('https://example.org/some/path/#d=1.')).toBe(true);
    expect(times(readLink(new URL(link).hash).document)).toEqual([2]);
  });

  it('that would be too long names the way out', async () => {
    const { store } = page();
    await store.start();
    const many = every(0.1, 90).map((time, k) => ({
      time,
      rotations: pose(0).map((_, i) => ((Math.sin(i * 12.9898 + k * 78.233) * 43758.5453) % 1) * 3),
    }));
    store.setKeyPoses(many);
    expect(() => store.shareLink('https://example.org/')).toThrow(
      /^This dance is too long for a link \([\d,]+ characters, at most 8,000\): save the project as a \.posebeat file/,
    );
  });
});

describe('a stand-in', () => {
  it('keeps bars on bars where both songs have beats', () => {
    const beats = every(0.6, 100).map((time) => time + 0.3);
    const grid = { tempo: 100, beatsPerBar: 4 as const, beats, downbeats: beats.filter((_, i) => i % 4 === 1) };
    // The third bar's first beat, the beat after it, and half a beat further.
    const keyPoses = [beats[9], beats[10], (beats[10] + beats[11]) / 2].map((time, i) => ({
      id: `k${i + 1}`,
      time,
      rotations: pose(0),
    }));
    const shown = standIn({ ...linked('x'), grid, keyPoses }, demo);
    // One bar before the first key pose stays.
    expect(times(shown).map((time) => time.toFixed(6))).toEqual(['2.000000', '2.500000', '2.750000']);
    expect(shown.grid).toEqual(demo.grid);
    expect(shown.song).toEqual(demo.song);
  });

  it('without beats puts late poses early, on half beats, and drops what is beyond the end', () => {
    const keyPoses = [20.1, 21.27, 60].map((time, i) => ({ id: `k${i + 1}`, time, rotations: pose(0) }));
    expect(times(standIn({ ...linked('x'), keyPoses }, demo))).toEqual([2, 3.25]);
  });
});
