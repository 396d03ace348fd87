import { describe, expect, it } from 'vitest';
import { poseToQuaternions } from '../../web/core/rotation';
import { forwardKinematics, jointIndex, MIRROR, mirrorPose, worldRotations } from '../../web/core/skeleton';
import { spec, specHash, canonicalJson } from '../../web/core/spec';
import { sha256Hex } from '../../web/core/spec-hash';
import { poseWith } from './dance';

const at = (positions: Float32Array, name: string) =>
  Array.from(positions.subarray(jointIndex(name) * 3, jointIndex(name) * 3 + 3), (v) => Math.round(v * 1e5) / 1e5);

describe('the skeleton', () => {
  it('stands in a T-pose with its toes at rest height', () => {
    const positions = forwardKinematics(poseToQuaternions(poseWith({})), [0, 0.955, 0]);
    expect(at(positions, 'left_foot')).toEqual([0.12, spec.skeleton.toeHeight, 0.08]);
    expect(at(positions, 'right_foot')).toEqual([-0.12, spec.skeleton.toeHeight, 0.08]);
    expect(at(positions, 'left_hand')[0]).toBeCloseTo(0.8, 5);
  });

  it('bends a knee backwards with a positive turn about x', () => {
    const positions = forwardKinematics(poseToQuaternions(poseWith({ left_knee: [Math.PI / 2, 0, 0] })), [0, 0.955, 0]);
    expect(at(positions, 'left_ankle')[2]).toBeLessThan(-0.35);
    expect(at(positions, 'right_ankle')[2]).toBeCloseTo(-0.04, 5);
  });

  it('hands rotations down the tree', () => {
    const turns = worldRotations(poseToQuaternions(poseWith({ pelvis: [0, 1, 0], left_shoulder: [0, 0.5, 0] })));
    const elbow = Array.from(turns.subarray(jointIndex('left_elbow') * 4, jointIndex('left_elbow') * 4 + 4));
    expect(elbow[1]).toBeCloseTo(Math.sin(0.75), 6);
  });

  it('mirrors a pose to the other side, and back', () => {
    const pose = poseWith({ pelvis: [0.1, 0.4, 0.2], left_shoulder: [0.3, -0.2, 1], right_knee: [0.9, 0, 0.1] });
    const mirrored = mirrorPose(pose);
    const a = forwardKinematics(poseToQuaternions(pose), [0, 1, 0]);
    const b = forwardKinematics(poseToQuaternions(mirrored), [0, 1, 0]);
    MIRROR.forEach((other, joint) => {
      expect(b[joint * 3]).toBeCloseTo(-a[other * 3], 5);
      expect(b[joint * 3 + 1]).toBeCloseTo(a[other * 3 + 1], 5);
      expect(b[joint * 3 + 2]).toBeCloseTo(a[other * 3 + 2], 5);
    });
    expect(mirrorPose(mirrored)).toEqual(pose);
  });

  it('names a joint that does not exist', () => {
    expect(() => jointIndex('tail')).toThrow('"tail"');
  });
});

describe('the spec hash', () => {
  it('is SHA-256 of canonical JSON', () => {
    expect(sha256Hex('abc')).toBe('ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad');
    expect(sha256Hex('a'.repeat(200))).toBe('c2a908d98f5df987ade41b5fce213067efbcc21ef2240212a41e54b5e7c28ae5');
    expect(canonicalJson({ b: [1, { d: 0.5, c: 'x' }], a: null })).toBe('{"a":null,"b":[1,{"c":"x","d":0.5}]}');
    expect(specHash).toMatch(/^[0-9a-f]{64}$/);
  });
});
