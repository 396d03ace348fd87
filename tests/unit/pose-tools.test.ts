import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import * as T from '../../web/core/pose-tools';
import { angleBetween, axisAngleToQuaternion, rotateVector } from '../../web/core/rotation';
import { JOINT_COUNT, jointIndex, JOINTS, MIRROR, mirrorPose } from '../../web/core/skeleton';

const REST = new Array<number>(72).fill(0);
const free = (_: number, q: ArrayLike<number>) => q;
/** A pose from joint names and turns. */
function pose(turns: Record<string, [number, number, number]>): number[] {
  const rotations = [...REST];
  for (const [name, turn] of Object.entries(turns)) rotations.splice(jointIndex(name) * 3, 3, ...turn);
  return rotations;
}
const at = (rotations: readonly number[], name: string) =>
  rotations.slice(jointIndex(name) * 3, jointIndex(name) * 3 + 3);
const turn = (rotations: readonly number[], joint: number) =>
  axisAngleToQuaternion(rotations.slice(joint * 3, joint * 3 + 3));

const anyPose = fc
  .array(fc.double({ min: -1, max: 1, noNaN: true }), { minLength: 72, maxLength: 72 })
  .map((numbers) => numbers.map((number) => number + 0));

describe('limbs', () => {
  it('hold every joint but the pelvis exactly once', () => {
    const members = Object.values(T.LIMBS).flat();
    expect([...members].sort((a, b) => a - b)).toEqual(Array.from({ length: JOINT_COUNT - 1 }, (_, i) => i + 1));
    expect(T.limbOf(0)).toBeNull();
    expect(T.limbOf(jointIndex('right_elbow'))).toBe('right_arm');
  });

  it('are copied, also mirrored onto the other side, and nothing else changes', () => {
    const from = pose({ left_shoulder: [0.1, 0.2, 0.3], left_hand: [0, -0.5, 0], head: [1, 0, 0] });
    const to = pose({ right_shoulder: [9, 9, 9], right_knee: [1, 0, 0] });
    const same = T.copyLimb(from, to, 'left_arm');
    expect(at(same, 'left_shoulder')).toEqual([0.1, 0.2, 0.3]);
    expect(at(same, 'right_shoulder')).toEqual([9, 9, 9]);
    const other = T.copyLimb(from, to, 'left_arm', 'right_arm');
    expect(at(other, 'right_shoulder')).toEqual([0.1, -0.2, -0.3]);
    expect(at(other, 'right_hand')).toEqual([0, 0.5, 0]);
    expect(at(other, 'left_shoulder')).toEqual([0, 0, 0]);
    expect(at(other, 'right_knee')).toEqual([1, 0, 0]);
    expect(at(other, 'head')).toEqual([0, 0, 0]);
    expect(() => T.copyLimb(from, to, 'left_arm', 'left_leg')).toThrow('A left_arm does not fit onto a left_leg.');
  });

  it('mirrored one by one make the whole figure the same on both sides', () => {
    fc.assert(
      fc.property(anyPose, (rotations) => {
        const symmetric = T.mirrorLimb(T.mirrorLimb(rotations, 'left_arm'), 'left_leg');
        const mirrored = mirrorPose(symmetric);
        for (const limb of ['left_arm', 'right_arm', 'left_leg', 'right_leg'] as const)
          for (const joint of T.LIMBS[limb])
            expect(mirrored.slice(joint * 3, joint * 3 + 3)).toEqual(symmetric.slice(joint * 3, joint * 3 + 3));
      }),
    );
  });

  it('of the middle are mirrored in place', () => {
    expect(at(T.mirrorLimb(pose({ head: [0.1, 0.4, -0.2] }), 'head'), 'head')).toEqual([0.1, -0.4, 0.2]);
  });
});

describe('mirrored editing', () => {
  it('gives the other side the same, and leaves the middle alone', () => {
    fc.assert(
      fc.property(anyPose, fc.integer({ min: 0, max: 23 }), (rotations, joint) => {
        const next = T.mirrorJointEdit(rotations, joint);
        const other = MIRROR[joint] * 3;
        expect(next.slice(joint * 3, joint * 3 + 3)).toEqual(rotations.slice(joint * 3, joint * 3 + 3));
        if (MIRROR[joint] === joint) expect(next).toEqual(rotations);
        else expect(next.slice(other, other + 3)).toEqual(mirrorPose(rotations).slice(other, other + 3));
      }),
    );
  });
});

