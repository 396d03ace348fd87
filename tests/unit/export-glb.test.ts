import { validateBytes } from 'gltf-validator';
import { AnimationMixer, Vector3, type Object3D } from 'three';
import { GLTFLoader, type GLTF } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { describe, expect, it } from 'vitest';
import { readGltf } from '../../web/core/formats/gltf-read';
import { frameTimes, motionSamplers } from '../../web/core/formats/glb-motion';
import { writeGlb, type GlbSampler } from '../../web/core/formats/glb-write';
import { emptyMotion } from '../../web/core/motion';
import { REST } from '../../web/core/rest';
import { angleBetween, axisAngleToQuaternion } from '../../web/core/rotation';
import { JOINT_COUNT, JOINTS } from '../../web/core/skeleton';
import { farthest, jointsOf, wildMotion } from './support/wild-motion';

const load = (bytes: Uint8Array<ArrayBuffer>): Promise<GLTF> => new GLTFLoader().parseAsync(bytes.buffer, '');

/** World places of our joints in three's scene, 24 x 3. */
function places(scene: Object3D): number[] {
  scene.updateMatrixWorld(true);
  return JOINTS.flatMap((name) => scene.getObjectByName(name)!.getWorldPosition(new Vector3()).toArray());
}

async function issuesOf(bytes: Uint8Array) {
  const { issues } = await validateBytes(bytes, { maxIssues: 100 });
  return issues;
}

describe('GLB of the skeleton', () => {
  const motion = wildMotion(91, 7);
  const bytes = writeGlb({ name: 'wild', samplers: motionSamplers(motion), extras: { song: 'a “song”' } });

  it('is valid to Khronos’ validator: no errors, no warnings', async () => {
    const issues = await issuesOf(bytes);
    expect(issues.messages.filter(({ code }) => code !== 'UNUSED_OBJECT')).toEqual([]);
    expect(issues.numErrors + issues.numWarnings).toBe(0);
  });

  it('is the same dance in three, within a millimetre in every frame', async () => {
    const { scene, animations } = await load(bytes);
    expect(animations).toHaveLength(1);
    expect(animations[0].name).toBe('wild');
    expect(animations[0].duration).toBeCloseTo(3, 6);
    const mixer = new AnimationMixer(scene);
    mixer.clipAction(animations[0]).play();
    let most = 0;
    for (let frame = 0; frame < motion.frames; frame++) {
      // The last instant would wrap round to the first.
      mixer.setTime(Math.min(frame / motion.fps, animations[0].duration - 1e-7));
      most = Math.max(most, farthest(places(scene), jointsOf(motion, frame)));
    }
    expect(most).toBeLessThan(1e-3);
  });

  it('holds as many keys as the dance has frames, the first and the last pose exactly', async () => {
    const { animations } = await load(bytes);
    for (const track of animations[0].tracks) {
      expect(track.times).toHaveLength(motion.frames);
      const [name, property] = track.name.split('.');
      const joint = JOINTS.indexOf(name);
      for (const frame of [0, motion.frames - 1]) {
        if (property === 'position') {
          expect([...track.values.subarray(frame * 3, frame * 3 + 3)]).toEqual([
            ...motion.root.subarray(frame * 3, frame * 3 + 3),
          ]);
        } else {
          const at = (frame * JOINT_COUNT + joint) * 4;
          const theirs = track.values.subarray(frame * 4, frame * 4 + 4);
          expect(angleBetween(theirs, motion.quaternions.subarray(at, at + 4))).toBeLessThan(1e-6);
        }
      }
    }
  });

  it('rests in the T-pose, standing on the floor', async () => {
    const { scene } = await load(writeGlb({ name: 'rest', samplers: [] }));
    expect(farthest(places(scene), REST)).toBeLessThan(1e-6);
  });

  it('is read back by our own reader', () => {
    const { clips } = readGltf(bytes);
    expect(clips[0].frames).toBe(motion.frames);
    expect(clips[0].fps).toBeCloseTo(motion.fps, 6);
    for (let i = 0; i < motion.frames * JOINT_COUNT; i++) {
      const [a, b] = [clips[0], motion].map(({ quaternions }) => quaternions.subarray(i * 4, i * 4 + 4));
      expect(angleBetween(a, b)).toBeLessThan(2e-3);
    }
  });

  it('keeps one key of a joint that never moves', () => {
    const samplers = motionSamplers(emptyMotion(50));
    expect(samplers[0].times).toHaveLength(50);
    expect(samplers.slice(1).every(({ times }) => times.length === 1)).toBe(true);
  });
});

describe('GLB of curves', () => {
  it('carries cubic splines as they are', async () => {
    const times = Float32Array.of(0, 1, 2.5);
    const flat = [0, 0, 0, 0];
    const keys = [0, 0.8, -0.4].map((angle) => axisAngleToQuaternion([0, angle, 0]));
    const cubic: GlbSampler = {
      joint: 15,
      path: 'rotation',
      times,
      values: Float32Array.from(keys.flatMap((key) => [...flat, ...key, ...flat])),
      interpolation: 'CUBICSPLINE',
    };
    const bytes = writeGlb({ name: 'curves', samplers: [cubic] });
    expect((await issuesOf(bytes)).numErrors).toBe(0);
    const { scene, animations } = await load(bytes);
    const mixer = new AnimationMixer(scene);
    mixer.clipAction(animations[0]).play();
    mixer.setTime(1);
    expect(angleBetween(scene.getObjectByName('head')!.quaternion.toArray(), keys[1])).toBeLessThan(1e-6);
    // Flat tangents: half-way in time is half-way between the two values (appendix C).
    mixer.setTime(0.5);
    expect(
      angleBetween(scene.getObjectByName('head')!.quaternion.toArray(), axisAngleToQuaternion([0, 0.4, 0])),
    ).toBeLessThan(1e-6);
  });

  it('says what is wrong with a sampler', () => {
    const good = motionSamplers(wildMotion(5, 1))[1];
    const refused = (change: Partial<GlbSampler>) => () => writeGlb({ name: 'x', samplers: [{ ...good, ...change }] });
    expect(refused({})).not.toThrow();
    expect(refused({ joint: 24 })).toThrow('no such joint');
    expect(refused({ interpolation: 'CUBICSPLINE' })).toThrow('12 a time');
    expect(refused({ times: Float32Array.of(0, 1, 1, 2, 3) })).toThrow('ascend');
    expect(refused({ values: good.values.map(() => NaN) as Float32Array })).toThrow('not finite');
    expect(() => writeGlb({ name: 'x', samplers: [good, good] })).toThrow('twice');
    expect(() => motionSamplers(wildMotion(0, 1), frameTimes({ frames: 0, fps: 30 }))).toThrow('no frames');
  });
});
