import { describe, expect, it } from 'vitest';
import { createStore } from '../../web/app/store';
import { Player } from '../../web/audio/player';
import { writeBvh } from '../../web/core/formats/bvh-write';
import { motionSamplers } from '../../web/core/formats/glb-motion';
import { writeGlb } from '../../web/core/formats/glb-write';
import { writeNpz } from '../../web/core/formats/npz-write';
import { parseDocument } from '../../web/core/document-read';
import { posesAtTimes, seedFromClip } from '../../web/core/import-motion';
import { headingOf } from '../../web/core/localframe';
import { framePose } from '../../web/core/motion';
import { angleBetween, axisAngleToQuaternion, multiply, poseToQuaternions } from '../../web/core/rotation';
import { seedMotion } from '../../web/core/seed';
import type { Motion } from '../../web/core/types';
import { stepClip, steadyGrid } from './dance';
import { fakeReporter, fakeServices } from './support/app';

/** Eight seconds of steps, turned away from the front by a quarter. */
function realDance(): Motion {
  const motion = seedMotion(stepClip(), steadyGrid(20, 120, 0), 240);
  const turn = axisAngleToQuaternion([0, Math.PI / 2, 0]);
  for (let t = 0; t < motion.frames; t++) {
    const at = t * 96;
    motion.quaternions.set(multiply(turn, motion.quaternions.subarray(at, at + 4)), at);
  }
  return motion;
}
const source = realDance();
const clip = { name: '', fps: 30, frames: source.frames, quaternions: source.quaternions };

describe('a real dance', () => {
  it('gives its poses at the beats, in real time, facing the front', () => {
    const times = [0.2, 1, 1.5, 2, 8, 9, 10];
    const found = posesAtTimes(clip, 30, times, 1);
    expect(found.map(({ time }) => time)).toEqual([1, 1.5, 2]);
    found.forEach(({ time, rotations }) => {
      const ours = poseToQuaternions(rotations);
      const theirs = framePose(source, time - 1 + 1).quaternions;
      for (let joint = 1; joint < 24; joint++) {
        const at = joint * 4;
        expect(angleBetween(ours.subarray(at, at + 4), theirs.subarray(at, at + 4))).toBeLessThan(1e-3);
      }
    });
    expect(headingOf(poseToQuaternions(found[0].rotations).subarray(0, 4))).toBeCloseTo(0, 4);
  });

  it('reaches its last frame', () => {
    const last = (source.frames - 1) / 30;
    expect(posesAtTimes(clip, 0, [0, last], 0)).toHaveLength(2);
    expect(() => posesAtTimes(clip, source.frames - 3, [0], 0)).toThrow('too little motion');
    expect(() => posesAtTimes({ ...clip, fps: 0 }, 0, [0], 0)).toThrow('too little motion');
  });

  it('becomes a starting clip that goes round, with its feet on the floor', () => {
    const seed = seedFromClip(clip, 0, 120, 'steps');
    expect(seed.poses).toHaveLength(64);
    expect(seed.id).toMatch(/^own-[0-9a-f]{12}$/);
    expect(seedFromClip(clip, 0, 120, 'steps').id).toBe(seed.id);
    expect(seedFromClip(clip, 7, 120, 'steps').id).not.toBe(seed.id);
    const motion = seedMotion(seed, steadyGrid(20, 120, 0), 300);
    let fastest = 0;
    for (let t = 1; t < motion.frames; t++) {
      for (let joint = 0; joint < 24; joint++) {
        const [a, b] = [(t - 1) * 96, t * 96].map((at) =>
          motion.quaternions.subarray(at + joint * 4, at + joint * 4 + 4),
        );
        fastest = Math.max(fastest, angleBetween(a, b));
      }
      for (let k = 0; k < 3; k++) {
        expect(Math.abs(motion.root[t * 3 + k] - motion.root[t * 3 - 3 + k])).toBeLessThan(0.1);
      }
    }
    // No jump at the seam.
    expect(fastest).toBeLessThan(0.6);
  });
});

/** A page with a song of ten seconds at 120 beats a minute. */
async function page() {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  services.assets.seeds = async () => [stepClip()];
  const store = createStore(services, fakeReporter());
  await store.start();
  await store.loadSong(new File(['song'], 'a song.mp3'));
  return { store };
}

const files: [string, () => BlobPart][] = [
  ['dance.bvh', () => writeBvh(source, { units: 'cm' })],
  ['dance.npz', () => writeNpz(source)],
  ['dance.glb', () => writeGlb({ name: 'dance', samplers: motionSamplers(source) })],
];

describe('the import panel', () => {
  it.each(files)('places the poses of %s on the beats: one step of undo', async (name, bytes) => {
    const { store } = await page();
    const still = new Array<number>(72).fill(0);
    store.setKeyPoses([
      { time: 1, rotations: still, locked: true },
      { time: 3, rotations: still },
      { time: 9.5, rotations: still },
    ]);
    await store.importPoseFile(new File([bytes()], name));
    expect(store.fileKeyCount('bar')).toEqual({ count: 4, from: 0, to: 6 });
    store.useFileAsDance('two');
    const keys = store.state.document.value.keyPoses;
    // The locked one keeps its frame, the one inside gives way, the one outside stays.
    expect(keys.map(({ time }) => time)).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 9.5]);
    expect(keys[1].locked).toBe(true);
    const third = poseToQuaternions(keys[3].rotations);
    const theirs = framePose(source, 3).quaternions;
    for (let joint = 1; joint < 24; joint++) {
      const at = joint * 4;
      expect(angleBetween(third.subarray(at, at + 4), theirs.subarray(at, at + 4))).toBeLessThan(1e-2);
    }
    expect(store.state.selection.value.size).toBe(7);
    store.undo();
    expect(store.state.document.value.keyPoses).toHaveLength(3);
  });

  it('takes a starting clip that the project keeps, and undo takes away', async () => {
    const { store } = await page();
    await store.importPoseFile(new File([writeBvh(source, { units: 'm' })], 'my steps.bvh'));
    store.useFileAsSeed();
    const { ownSeed, dials } = store.state.document.value;
    expect(ownSeed?.name).toBe('my steps');
    expect(dials.seedClip).toBe(ownSeed?.id);
    expect(store.state.seedClip.value).toBe(ownSeed);
    expect(store.state.seeds.value).toHaveLength(2);
    const { document, repairs } = parseDocument(JSON.parse(JSON.stringify(store.state.document.value)));
    expect(repairs).toEqual([]);
    expect(document.ownSeed).toEqual(ownSeed);
    store.undo();
    expect(store.state.seeds.value).toHaveLength(1);
    expect(store.state.seedClip.value?.id).toBe(stepClip().id);
  });

  it('says what is missing', async () => {
    const services = fakeServices(new Player(() => ({}) as AudioContext));
    const store = createStore(services, fakeReporter());
    await store.start();
    await store.importPoseFile(new File([writeBvh(source, { units: 'm' })], 'a.bvh'));
    expect(store.fileKeyCount('beat')).toBeNull();
    store.useFileAsDance('beat');
    expect(store.state.notices.value.at(-1)?.text).toContain('Drop a song first');
  });

  it('leaves out a damaged starting clip and opens the rest', () => {
    const { document, repairs } = parseDocument({
      format: 'posebeat',
      version: 2,
      song: null,
      ownSeed: { id: 'own-1', name: 'x', description: '', beats: 8, rate: 8, poses: [], root: [] },
    });
    expect(document.ownSeed).toBeUndefined();
    expect(repairs.join(' ')).toContain('starting clip');
  });
});
