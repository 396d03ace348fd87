import { describe, expect, it } from 'vitest';
import { Player } from '../../web/audio/player';
import { isPoseFile, readPoseClips } from '../../web/app/pose-reader';
import type { OwnPose, PoseStore } from '../../web/app/pose-store';
import { createStore } from '../../web/app/store';
import { writePoseFile } from '../../web/core/formats/pose-file';
import { nextTile } from '../../web/ui/library/grid-keys';
import { fakeReporter, fakeServices, settled } from './support/app';
import { bvhText, OWN_RIG } from './support/rigs';

const pose = (seed = 1) => Array.from({ length: 72 }, (_, i) => Math.sin(seed + i) / 4);

/** A browser that keeps poses, and what it keeps. */
function memory(): PoseStore & { kept: Map<string, OwnPose> } {
  const kept = new Map<string, OwnPose>();
  return {
    kept,
    load: async () => [...kept.values()].sort((a, b) => b.savedAt - a.savedAt).map((each) => structuredClone(each)),
    put: async (poses) => poses.forEach((each) => kept.set(each.id, structuredClone(each))),
    remove: async (id) => void kept.delete(id),
  };
}

function page(poseStore: PoseStore = memory()) {
  const services = { ...fakeServices(new Player(() => ({}) as AudioContext)), poseStore };
  const store = createStore(services, fakeReporter());
  const names = () => store.state.ownPoses.value.map(({ name }) => name);
  const notice = () => store.state.notices.value.at(-1)!;
  return { store, names, notice };
}
const json = (value: unknown, name = 'my-poses.json') =>
  new File([typeof value === 'string' ? value : JSON.stringify(value)], name);

describe('own poses', () => {
  it('are saved, newest first, each under a name of its own, and found by the next visit', async () => {
    const kept = memory();
    const { store, names } = page(kept);
    store.saveOwnPose(pose(1), ' Turn ');
    store.saveOwnPose(pose(2), 'Turn');
    store.saveOwnPose(pose(3), '');
    expect(names()).toEqual(['My pose', 'Turn 2', 'Turn']);
    await settled();
    const later = page(kept);
    await later.store.loadOwnPoses();
    expect(later.names()).toEqual(names());
    expect(later.store.state.ownPoses.value[2].rotations).toEqual(pose(1));
  });

  it('come from the editor, the timeline and the dance', async () => {
    const { store, names, notice } = page();
    store.saveDancePose();
    expect(notice().text).toMatch(/no dance/);
    await store.start();
    await store.loadSong(new File(['song'], 'a.mp3'));
    const id = store.addKey(pose(4), 1, { name: 'Placed' });
    store.saveKeyPose(id);
    store.editPose(pose(5), { name: 'Drafted' });
    store.saveDraftPose();
    store.saveDraftPose('Named');
    store.closeDraft();
    store.saveDancePose();
    expect(names()).toEqual(['From the dance', 'Named', 'Drafted', 'Placed']);
    expect(store.state.ownPoses.value.find(({ name }) => name === 'Placed')?.rotations).toEqual(pose(4));
  });

  it('are renamed, and deleted with a way back to the same place', async () => {
    const kept = memory();
    const { store, names, notice } = page(kept);
    const ids = ['A', 'B', 'C'].map((name, i) => store.saveOwnPose(pose(i), name));
    store.renameOwnPose(ids[1], '  ');
    store.renameOwnPose(ids[1], 'C');
    expect(names()).toEqual(['C', 'C 2', 'A']);
    store.deleteOwnPose(ids[1]);
    await settled();
    expect(names()).toEqual(['C', 'A']);
    expect(kept.kept.has(ids[1])).toBe(false);
    expect(notice().action?.label).toBe('Undo');
    notice().action!.run();
    await settled();
    expect(names()).toEqual(['C', 'C 2', 'A']);
    expect(kept.kept.get(ids[1])?.name).toBe('C 2');
  });

  it('are imported once, in their order, and wrong files change nothing', async () => {
    const { store, names, notice } = page();
    store.saveOwnPose(pose(1), 'Here');
    const file = writePoseFile([
      { name: 'First', rotations: pose(2) },
      { name: 'Here', rotations: pose(1) },
      { name: 'Second', rotations: pose(3) },
    ]);
    await store.importPoseFile(json(file));
    expect(names()).toEqual(['First', 'Second', 'Here']);
    expect(notice().text).toBe('2 poses added to My poses. 1 pose was there already.');
    await store.importPoseFile(json(file));
    expect(notice().text).toBe('No new poses in this file. 3 poses were there already.');
    const before = store.state.ownPoses.value;
    for (const wrong of ['{', '[]', '{"format":"posebeat-poses","version":9,"poses":[]}']) {
      await store.importPoseFile(json(wrong));
      expect(notice().kind).toBe('error');
    }
    expect(store.state.ownPoses.value.map(({ id }) => id)).toEqual(before.map(({ id }) => id));
  });

  it('work in a browser that keeps nothing, and it says so once', async () => {
    const refuse = () => Promise.reject(new Error('no database here'));
    const { store, names } = page({ load: refuse, put: refuse, remove: refuse });
    await store.loadOwnPoses();
    expect(store.state.notices.value).toEqual([]);
    store.saveOwnPose(pose(1), 'A');
    store.saveOwnPose(pose(2), 'B');
    await settled();
    expect(names()).toEqual(['B', 'A']);
    const warnings = store.state.notices.value.filter(({ text }) => /does not keep your poses/.test(text));
    expect(warnings).toHaveLength(1);
  });

  it('of another tab appear; what is here already keeps its arrays', async () => {
    const kept = memory();
    const [one, two] = [page(kept), page(kept)];
    one.store.saveOwnPose(pose(1), 'A');
    await two.store.loadOwnPoses();
    const [a] = two.store.state.ownPoses.value;
    one.store.saveOwnPose(pose(2), 'B');
    await two.store.loadOwnPoses();
    expect(two.names()).toEqual(['B', 'A']);
    expect(two.store.state.ownPoses.value[1]).toBe(a);
  });
});

