import { describe, expect, it } from 'vitest';
import { Player } from '../../web/audio/player';
import { createStore } from '../../web/app/store';
import { fakeReporter, fakeServices, settled } from './support/app';

const pose = (value: number) => new Array<number>(72).fill(value);

/** A player that makes no sound: there is no audio in these tests. */
const silentPlayer = () => {
  const player = new Player(() => ({}) as AudioContext);
  player.setMuted = player.play = player.unlock = () => undefined;
  return player;
};

async function page() {
  const store = createStore(fakeServices(silentPlayer()), fakeReporter());
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  return store;
}

describe('undo', () => {
  it('goes 240 steps back over everything that lasts and forward again to the same document', async () => {
    const store = await page();
    const documents = [store.state.document.value];
    const labels: string[] = [];
    for (let i = 0; i < 80; i += 1) {
      const id = store.addKey(pose(i / 100), (i + 1) / 10, { exact: true, name: `Pose ${i}` });
      documents.push(store.state.document.value);
      store.setDial(i % 2 ? 'variation' : 'keyStrength', (i + 1) / 100);
      documents.push(store.state.document.value);
      store.updateKey(id, pose(i / 90 + 0.001));
      documents.push(store.state.document.value);
    }
    expect(new Set(documents).size).toBe(241);
    for (const document of documents.slice(0, -1).reverse()) {
      labels.push(store.state.undoLabel.value!);
      store.undo();
      expect(store.state.document.value).toEqual(document);
    }
    for (const document of documents.slice(1)) {
      store.redo();
      expect(store.state.document.value).toEqual(document);
    }
    expect(new Set(labels)).toEqual(new Set(['Add key pose', 'Change setting', 'Edit key pose']));
  });

  it('is neither made nor lost by what only looks: selection, playback, zoom, panels, camera', async () => {
    const store = await page();
    const id = store.addKey(pose(0.1), 1);
    store.addKey(pose(0.2), 2);
    store.undo();
    const { undoLabel, redoLabel } = store.state;
    const before = [undoLabel.value, redoLabel.value];
    const { keyPoses } = store.state.document.value;
    store.selectKey(id);
    store.selectAll();
    store.selectKey(null);
    store.seek(3);
    store.stepFrame(1);
    store.stepKey(-1);
    store.toggleLoop();
    store.toggleLoop();
    store.setSpeed(0.5);
    store.setVolume(0.3);
    store.resizeView(800);
    store.zoom(2);
    store.scrollBy(50);
    store.fit();
    store.showPanel('dance');
    store.toggleHelp(true);
    store.toggleHelp(false);
    store.toggleCurves();
    store.keepCamera({ follows: true, position: [1, 2, 3], target: [0, 1, 0] });
    store.startTour();
    store.endTour();
    await settled();
    expect([undoLabel.value, redoLabel.value]).toEqual(before);
    expect(store.state.document.value.keyPoses).toBe(keyPoses);
    expect(redoLabel.value).toBe('Add key pose');
    store.redo();
    expect(store.state.document.value.keyPoses).toHaveLength(2);
    expect(store.state.document.value.camera?.position).toEqual([1, 2, 3]);
    store.undo();
    expect(store.state.document.value.camera?.position).toEqual([1, 2, 3]);
  });
});

describe('projects', () => {
  it('open over one another, and each can be brought back', async () => {
    const store = await page();
    store.addKey(pose(0.1), 1);
    const first = store.state.document.value;
    const file = (value: unknown) => new Blob([JSON.stringify(value)]);
    await store.openProject(file({ ...first, keyPoses: [] }));
    expect(store.state.document.value.keyPoses).toEqual([]);
    expect(store.state.undoLabel.value).toBe('Open project');
    store.undo();
    expect(store.state.document.value).toEqual(first);
    await store.openProject(file({ ...first, version: 99 }));
    expect(store.state.document.value).toEqual(first);
    expect(store.state.redoLabel.value).toBe('Open project');
    expect(store.state.notices.value.at(-1)).toMatchObject({ kind: 'error', text: expect.stringMatching(/newer/) });
  });

  it('that a dropped song puts away are offered again', async () => {
    const store = await page();
    store.addKey(pose(0.1), 1);
    const first = store.state.document.value;
    await store.dropSong(new File(['other'], 'b.mp3'));
    expect(store.state.document.value.keyPoses).toEqual([]);
    const offer = store.state.notices.value.find((notice) => notice.action)!;
    expect(offer.text).toBe('“b.mp3” begins a new project.');
    store.addKey(pose(0.3), 2);
    offer.action!.run();
    await settled();
    expect(store.state.document.value).toEqual(first);
    expect(store.state.song.value?.reference.name).toBe('a.mp3');
  });
});

describe('the walk-through', () => {
  it('goes on by what the visitor does, and ends', async () => {
    const store = createStore(fakeServices(silentPlayer()), fakeReporter());
    await store.start();
    store.startTour();
    const { tour } = store.state;
    expect(tour.value).toBe(0);
    await store.loadSong(new File(['song'], 'a.mp3'));
    await settled();
    expect(tour.value).toBe(1);
    store.addKey(pose(0.1), 1);
    await settled();
    expect(tour.value).toBe(1);
    store.addKey(pose(0.2), 2);
    await settled();
    expect(tour.value).toBe(2);
    await store.generate();
    await settled();
    expect(tour.value).toBe(3);
    store.addKey(pose(0.3), 3);
    await settled();
    expect(tour.value).toBeNull();
    // Asked for again, what is done already waits for a word.
    store.startTour();
    await settled();
    expect(tour.value).toBe(0);
    store.nextTourStep();
    expect(tour.value).toBe(1);
    store.endTour();
    expect(tour.value).toBeNull();
  });
});
