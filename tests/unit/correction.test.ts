import { describe, expect, it } from 'vitest';
import { correctToKeys, keysOnFrames } from '../../web/core/correction';
import { consistencyError, jerkPerFrame } from '../../web/core/metrics';
import { sliceMotion } from '../../web/core/motion';
import { key, poseWith, swingingMotion } from './dance';

const pose = poseWith({ left_shoulder: [0, 0, -1.2], right_knee: [0.8, 0, 0], pelvis: [0, 0.5, 0] });

describe('exact keys', () => {
  it('belong to the nearest frame; the last one wins; those outside are dropped', () => {
    const frames = keysOnFrames(
      [key(0.017, pose), key(1, pose), key(1.001, poseWith({})), key(-1, pose), key(9, pose), key(2, pose)],
      30,
      60,
    );
    expect(frames.map((k) => k.frame)).toEqual([1, 30, 59]);
    expect(frames[1].quaternions[1]).toBe(0);
  });

  it('are hit exactly at strength 1, half-way at a half, not at all at 0', () => {
    const keys = [key(1, pose), key(1.4, poseWith({ spine1: [0.6, 0, 0] })), key(3, pose)];
    const before = consistencyError(swingingMotion(120), keys);
    for (const [strength, low, high] of [
      [1, 0, 1e-10],
      [0.5, before * 0.15, before * 0.4],
      [0, before, before],
    ]) {
      const motion = swingingMotion(120);
      correctToKeys(motion, keysOnFrames(keys, 30, 120), strength);
      const error = consistencyError(motion, keys);
      expect(error).toBeGreaterThanOrEqual(low);
      expect(error).toBeLessThanOrEqual(high);
    }
  });

  it('leave the rest of the dance alone and come and go without a pop', () => {
    const plain = swingingMotion(150);
    const motion = swingingMotion(150);
    correctToKeys(motion, keysOnFrames([key(2.5, pose)], 30, 150), 1);
    const same = (from: number, to: number) =>
      expect(sliceMotion(motion, from, to).quaternions).toEqual(sliceMotion(plain, from, to).quaternions);
    same(0, 54);
    same(97, 150);
    // The largest jerk of a C2 bump of a 1.2 rad turn over 0.7 s; a step would be in the tens of thousands.
    expect(Math.max(...jerkPerFrame(motion))).toBeLessThan(Math.max(...jerkPerFrame(plain)) + 150);
  });
});