describe('taking a pose from an animation file', () => {
  const still = OWN_RIG.map(() => [0, 0, 0, 1]);
  const turned = still.map((q, i) => (i === 16 ? [0, 0, Math.sin(0.4), Math.cos(0.4)] : q));
  const bvh = new File([bvhText(OWN_RIG, [still, turned, still])], 'Dance.BVH');

  it('opens it, chooses a frame, and edits, places or saves that', async () => {
    const { store, names } = page();
    await store.start();
    await store.loadSong(new File(['song'], 'a.mp3'));
    await store.importPoseFile(bvh);
    expect(store.state.poseImport.value).toMatchObject({ file: 'Dance.BVH', kind: 'BVH', frame: 0 });
    store.chooseFrame(99);
    expect(store.state.poseImport.value?.frame).toBe(2);
    store.chooseFrame(1);
    store.saveFrame();
    expect(names()).toEqual(['Dance 2']);
    expect(store.state.ownPoses.value[0].rotations[16 * 3 + 2]).toBeCloseTo(0.8, 5);
    store.placeFrame();
    expect(store.state.document.value.keyPoses.map(({ name }) => name)).toEqual(['Dance 2']);
    store.editFrame();
    expect(store.state.draft.value).toMatchObject({ name: 'Dance 2', keyId: null });
    store.closeDraft();
    expect(store.state.poseImport.value?.frame).toBe(1);
    store.closePoseImport();
    expect(store.state.poseImport.value).toBeNull();
  });

  it('says what is wrong, and leaves an open file open', async () => {
    const { store, notice } = page();
    await store.importPoseFile(bvh);
    for (const [name, content, message] of [
      ['a.bvh', 'nonsense', /“a.bvh” was not opened. This is no BVH file/],
      ['a.npz', 'nonsense', /no npz file/],
      ['a.glb', 'nonsense', /damaged/],
      ['a.bvh', '', /empty/],
      ['a.pkl', 'x', /\.npz/],
      ['a.fbx', 'x', /\.glb or \.bvh/],
    ] as const) {
      await store.importPoseFile(new File([content], name));
      expect(notice()).toMatchObject({ kind: 'error' });
      expect(notice().text).toMatch(message);
    }
    expect(store.state.poseImport.value?.file).toBe('Dance.BVH');
    expect(store.state.poseImportJob.value).toBeNull();
  });

  it('knows its files by their names', async () => {
    for (const name of ['a.bvh', 'A.NPZ', 'x.vrm', 'my-poses.json', 'my-poses (3).json', 'smpl.pkl']) {
      expect(isPoseFile({ name }), name).toBe(true);
    }
    for (const name of ['song.mp3', 'dance.posebeat', 'project.json', 'bvh', 'a.wav'])
      expect(isPoseFile({ name }), name).toBe(false);
    await expect(readPoseClips(new File(['x'], 'noname'))).rejects.toThrow(/\.bvh, \.npz/);
  });
});

describe('arrow keys in the grid', () => {
  // Three tiles a row; the first group has four, the second two.
  const places = [
    [0, 0],
    [100, 0],
    [200, 0],
    [0, 110],
    [0, 260],
    [100, 260],
  ].map(([left, top]) => ({ left, top }));
  it.each([
    [0, 'ArrowRight', 1],
    [2, 'ArrowRight', 3],
    [5, 'ArrowRight', 5],
    [0, 'ArrowLeft', 0],
    [2, 'ArrowDown', 3],
    [3, 'ArrowDown', 4],
    [5, 'ArrowUp', 3],
    [4, 'ArrowDown', 4],
    [1, 'ArrowUp', 1],
    [3, 'Home', 0],
    [0, 'End', 5],
    [0, 'x', -1],
  ])('from %i, %s goes to %i', (now, key, next) => expect(nextTile(places, now, key)).toBe(next));
});