describe('resetting', () => {
  it('puts joints to rest and keeps where the figure looks', () => {
    const bent = T.turnPose(pose({ pelvis: [0.4, 0, 0], left_elbow: [0, -1, 0], neck: [0.1, 0, 0] }), 1);
    const next = T.resetJoints(bent, [0, jointIndex('left_elbow')]);
    expect(at(next, 'left_elbow')).toEqual([0, 0, 0]);
    expect(at(next, 'neck')).toEqual([0.1, 0, 0]);
    at(next, 'pelvis').forEach((value, axis) => expect(value).toBeCloseTo([0, 1, 0][axis], 9));
  });
});

describe('blending', () => {
  it('gives the ends exactly and half of an angle in the middle', () => {
    const a = pose({ left_shoulder: [0, 0, 0.2] });
    const b = pose({ left_shoulder: [0, 0, 1], right_knee: [0.6, 0, 0] });
    expect(T.blendPoses(a, b, 0)).toEqual(a);
    expect(T.blendPoses(a, b, 1)).toEqual(b);
    expect(T.blendPoses(a, b, -3)).toEqual(a);
    const half = T.blendPoses(a, b, 0.5);
    expect(at(half, 'left_shoulder')[2]).toBeCloseTo(0.6, 12);
    expect(at(half, 'right_knee')[0]).toBeCloseTo(0.3, 12);
  });

  it('turns every joint in proportion to the amount', () => {
    fc.assert(
      fc.property(anyPose, anyPose, fc.double({ min: 0.01, max: 0.99, noNaN: true }), (a, b, amount) => {
        const mixed = T.blendPoses(a, b, amount);
        for (let joint = 0; joint < JOINT_COUNT; joint++) {
          const whole = angleBetween(turn(a, joint), turn(b, joint));
          if (whole > 3.1) continue;
          expect(angleBetween(turn(a, joint), turn(mixed, joint))).toBeCloseTo(amount * whole, 5);
        }
      }),
    );
  });
});

describe('turning and standing', () => {
  it('turns the whole figure about the vertical', () => {
    fc.assert(
      fc.property(
        fc.double({ min: -1, max: 1, noNaN: true }),
        fc.double({ min: -1.5, max: 1.5, noNaN: true }),
        (tilt, by) => {
          const tilted = pose({ pelvis: [tilt, 0, 0], left_hip: [0.3, 0, 0] });
          const turned = T.turnPose(tilted, by);
          expect(T.headingOfPose(turned)).toBeCloseTo(by, 6);
          expect(at(turned, 'left_hip')).toEqual([0.3, 0, 0]);
          at(T.turnPose(turned, -by), 'pelvis').forEach((v, axis) => expect(v).toBeCloseTo(tilted[axis], 9));
        },
      ),
    );
  });

  it('stands upright with the same heading', () => {
    const upright = T.standUpright(T.turnPose(pose({ pelvis: [0.5, 0, 0.2] }), 0.7));
    expect(rotateVector(turn(upright, 0), [0, 1, 0])[1]).toBeCloseTo(1, 12);
    expect(T.headingOfPose(upright)).toBeCloseTo(T.headingOfPose(T.turnPose(pose({ pelvis: [0.5, 0, 0.2] }), 0.7)), 12);
  });

  it('reads and sets a joint in the world', () => {
    fc.assert(
      fc.property(anyPose, fc.integer({ min: 0, max: 23 }), (rotations, joint) => {
        const wanted = axisAngleToQuaternion([0.2, 0.5, -0.4]);
        const next = T.withWorldTurn(rotations, joint, wanted);
        expect(angleBetween(T.worldTurn(next, joint), wanted)).toBeLessThan(1e-6);
        for (let other = 0; other < 72; other++)
          if (Math.floor(other / 3) !== joint) expect(next[other]).toBe(rotations[other]);
      }),
    );
  });
});

