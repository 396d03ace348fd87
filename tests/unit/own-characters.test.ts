import { describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import { createApi } from '../../web/app/api';
import { gltfParts } from '../../web/app/avatar-file';
import { MAX_AVATAR_BYTES, noAvatarStore, type AvatarStore, type KeptAvatar } from '../../web/app/avatar-store';
import { createStore } from '../../web/app/store';
import { openAvatar } from '../../web/scene/avatar';
import { readAvatarRig } from '../../web/core/avatar/rig';
import { guessBones } from '../../web/core/avatar/guess';
import { jointIndex } from '../../web/core/skeleton';
import { REST_HEIGHT } from '../../web/core/rest';
import { fitPath } from '../../web/video/dancer-path';
import { fakeReporter, fakeServices } from './support/app';
import { anonymousGlb, chairGlb, mixamoGlb, mixamoName, vrm1File } from './support/avatar-rigs';

/** A browser that keeps things while the test runs. */
function memory(): AvatarStore & { files: Map<string, Uint8Array> } {
  const avatars = new Map<string, KeptAvatar>();
  const files = new Map<string, Uint8Array>();
  let chosen: string | null = null;
  return {
    files,
    load: async () => ({ avatars: [...avatars.values()], chosen }),
    bytes: async (id) => files.get(id) ?? null,
    put: async (avatar, bytes) => {
      avatars.set(avatar.id, avatar);
      if (bytes) files.set(avatar.id, bytes);
      return [];
    },
    remove: async (id) => {
      avatars.delete(id);
      files.delete(id);
    },
    choose: async (id) => void (chosen = id),
  };
}

function page(avatarStore: AvatarStore = memory()) {
  const store = createStore({ ...fakeServices(new Player(() => ({}) as AudioContext)), avatarStore }, fakeReporter());
  const words = () => store.state.notices.value.map(({ text }) => text).join(' ');
  return { store, state: store.state, api: createApi(store, Promise.resolve()), words };
}

const file = (bytes: Uint8Array<ArrayBuffer>, name: string) => new File([bytes], name);
const at = (joints: Float32Array, joint: string) =>
  Array.from(joints.subarray(jointIndex(joint) * 3, jointIndex(joint) * 3 + 3));

describe('characters of one’s own', () => {
  it('dance, are kept, and are there again on the next visit', async () => {
    const browser = memory();
    const first = page(browser);
    await first.store.openCharacter(file(mixamoGlb(), 'Robo.glb'));
    expect(first.state.avatar.value?.name).toBe('Robo');
    expect(first.words()).toContain('“Robo” dances now.');
    await vi.waitFor(async () => expect((await browser.load()).chosen).not.toBeNull());
    const second = page(browser);
    await second.store.restoreAvatar();
    expect(second.state.avatar.value?.name).toBe('Robo');
    expect(second.state.avatar.value?.source.map).toEqual(first.state.avatar.value?.source.map);
    await second.store.removeAvatar(second.state.avatar.value!.id);
    expect(second.state.avatar.value).toBeNull();
    expect(browser.files.size).toBe(0);
    const undo = second.state.notices.value.find(({ action }) => action?.label === 'Keep it')!;
    undo.action!.run();
    await vi.waitFor(() => expect(second.state.avatar.value?.name).toBe('Robo'));
  });

  it('dance where the browser keeps nothing, and say so once', async () => {
    const { store, state, words } = page(noAvatarStore());
    await store.restoreAvatar();
    await store.openCharacter(file(mixamoGlb(), 'a.glb'));
    await vi.waitFor(() => expect(words()).toContain('does not keep your character'));
    const id = state.avatar.value!.id;
    await store.useAvatar(null);
    expect(state.avatar.value).toBeNull();
    await store.useAvatar(id);
    expect(state.avatar.value?.id).toBe(id);
  });

  it.each([
    ['broken.glb', () => mixamoGlb().slice(0, 900), /damaged|not copied completely/],
    ['words.glb', () => new TextEncoder().encode('hello'), /no glTF or VRM file/],
    ['empty.glb', () => new Uint8Array(0), /empty/],
    ['chair.glb', () => chairGlb(), /./],
    ['bare.glb', () => mixamoGlb({ bare: true }), /no character in it/],
  ])('%s is refused with a sentence, and nothing changes', async (name, make, message) => {
    const { store, state, words } = page();
    await store.openCharacter(file(vrm1File(), 'good.vrm'));
    const before = state.avatar.value;
    await store.openCharacter(file(make() as Uint8Array<ArrayBuffer>, name));
    expect(words()).toContain(`“${name}” was not opened.`);
    expect(state.notices.value.find(({ text }) => text.includes(name))!.text).toMatch(message);
    expect(state.avatar.value).toBe(before);
    expect(state.avatars.value).toHaveLength(1);
    expect(state.avatarJob.value).toBeNull();
  });

  it('is refused when it is too large, before it is read', async () => {
    const { store, words } = page();
    const big = file(new Uint8Array(8), 'big.vrm');
    Object.defineProperty(big, 'size', { value: MAX_AVATAR_BYTES + 1e6 });
    await store.openCharacter(big);
    expect(words()).toContain('It has 101 MB, and at most 100');
  });

  it('asks for the bones that names do not tell; Cancel leaves everything as it was', async () => {
    const { store, state } = page();
    await store.openCharacter(file(mixamoGlb(), 'first.glb'));
    const before = state.avatar.value;
    await store.openCharacter(file(anonymousGlb(), 'strange.glb'));
    expect(state.avatarMapping.value?.byShape).toBe(true);
    const knee = jointIndex('left_knee');
    const guess = state.avatarMapping.value!.map[knee];
    store.chooseBone(knee, -1);
    expect(state.avatarMapping.value).toMatchObject({ usable: false });
    expect(state.avatarMapping.value!.problems[knee]).toMatch(/knee/i);
    store.acceptBones();
    expect(state.avatarMapping.value).not.toBeNull();
    store.guessBones();
    expect(state.avatarMapping.value!.map[knee]).toBe(guess);
    store.cancelBones();
    expect(state.avatarMapping.value).toBeNull();
    expect(state.avatar.value).toBe(before);
    expect(state.avatars.value).toHaveLength(1);
    await store.openCharacter(file(anonymousGlb(), 'strange.glb'));
    store.acceptBones();
    expect(state.avatar.value?.name).toBe('strange');
    // The next time nothing is asked.
    await store.useAvatar(null);
    await store.openCharacter(file(anonymousGlb(), 'strange.glb'));
    expect(state.avatarMapping.value).toBeNull();
    expect(state.avatar.value?.name).toBe('strange');
  });

  it('asks about one character at a time, and frees one that is passed over', async () => {
    const { store, state } = page();
    await store.openCharacter(file(anonymousGlb(), 'one.glb'));
    const first = vi.spyOn(state.avatarMapping.value!.figure, 'dispose');
    await store.openCharacter(file(anonymousGlb(), 'two.glb'));
    expect(state.avatarMapping.value?.name).toBe('two');
    expect(first).toHaveBeenCalledTimes(1);
    const second = vi.spyOn(state.avatarMapping.value!.figure, 'dispose');
    await store.setAvatar(file(mixamoGlb(), 'sure.glb'));
    expect(state.avatarMapping.value).toBeNull();
    expect(second).toHaveBeenCalledTimes(1);
    await store.checkBones();
    const third = vi.spyOn(state.avatar.value!.figure, 'dispose');
    await store.useAvatar(null);
    expect(state.avatarMapping.value).toBeNull();
    expect(third).toHaveBeenCalledTimes(1);
  });

  it('says only of the one that dances that its bones can be checked', async () => {
    const { store, words } = page();
    await store.openCharacter(file(mixamoGlb(), 'Robo.glb'));
    await store.openCharacter(file(vrm1File(), 'Box.vrm'));
    expect(words()).toBe('“Box” dances now.');
    await store.useAvatar(null);
    expect(words()).toBe('');
  });

  it('gives a character in use its bones back when the question is left', async () => {
    const { store, state } = page();
    await store.openCharacter(file(mixamoGlb(), 'a.glb'));
    const { figure, source } = state.avatar.value!;
    figure.show({ root: [0, REST_HEIGHT, 0], quaternions: tPose });
    const wrist = at(figure.pose.joints, 'left_wrist');
    await store.checkBones();
    store.chooseBone(jointIndex('left_wrist'), source.map[jointIndex('head')]);
    expect(at(figure.pose.joints, 'left_wrist')).not.toEqual(wrist);
    store.cancelBones();
    expect(at(figure.pose.joints, 'left_wrist')).toEqual(wrist);
  });

  it('are set by scripts, with bones by name', async () => {
    const { api, state } = page();
    const bytes = mixamoGlb({ name: (key) => (key === 'leftShin' ? 'Flügel' : mixamoName(key)) });
    await expect(api.setAvatar(file(bytes, 'x.glb'), { bones: { left_knee: 'nothing' } })).rejects.toThrow(
      'no bone "nothing"',
    );
    expect(state.avatar.value).toBeNull();
    await expect(api.setAvatar(file(bytes, 'x.glb'), { bones: { left_knee: 'Flügel' } })).resolves.toMatchObject({
      name: 'x',
    });
    expect(api.avatar()).toMatchObject({ name: 'x' });
    await expect(api.exportAs('avatar')).rejects.toThrow('no dance yet');
    await expect(api.setAvatar(null)).resolves.toBeNull();
    expect(api.avatar()).toBeNull();
  });

  it('a file that is a character and a motion is asked about, one that is either is not', async () => {
    const { store, state } = page();
    const motions: string[] = [];
    const open = (bytes: Uint8Array<ArrayBuffer>, name: string) =>
      store.openGltf(file(bytes, name), (each: File) => motions.push(each.name));
    const animated = (json: object) => Object.assign(json, { animations: [{ channels: [], samplers: [] }] });
    await open(mixamoGlb({ edit: animated }), 'both.glb');
    expect(state.avatarQuestion.value?.name).toBe('both.glb');
    expect(state.avatar.value).toBeNull();
    await open(mixamoGlb({ bare: true, edit: animated }), 'motion.glb');
    expect(motions).toEqual(['motion.glb']);
    await open(mixamoGlb(), 'character.glb');
    expect(state.avatar.value?.name).toBe('character');
  });
});

const tPose = Float32Array.from({ length: 96 }, (_, i) => (i % 4 === 3 ? 1 : 0));

describe('the file', () => {
  const rewritten = (change: object) =>
    new TextEncoder().encode(JSON.stringify({ asset: { version: '2.0' }, ...change }));

  it.each([
    [{ extensionsRequired: ['KHR_draco_mesh_compression'] }, 'Draco'],
    [{ extensionsRequired: ['KHR_texture_basisu'] }, 'KTX2'],
    [{ images: [{ uri: 'https://example.org/track.png' }] }, 'other files'],
    [{ buffers: [{ uri: 'body.bin', byteLength: 4 }] }, 'other files'],
  ])('%j is refused with what to do', (change, word) => {
    expect(() => gltfParts(rewritten(change))).toThrow(word);
  });

  it('becomes a figure whose T-pose stands on the floor, of its own size', async () => {
    for (const bytes of [mixamoGlb(), vrm1File()]) {
      const { bones } = guessBones(readAvatarRig(bytes));
      const figure = await openAvatar({ bytes, name: 'x', map: bones });
      figure.show({ root: [0, REST_HEIGHT, 0], quaternions: tPose });
      const { joints } = figure.pose;
      expect(at(joints, 'left_foot')[1]).toBeGreaterThan(0);
      expect(at(joints, 'left_foot')[1]).toBeLessThan(0.08);
      expect(at(joints, 'left_wrist')[0]).toBeGreaterThan(0.4);
      expect(at(joints, 'head')[1]).toBeGreaterThan(figure.height * 0.6);
      expect(at(joints, 'head')[1]).toBeLessThan(figure.height);
      figure.dispose();
    }
  });
});

describe('the camera of a film', () => {
  const path = () => ({
    position: Float32Array.of(2, 1.5, 7),
    target: Float32Array.of(2, 1, 3),
    centre: Float32Array.of(2, 3),
  });
  const small = { size: 0.5, stride: 0.6 };

  it('stands before a small dancer as it would before our figure', () => {
    const { position, target, centre } = fitPath(path(), small, null);
    const rounded = (values: Float32Array) => Array.from(values, (value) => Number(value.toFixed(5)));
    expect(rounded(centre)).toEqual([1.2, 1.8]);
    expect(rounded(target)).toEqual([1.2, 0.5, 1.8]);
    expect(rounded(position)).toEqual([1.2, 0.75, 3.8]);
    expect(fitPath(path(), { size: 1, stride: 1 }, null)).toEqual(path());
  });

  it('keeps the visitor’s own view, which goes with the dancer or stands still', () => {
    const view = { position: [0, 1.5, 4] as [number, number, number], target: [0, 1, 0] as [number, number, number] };
    const going = fitPath(path(), small, { ...view, follows: true });
    expect(going.target[0]).toBeCloseTo(1.2, 5);
    expect(going.position[2] - going.target[2]).toBeCloseTo(4, 5);
    expect(going.position[1]).toBeCloseTo(1.5, 5);
    const still = fitPath(path(), small, { ...view, follows: false });
    expect(still.position).toEqual(path().position);
  });
});
