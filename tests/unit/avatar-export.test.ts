import { validateBytes } from 'gltf-validator';
import { AnimationMixer, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { avatarGlb } from '../../web/core/avatar/export';
import { glbChunks } from '../../web/core/formats/gltf-file';
import { readGltf } from '../../web/core/formats/gltf-read';
import { emptyMotion } from '../../web/core/motion';
import type { Motion } from '../../web/core/types';
import { anonymousGlb, mixamoGlb, vrm0File, vrm1File } from './support/avatar-rigs';
import { loadGlb, objectsOf, stageAvatar } from './support/avatar-stage';
import { wildMotion } from './support/wild-motion';

const motion = wildMotion(61, 3);
const options = { name: 'Dance of boxes', extras: { motionHash: 'abc' } };

/** The same file as .gltf text with its numbers in it. */
function asText(bytes: Uint8Array): Uint8Array<ArrayBuffer> {
  const { text, binary } = glbChunks(bytes);
  const json = JSON.parse(text) as { buffers: { uri?: string }[] };
  json.buffers[0].uri = `data:application/octet-stream;base64,${Buffer.from(binary!).toString('base64')}`;
  return new TextEncoder().encode(JSON.stringify(json));
}

const FILES: [string, () => Uint8Array<ArrayBuffer>][] = [
  ['Mixamo', () => mixamoGlb()],
  ['VRM 0', () => vrm0File()],
  ['VRM 1', () => vrm1File()],
  ['without names', () => anonymousGlb()],
  ['matrices', () => mixamoGlb({ matrices: true })],
];

describe.each(FILES)('an avatar’s file with the dance in it (%s)', (_, file) => {
  it('plays in three within a millimetre of what is live, every frame', async () => {
    const original = file();
    const { retargeter, show, gltf: live } = await stageAvatar(original);
    const made = await loadGlb(avatarGlb(original, retargeter, motion, options));
    expect(made.animations[0].name).toBe(options.name);
    expect(made.animations[0].duration).toBeCloseTo(2, 6);
    const mixer = new AnimationMixer(made.scene);
    mixer.clipAction(made.animations[0]).play();
    const [liveObjects, objects] = [objectsOf(live), objectsOf(made)];
    let most = 0;
    for (let frame = 0; frame < motion.frames; frame++) {
      show(motion, frame);
      // The last instant would wrap round to the first.
      mixer.setTime(Math.min(frame / motion.fps, 2 - 1e-7));
      made.scene.updateMatrixWorld(true);
      for (const node of retargeter.nodes) {
        const [a, b] = [liveObjects, objects].map((all) =>
          new Vector3().setFromMatrixPosition(all.get(node)!.matrixWorld),
        );
        most = Math.max(most, a.distanceTo(b));
      }
    }
    expect(most).toBeLessThan(1e-3);
  });

  it('is valid, and nothing else in it is touched', async () => {
    const original = file();
    const { retargeter } = await stageAvatar(original);
    const made = avatarGlb(original, retargeter, motion, options);
    const errors = async (bytes: Uint8Array) => (await validateBytes(bytes, { maxIssues: 50 })).issues;
    expect((await errors(original)).numErrors).toBe(0);
    expect((await errors(made)).messages.filter(({ severity }) => severity === 0)).toEqual([]);
    const [before, after] = [original, made].map(
      (bytes) => JSON.parse(glbChunks(bytes).text) as Record<string, never[]>,
    );
    for (const part of Object.keys(before)) {
      if (part === 'buffers') continue;
      if (part === 'nodes' && before.nodes.some((node) => 'matrix' in (node as object))) continue;
      const kept = Array.isArray(before[part]) ? after[part].slice(0, before[part].length) : after[part];
      expect(kept).toEqual(before[part]);
    }
    expect((after.animations[0] as { extras: unknown }).extras).toEqual(options.extras);
    const old = glbChunks(original).binary;
    if (old) expect(Buffer.compare(glbChunks(made).binary!.subarray(0, old.length), old)).toBe(0);
  });
});

describe('the file with the dance', () => {
  it('is made of a text with its numbers in it too, the same dance', async () => {
    const original = vrm1File();
    const { retargeter } = await stageAvatar(original);
    const [plain, text] = [original, asText(original)].map((bytes) => avatarGlb(bytes, retargeter, motion, options));
    expect((await validateBytes(text, { maxIssues: 50 })).issues.numErrors).toBe(0);
    expect(readGltf(text).clips[0].quaternions).toEqual(readGltf(plain).clips[0].quaternions);
  });

  it('keeps the animations that were there, behind ours', async () => {
    const original = mixamoGlb();
    const { retargeter } = await stageAvatar(original);
    const once = avatarGlb(original, retargeter, motion, { name: 'first' });
    const twice = avatarGlb(once, (await stageAvatar(once)).retargeter, motion, { name: 'second' });
    expect((await loadGlb(twice)).animations.map(({ name }) => name)).toEqual(['second', 'first']);
  });

  it('is read by our own import', async () => {
    const original = vrm1File();
    const { retargeter } = await stageAvatar(original);
    const { clips, kind } = readGltf(avatarGlb(original, retargeter, motion, options));
    expect(kind).toBe('VRM');
    expect(clips[0].frames).toBe(motion.frames);
  });

  it('needs a dance and the file that belongs to it', async () => {
    const original = mixamoGlb();
    const { retargeter } = await stageAvatar(original);
    const make = (bytes: Uint8Array, dance: Motion) => () => avatarGlb(bytes, retargeter, dance, options);
    expect(make(original, emptyMotion(0))).toThrow('no frames');
    expect(make(new TextEncoder().encode('{"nodes":[]}'), motion)).toThrow('damaged');
    expect(make(original.slice(0, 2000), motion)).toThrow('damaged');
  });
});
