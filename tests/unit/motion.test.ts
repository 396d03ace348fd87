import { describe, expect, it } from 'vitest';
import { alignSigns, emptyMotion, framePose, motionToAxisAngle, sliceMotion } from '../../web/core/motion';
import { axisAngleToQuaternion } from '../../web/core/rotation';

function turning(): ReturnType<typeof emptyMotion> {
  const motion = emptyMotion(4);
  for (let t = 0; t < 4; t++) {
    motion.root.set([t, 1, -t], t * 3);
    motion.quaternions.set(Array.from(axisAngleToQuaternion([0, 0.4 * t, 0])), t * 96);
  }
  return motion;
}

describe('a motion', () => {
  it('is sampled between its frames', () => {
    const pose = framePose(turning(), 1.5 / 30);
    expect(pose.root[0]).toBeCloseTo(1.5, 6);
    expect(pose.quaternions[1]).toBeCloseTo(Math.sin(0.3), 6);
  });

  it('holds its first and last frame', () => {
    const motion = turning();
    expect(framePose(motion, -5).root[0]).toBe(0);
    expect(framePose(motion, 99).root[0]).toBe(3);
    expect(framePose(motion, NaN).root[0]).toBe(0);
    expect(framePose(sliceMotion(motion, 2, 3), 1).root[0]).toBe(2);
    expect(() => framePose(emptyMotion(0), 0)).toThrow('no frames');
  });

  it('reuses the pose it is given', () => {
    const pose = framePose(turning(), 0);
    expect(framePose(turning(), 0.05, pose)).toBe(pose);
  });

  it('is cut and clamped', () => {
    const part = sliceMotion(turning(), 1, 99);
    expect([part.frames, part.root[0], part.root.length, part.quaternions.length]).toEqual([3, 1, 9, 288]);
    expect(sliceMotion(turning(), 3, 1).frames).toBe(0);
  });

  it('becomes axis-angle', () => {
    const rotations = motionToAxisAngle(turning());
    expect(rotations.length).toBe(4 * 72);
    expect(rotations[3 * 72 + 1]).toBeCloseTo(1.2, 5);
  });

  it('gets quaternions whose signs agree from frame to frame', () => {
    const motion = turning();
    for (let i = 96; i < 100; i++) motion.quaternions[i] *= -1;
    alignSigns(motion);
    expect(motion.quaternions[99]).toBeGreaterThan(0);
  });
});
