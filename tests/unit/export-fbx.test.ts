import { readFileSync } from 'node:fs';
import { gunzipSync } from 'node:zlib';
import { AnimationMixer, Vector3 } from 'three';
import { FBXLoader } from 'three/examples/jsm/loaders/FBXLoader.js';
import { describe, expect, it, vi } from 'vitest';
import { writeMotionFile } from '../../web/app/motion-file';
import { estimateBytes, type MotionFileRequest } from '../../web/app/motion-formats';
import { JOINTS } from '../../web/core/skeleton';
import { buildFigure } from '../../web/scene/figure-asset';
import { figureForGlb } from '../../web/scene/figure-glb';
import { farthest, jointsOf, wildMotion } from './support/wild-motion';

const motion = wildMotion(61, 5);
const request: MotionFileRequest = { format: 'fbx', motion, fps: 30, units: 'cm', name: 'dance', notes: {} };

describe('FBX', () => {
  it('is the same dance in three, within a millimetre in every frame', async () => {
    // three's reader asks for a page that it does not use here.
    vi.stubGlobal('window', globalThis);
    const bytes = await writeMotionFile(request);
    expect(new TextDecoder().decode(bytes.subarray(0, 18))).toBe('Kaydara FBX Binary');
    const scene = new FBXLoader().parse(bytes.buffer, '');
    const [clip] = scene.animations;
    expect(clip.duration).toBeCloseTo((motion.frames - 1) / motion.fps, 4);
    const mixer = new AnimationMixer(scene);
    mixer.clipAction(clip).play();
    let most = 0;
    for (let frame = 0; frame < motion.frames; frame++) {
      mixer.setTime(Math.min(frame / motion.fps, clip.duration - 1e-6));
      scene.updateMatrixWorld(true);
      const places = JOINTS.flatMap((name) => scene.getObjectByName(name)!.getWorldPosition(new Vector3()).toArray());
      most = Math.max(most, farthest(places, jointsOf(motion, frame)));
    }
    expect(most).toBeLessThan(1e-3);
    vi.unstubAllGlobals();
  });

  it('takes the figure along', async () => {
    const packed = readFileSync(new URL('../../web/scene/figure.bin', import.meta.url));
    const figure = figureForGlb(buildFigure(gunzipSync(packed)));
    const bytes = await writeMotionFile({ ...request, figure });
    const bare = await writeMotionFile(request);
    expect(bytes.length).toBeGreaterThan(bare.length + 500_000);
    expect(Math.abs(estimateBytes('fbx', 61, true) / bytes.length - 1)).toBeLessThan(1 / 3);
    const scene = (vi.stubGlobal('window', globalThis), new FBXLoader().parse(bytes.buffer, ''));
    let vertices = 0;
    scene.traverse((each) => {
      const mesh = each as unknown as {
        isSkinnedMesh?: boolean;
        geometry: { attributes: { position: { count: number } } };
      };
      if (mesh.isSkinnedMesh) vertices += mesh.geometry.attributes.position.count;
    });
    expect(vertices).toBeGreaterThan(figure.positions.length / 3);
    vi.unstubAllGlobals();
  });
});
