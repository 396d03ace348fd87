import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { centreOfMass, contacts, isBalanced, supportPolygon } from '../../web/core/balance';
import { axisAngleToQuaternion, poseToQuaternions, rotateVector } from '../../web/core/rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../../web/core/skeleton';
import { standingRoot } from '../../web/scene/body-points';

const rest = () => new Array<number>(JOINT_COUNT * 3).fill(0);
const stand = (pose: number[]) => {
  const quaternions = poseToQuaternions(pose);
  return forwardKinematics(quaternions, standingRoot(quaternions));
};
const names = (joints: Float32Array) => contacts(joints).sort((a, b) => a - b);
const feet = ['left_ankle', 'right_ankle', 'left_foot', 'right_foot'].map(jointIndex).sort((a, b) => a - b);

describe('the centre of mass', () => {
  it('is in the pelvis of somebody standing: 55 to 60 per cent of the height, in the middle', () => {
    const joints = stand(rest());
    const [x, y, z] = centreOfMass(joints);
    expect(x).toBeCloseTo(0, 6);
    expect(y).toBeGreaterThan(0.9);
    expect(y).toBeLessThan(1.1);
    expect(Math.abs(z)).toBeLessThan(0.05);
  });

  it('goes where the body goes', () => {
    fc.assert(
      fc.property(fc.array(fc.double({ min: -1, max: 1, noNaN: true }), { minLength: 6, maxLength: 6 }), (v) => {
        const joints = stand(rest().map((_, i) => Math.sin(i * 3.1 + v[0])));
        const turn = axisAngleToQuaternion(v.slice(0, 3));
        const moved = new Float32Array(joints.length);
        for (let i = 0; i < joints.length; i += 3)
          rotateVector(turn, joints.subarray(i, i + 3)).forEach((c, k) => (moved[i + k] = c + v[3 + k]));
        const expected = rotateVector(turn, centreOfMass(joints)).map((c, k) => c + v[3 + k]);
        centreOfMass(moved).forEach((c, k) => expect(c).toBeCloseTo(expected[k], 4));
      }),
    );
  });

  it('rises with the arms and moves aside with a leg', () => {
    const low = rest();
    low[jointIndex('left_shoulder') * 3 + 2] = -1.3;
    low[jointIndex('right_shoulder') * 3 + 2] = 1.3;
    const aside = rest();
    aside[jointIndex('left_hip') * 3 + 2] = 0.9;
    expect(centreOfMass(stand(low))[1]).toBeLessThan(centreOfMass(stand(rest()))[1] - 0.02);
    expect(centreOfMass(stand(aside))[0]).toBeGreaterThan(0.03);
  });
});

describe('what stands on the floor', () => {
  it('is both feet at rest, one foot with a leg lifted, nothing in the air', () => {
    expect(names(stand(rest()))).toEqual(feet);
    const lifted = rest();
    lifted[jointIndex('left_hip') * 3] = -1.5;
    expect(names(stand(lifted))).toEqual([jointIndex('right_ankle'), jointIndex('right_foot')]);
    const jump = stand(rest()).map((c, i) => (i % 3 === 1 ? c + 0.3 : c));
    expect(contacts(jump)).toEqual([]);
    expect(supportPolygon(jump)).toEqual([]);
    expect(isBalanced(jump)).toBe(false);
  });

  it('has a convex outline, counter-clockwise, about both feet', () => {
    const outline = supportPolygon(stand(rest()));
    expect(outline.length).toBeGreaterThan(3);
    outline.forEach((a, i) => {
      const b = outline[(i + 1) % outline.length];
      const c = outline[(i + 2) % outline.length];
      expect((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).toBeGreaterThan(0);
    });
    expect(Math.max(...outline.map(([x]) => x))).toBeGreaterThan(0.12);
    expect(Math.min(...outline.map(([x]) => x))).toBeLessThan(-0.12);
  });
});

describe('balance', () => {
  it('holds while standing, on one leg only over that leg, and not while tipping over', () => {
    expect(isBalanced(stand(rest()))).toBe(true);
    const leaning = rest();
    leaning[0] = 0.6; // the whole body tipped forwards, stiff as a board
    const joints = stand(leaning);
    expect(isBalanced(joints)).toBe(false);
    const oneLeg = rest();
    oneLeg[jointIndex('left_hip') * 3] = -1.5;
    expect(isBalanced(stand(oneLeg))).toBe(false); // the weight is between the feet, one of which is gone
    oneLeg[2] = 0.13; // leaning over to the standing leg
    expect(isBalanced(stand(oneLeg))).toBe(true);
  });
});
