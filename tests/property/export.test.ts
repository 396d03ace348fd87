/** Any motion through our writers and back through our readers. */
import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { readBvh } from '../../web/core/formats/bvh-read';
import { writeBvh } from '../../web/core/formats/bvh-write';
import { motionSamplers } from '../../web/core/formats/glb-motion';
import { writeGlb } from '../../web/core/formats/glb-write';
import { readGltf } from '../../web/core/formats/gltf-read';
import { readMotionJson, writeMotionJson } from '../../web/core/formats/motion-json';
import { readNpz } from '../../web/core/formats/npz-read';
import { writeNpz } from '../../web/core/formats/npz-write';
import { resampleMotion } from '../../web/core/motion-resample';
import { forwardKinematics } from '../../web/core/skeleton';
import type { Motion } from '../../web/core/types';
import { farthest, wildMotion } from '../unit/support/wild-motion';

// Made inside of the property: a failure prints these three numbers and not the dance.
const motions = fc.record({
  seed: fc.integer({ min: 0, max: 2 ** 31 - 1 }),
  frames: fc.integer({ min: 1, max: 40 }),
  fps: fc.constantFrom(24, 30, 60, 120),
});
type Choice = { seed: number; frames: number; fps: number };
const made = ({ seed, frames, fps }: Choice): Motion => wildMotion(frames, seed, fps);

/** Joint positions round the pelvis, whatever the reader makes of its place. */
const joints = ({ quaternions }: { quaternions: Float32Array }, frame: number) =>
  forwardKinematics(quaternions.subarray(frame * 96, frame * 96 + 96), [0, 0, 0]);

function expectSame(back: { frames: number; fps: number; quaternions: Float32Array }, motion: Motion, within = 1e-3) {
  expect(back.frames).toBe(motion.frames);
  if (motion.frames > 1) expect(back.fps).toBeCloseTo(motion.fps, 4);
  for (let frame = 0; frame < motion.frames; frame++) {
    expect(farthest(joints(back, frame), joints(motion, frame))).toBeLessThan(within);
  }
}

describe('any motion', () => {
  it('comes back from BVH, in metres and centimetres', () => {
    fc.assert(
      fc.property(motions, fc.constantFrom('m', 'cm'), (choice, units) => {
        const motion = made(choice);
        expectSame(readBvh(writeBvh(motion, { units: units as 'm' | 'cm' })).clips[0], motion);
      }),
      { numRuns: 40 },
    );
  });

  it('comes back from npz', () => {
    fc.assert(
      fc.property(motions, (choice) => {
        const motion = made(choice);
        expectSame(readNpz(writeNpz(motion)).clips[0], motion);
      }),
      { numRuns: 40 },
    );
  });

  it('comes back from GLB, at the rate at which it is read', () => {
    fc.assert(
      fc.property(motions, (choice) => {
        const motion = made(choice);
        const atReader = motion.fps === 30 ? motion : resampleMotion(motion, 30);
        const [clip] = readGltf(writeGlb({ name: 'any', samplers: motionSamplers(motion) })).clips;
        // One frame is a pose, not an animation.
        if (motion.frames > 1) expectSame(clip, atReader);
      }),
      { numRuns: 40 },
    );
  });

  it('comes back from JSON with its places', () => {
    fc.assert(
      fc.property(motions, (choice) => {
        const motion = made(choice);
        const { motion: back } = readMotionJson(writeMotionJson(motion));
        expectSame(back, motion);
        for (let i = 0; i < motion.root.length; i++) expect(back.root[i]).toBeCloseTo(motion.root[i], 5);
      }),
      { numRuns: 40 },
    );
  });
});
