import { readFileSync } from 'node:fs';
import { gunzipSync } from 'node:zlib';
import { validateBytes } from 'gltf-validator';
import { AnimationMixer, Vector3, type SkinnedMesh } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { describe, expect, it } from 'vitest';
import { motionSamplers } from '../../web/core/formats/glb-motion';
import { writeGlb } from '../../web/core/formats/glb-write';
import { readGltf } from '../../web/core/formats/gltf-read';
import { buildFigure } from '../../web/scene/figure-asset';
import { figureForGlb } from '../../web/scene/figure-glb';
import { SkinPose } from '../../web/scene/skin-bones';
import { helperSamplers } from '../../web/scene/skin-samplers';
import { frameView } from '../../web/core/motion';
import { poseToQuaternions } from '../../web/core/rotation';
import { swingingMotion } from './dance';
import { noise } from './support/wild-motion';

const asset = buildFigure(gunzipSync(readFileSync(new URL('../../web/scene/figure.bin', import.meta.url))));
const figure = figureForGlb(asset);
/** Poses as bodies have them: the skin's split of twist and swing is not made for half turns. */
const motion = swingingMotion(16);
const random = noise(4);
for (let frame = 0; frame < 16; frame += 5) {
  const pose = Array.from({ length: 72 }, () => (random() - 0.5) * 1.6);
  motion.quaternions.set(poseToQuaternions(pose), frame * 96);
}
const bytes = writeGlb({ name: 'dance', samplers: [...motionSamplers(motion), ...helperSamplers(motion)], figure });

describe('GLB of the figure', () => {
  it('is valid to Khronos’ validator', async () => {
    const { issues } = await validateBytes(bytes, { maxIssues: 50 });
    expect(issues.messages).toEqual([]);
    expect(issues.numErrors + issues.numWarnings).toBe(0);
  });

  it('moves its skin in three as on the stage, within a millimetre', async () => {
    const { scene, animations } = await new GLTFLoader().parseAsync(bytes.buffer, '');
    const meshes: SkinnedMesh[] = [];
    scene.traverse((each) => (each as SkinnedMesh).isSkinnedMesh && meshes.push(each as SkinnedMesh));
    expect(meshes).toHaveLength(figure.parts.length);
    const mixer = new AnimationMixer(scene);
    mixer.clipAction(animations[0]).play();
    const stage = new SkinPose();
    const { array: bones } = asset.geometry.getAttribute('skinIndex');
    const count = figure.positions.length / 3;
    let most = 0;
    for (const frame of [0, 3, 5, 10, 15]) {
      mixer.setTime(Math.min(frame / 30, animations[0].duration - 1e-7));
      scene.updateMatrixWorld(true);
      meshes[0].skeleton.update();
      const { quaternions, root } = frameView(motion, frame);
      stage.set(quaternions, root);
      for (let v = 0; v < count; v += 37) {
        const theirs = meshes[0].applyBoneTransform(v, new Vector3().fromArray(figure.positions, v * 3));
        const ours = new Vector3();
        for (let slot = 0; slot < 4; slot++) {
          const weight = figure.weights[v * 4 + slot];
          const m = stage.matrices.subarray(bones[v * 4 + slot] * 16, bones[v * 4 + slot] * 16 + 16);
          const [x, y, z] = figure.positions.subarray(v * 3, v * 3 + 3);
          ours.x += weight * (m[0] * x + m[4] * y + m[8] * z + m[12]);
          ours.y += weight * (m[1] * x + m[5] * y + m[9] * z + m[13]);
          ours.z += weight * (m[2] * x + m[6] * y + m[10] * z + m[14]);
        }
        most = Math.max(most, theirs.distanceTo(ours));
      }
    }
    expect(most).toBeLessThan(1e-3);
  });

  it('is painted: left cool, right warm, a dark visor', () => {
    const colour = (test: (x: number, y: number, z: number) => boolean) => {
      for (let v = 0; v < figure.positions.length; v += 3) {
        const [x, y, z] = figure.positions.subarray(v, v + 3);
        if (test(x, y, z)) return [...figure.colours.subarray((v / 3) * 4, (v / 3) * 4 + 3)];
      }
      throw new Error('No such vertex.');
    };
    const left = colour((x) => x > 0.8);
    const right = colour((x) => x < -0.8);
    expect(left[2]).toBeGreaterThan(left[0] * 2);
    expect(right[0]).toBeGreaterThan(right[2] * 2);
    const visor = figure.parts[1].triangles[0];
    expect(Math.max(...figure.colours.subarray(visor * 4, visor * 4 + 3))).toBeLessThan(5);
  });

  it('is read back by our own reader as the joints’ dance', () => {
    const [clip] = readGltf(bytes).clips;
    expect(clip.frames).toBe(16);
  });
});
