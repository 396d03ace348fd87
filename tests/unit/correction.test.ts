import { describe, expect, it } from 'vitest';
import { correctToKeys, keysOnFrames } from '../../web/core/correction';
import { consistencyError, jerkPerFrame } from '../../web/core/metrics';
import { emptyMotion, sliceMotion } from '../../web/core/motion';
import type { Motion } from '../../web/core/types';
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

  it('are hit as firmly as dial times key says', () => {
    const keys = [1, 0.5, 0, undefined].map((strength, i) => ({ ...key(i + 0.5, pose), strength }));
    const turn = (motion: Motion, t: number) => {
      const at = (t * 24 + 16) * 4;
      return 2 * Math.asin(motion.quaternions[at + 2]);
    };
    for (const dial of [1, 0.4, 0]) {
      const motion = emptyMotion(120);
      correctToKeys(motion, keysOnFrames(keys, 30, 120), dial);
      // From a T-pose the shoulder turns by its share of -1.2 radians exactly.
      const turns = [15, 45, 75, 105].map((t) => turn(motion, t));
      [1, 0.5, 0, 1].forEach((own, i) => expect(turns[i]).toBeCloseTo(-1.2 * own * dial, 6));
    }
    const [softened, dialled] = [emptyMotion(120), emptyMotion(120)];
    correctToKeys(softened, keysOnFrames([{ ...key(1, pose), strength: 0.25 }], 30, 120), 1);
    correctToKeys(dialled, keysOnFrames([key(1, pose)], 30, 120), 0.25);
    expect(softened.quaternions).toEqual(dialled.quaternions);
  });

  it('of a part of the dance touch nothing outside it and fade out towards its ends', () => {
    const motion = swingingMotion(120);
    correctToKeys(motion, keysOnFrames([key(1.1, pose), key(2, pose)], 30, 120), 1, { from: 30, to: 63 });
    const plain = swingingMotion(120);
    expect(sliceMotion(motion, 0, 30).quaternions).toEqual(sliceMotion(plain, 0, 30).quaternions);
    expect(sliceMotion(motion, 63, 120).quaternions).toEqual(sliceMotion(plain, 63, 120).quaternions);
    expect(consistencyError(motion, [key(1.1, pose), key(2, pose)])).toBeLessThan(1e-10);
    expect(sliceMotion(motion, 30, 31).quaternions).not.toEqual(sliceMotion(plain, 30, 31).quaternions);
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
