import { describe, expect, it } from 'vitest';
import { beatHitRate, consistencyError, footSkate, meanJerk, motionBeats, smoothness } from '../../web/core/metrics';
import { emptyMotion } from '../../web/core/motion';
import { axisAngleToQuaternion } from '../../web/core/rotation';
import { jointIndex } from '../../web/core/skeleton';
import { key, poseWith } from './dance';

/** An elbow whose angle is a function of the frame. */
function elbow(frames: number, angle: (t: number) => number) {
  const motion = emptyMotion(frames);
  for (let t = 0; t < frames; t++) {
    motion.root.set([0, 0.955, 0], t * 3);
    motion.quaternions.set(
      Array.from(axisAngleToQuaternion([0, 0, angle(t)])),
      (t * 24 + jointIndex('left_elbow')) * 4,
    );
  }
  return motion;
}

describe('measures', () => {
  it('consistency error is the squared distance of the 6D numbers', () => {
    const motion = elbow(30, () => 0);
    // A quarter turn about z: column 0 (1,0,0) -> (0,1,0), column 1 (0,1,0) -> (-1,0,0): 2 + 2.
    const wrong = poseWith({ left_elbow: [0, 0, Math.PI / 2] });
    expect(consistencyError(motion, [key(0.5, wrong)])).toBeCloseTo(4, 5);
    expect(consistencyError(motion, [key(0.5, wrong), key(0.1, poseWith({}))])).toBeCloseTo(2, 5);
    expect(consistencyError(motion, [])).toBeNaN();
  });

  it('a steady slide has no jerk and a known skate', () => {
    const motion = elbow(60, () => 0);
    for (let t = 0; t < 60; t++) motion.root[t * 3] = t * 0.01;
    expect(meanJerk(motion)).toBeLessThan(1e-2);
    expect(footSkate(motion)).toBeCloseTo(0.3, 4);
    // 59 differences: x grows by 0.01 in one of 147 numbers.
    const mean = 0.01 / 147;
    expect(smoothness(motion)).toBeCloseTo(Math.sqrt(0.01 ** 2 / 147 - mean ** 2) / mean, 3);
  });

  it('feet in the air do not skate', () => {
    const motion = elbow(30, () => 0);
    for (let t = 0; t < 30; t++) motion.root.set([t * 0.1, 1.2, 0], t * 3);
    expect(footSkate(motion)).toBeNaN();
  });

  it('motion beats are where the limbs turn round', () => {
    // Angle = cos(2 pi t / 30): it stands still at t = 0, 15, 30, 45 ...
    const motion = elbow(91, (t) => Math.cos((2 * Math.PI * t) / 30));
    const beats = motionBeats(motion);
    expect(beats.map((b) => Math.round(b * 30))).toEqual([15, 30, 45, 60, 75]);
    expect(beatHitRate(motion, [0.5, 1, 1.75, 99], 1)).toBeCloseTo(2 / 3, 9);
    expect(beatHitRate(motion, [1.75], 5)).toBe(0);
    expect(beatHitRate(motion, [], 1)).toBeNaN();
  });
});