describe('levelling feet', () => {
  const sole = (rotations: readonly number[], side: string) =>
    rotateVector(T.worldTurn(rotations, jointIndex(`${side}_ankle`)), [0, 1, 0]);

  it('puts both soles flat after a plié, toes straight, feet pointing as before', () => {
    const bent = pose({
      left_hip: [-0.6, 0.2, 0.1],
      left_knee: [1, 0, 0],
      right_hip: [-0.6, -0.2, -0.1],
      right_knee: [1, 0, 0],
      left_foot: [0.4, 0, 0],
    });
    expect(sole(bent, 'left')[1]).toBeLessThan(0.95);
    const level = T.levelFeet(bent);
    for (const side of ['left', 'right']) expect(sole(level, side)[1]).toBeCloseTo(1, 9);
    expect(at(level, 'left_foot')).toEqual([0, 0, 0]);
    expect(at(level, 'left_knee')).toEqual([1, 0, 0]);
  });

  it('leaves a raised foot its point, and stops where the ankle does', () => {
    const kick = pose({ left_hip: [-1.4, 0, 0], left_ankle: [0.6, 0, 0], right_ankle: [0.3, 0, 0] });
    const level = T.levelFeet(kick);
    expect(at(level, 'left_ankle')).toEqual([0.6, 0, 0]);
    expect(at(level, 'right_ankle').every((value) => Math.abs(value) < 1e-9)).toBe(true);
    const stiff = T.levelFeet(kick, () => axisAngleToQuaternion([0.1, 0, 0]));
    expect(at(stiff, 'right_ankle')[0]).toBeCloseTo(0.1, 12);
  });
});

describe('a random variation', () => {
  it('is the same for the same seed, another for another, and none at amount 0', () => {
    const base = pose({ left_shoulder: [0, 0, -1] });
    expect(T.randomPose(base, 0.5, 7, free)).toEqual(T.randomPose(base, 0.5, 7, free));
    expect(T.randomPose(base, 0.5, 7, free)).not.toEqual(T.randomPose(base, 0.5, 8, free));
    expect(T.randomPose(base, 0, 7, free)).toEqual(base);
  });

  it('keeps heading and flat feet, and moves arms more than the spine', () => {
    const moved = (name: string) => {
      let sum = 0;
      for (let seed = 0; seed < 40; seed++)
        sum += angleBetween([0, 0, 0, 1], turn(T.randomPose(REST, 0.5, seed, free), jointIndex(name)));
      return sum;
    };
    expect(moved('left_shoulder')).toBeGreaterThan(3 * moved('spine1'));
    for (let seed = 0; seed < 20; seed++) {
      const varied = T.randomPose(T.turnPose(REST, 0.8), 1, seed, free);
      expect(T.headingOfPose(varied)).toBeCloseTo(0.8, 9);
      const up = rotateVector(T.worldTurn(varied, jointIndex('right_ankle')), [0, 1, 0]);
      expect(up[1]).toBeCloseTo(1, 6);
    }
  });

  it('asks the limits about every joint but the pelvis', () => {
    const asked = new Set<number>();
    const still = T.randomPose(REST, 1, 3, (joint) => {
      asked.add(joint);
      return [0, 0, 0, 1];
    });
    expect(asked.size).toBe(JOINTS.length - 1);
    expect(still.slice(3)).toEqual(REST.slice(3));
  });
});

describe('limits', () => {
  it('touch only joints that are outside and say which', () => {
    const rotations = pose({ left_elbow: [0, -1, 0], right_elbow: [0, 2, 0], pelvis: [3, 0, 0] });
    const clamp = (joint: number, q: ArrayLike<number>) =>
      joint === jointIndex('right_elbow') ? axisAngleToQuaternion([0, 1.5, 0]) : q;
    const { rotations: next, limited } = T.limitPose(rotations, clamp);
    expect(limited).toEqual([jointIndex('right_elbow')]);
    expect(at(next, 'right_elbow')[1]).toBeCloseTo(1.5, 12);
    expect(next.filter((value, i) => value !== rotations[i])).toHaveLength(1);
  });
});
