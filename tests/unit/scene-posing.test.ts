import { describe, expect, it } from 'vitest';
import { forwardKinematics, JOINT_COUNT, jointIndex, PARENTS, worldRotations } from '../../web/core/skeleton';
import { angleBetween, axisAngleToQuaternion, multiply, poseToQuaternions } from '../../web/core/rotation';
import { createIkSolver } from '../../web/core/ik';
import { withinLimits } from '../../web/core/joint-limits';
import { CAPSULES, pickBody, placePoint, rayCapsule, standingRoot, SUPPORTS } from '../../web/scene/body-points';
import { FkTurn } from '../../web/scene/fk-turn';
import { Footing } from '../../web/scene/footing';
import { headingOf } from '../../web/scene/heading';
import { IkDrag, reachPose } from '../../web/scene/ik-drag';
import { jointLabel, PoseEdit, rotateLocal } from '../../web/scene/pose-edit';
import { REST_HEIGHT } from '../../web/scene/rest';

const rest = () => new Array<number>(JOINT_COUNT * 3).fill(0);
const bent = () => {
  const pose = rest();
  pose[jointIndex('left_shoulder') * 3 + 2] = -0.7;
  pose[jointIndex('left_elbow') * 3 + 1] = -0.9;
  pose[1] = 0.6;
  return pose;
};

describe('turning a joint', () => {
  it('composes on the right: about the joint own axes, leaving every other joint alone', () => {
    const quaternions = poseToQuaternions(bent());
    const before = quaternions.slice();
    const world = worldRotations(before);
    const joint = jointIndex('left_elbow');
    rotateLocal(quaternions, joint, 'x', 0.5);
    const expected = multiply(before.subarray(joint * 4, joint * 4 + 4), axisAngleToQuaternion([0.5, 0, 0]));
    expect(angleBetween(quaternions.subarray(joint * 4, joint * 4 + 4), expected)).toBeLessThan(1e-6);
    // In the world that is a turn about the joint's own, posed x axis.
    const after = worldRotations(quaternions);
    const own = multiply(world.subarray(joint * 4, joint * 4 + 4), axisAngleToQuaternion([0.5, 0, 0]));
    expect(angleBetween(after.subarray(joint * 4, joint * 4 + 4), own)).toBeLessThan(1e-6);
    for (let other = 0; other < JOINT_COUNT; other++)
      if (other !== joint)
        expect(quaternions.slice(other * 4, other * 4 + 4)).toEqual(before.slice(other * 4, other * 4 + 4));
  });

  it('tells each change in phases and takes a cancelled one back exactly', () => {
    const edit = new PoseEdit();
    edit.load(bent());
    const turn = (axis: 'x' | 'z', radians: number) => {
      const next = edit.quaternions.slice();
      rotateLocal(next, 4, axis, radians);
      edit.setAll(next);
    };
    const heard: string[] = [];
    const poses: number[][] = [];
    edit.listen((rotations, phase) => {
      heard.push(phase);
      poses.push(rotations);
    });
    turn('x', 0.3);
    turn('x', 0.3);
    edit.commit();
    expect(heard).toEqual(['start', 'change', 'change', 'commit']);
    expect(poses[3][12]).toBeCloseTo(0.6, 5);
    turn('z', 1);
    edit.cancel();
    expect(heard.slice(4)).toEqual(['start', 'change', 'cancel']);
    expect(poses[6]).toEqual(poses[3]);
    edit.commit();
    edit.cancel();
    expect(heard).toHaveLength(7);
    expect(poses[0][12]).toBeCloseTo(0, 6);
  });

  it('names joints in plain words', () => {
    expect(jointLabel(jointIndex('left_elbow'))).toBe('Left elbow');
    expect(jointLabel(jointIndex('right_foot'))).toBe('Right toes');
    expect(jointLabel(0)).toBe('Hips (whole body)');
  });
});

describe('turning a joint within its limits', () => {
  const elbow = jointIndex('left_elbow');
  const shoulder = jointIndex('left_shoulder');
  const part = (edit: PoseEdit, joint: number) => edit.quaternions.slice(joint * 4, joint * 4 + 4);
  const far = axisAngleToQuaternion([0, 2.5, 0]);

  it('stops at the limit, unless limits are off or the joint was past it before', () => {
    const edit = new PoseEdit();
    const turn = new FkTurn(edit);
    turn.start(elbow);
    turn.to(elbow, far, { limits: true, mirror: false });
    expect(withinLimits(elbow, part(edit, elbow))).toBe(true);
    expect(angleBetween(part(edit, elbow), far)).toBeGreaterThan(0.5);
    turn.to(elbow, far, { limits: false, mirror: false });
    expect(angleBetween(part(edit, elbow), far)).toBeLessThan(1e-3);
    edit.commit();
    turn.start(elbow);
    turn.to(elbow, far, { limits: true, mirror: false });
    expect(angleBetween(part(edit, elbow), far)).toBeLessThan(1e-3);
  });

  it('gives the other side its mirror image when asked to, and leaves it alone otherwise', () => {
    const edit = new PoseEdit();
    const turn = new FkTurn(edit);
    const q = axisAngleToQuaternion([0.2, -0.3, 0.4]);
    const other = jointIndex('right_shoulder');
    turn.start(shoulder);
    turn.to(shoulder, q, { limits: false, mirror: false });
    expect([...part(edit, other)]).toEqual([0, 0, 0, 1]);
    turn.to(shoulder, q, { limits: false, mirror: true });
    expect(angleBetween(part(edit, other), [q[0], -q[1], -q[2], q[3]])).toBeLessThan(1e-3);
  });
});

describe('standing on the floor', () => {
  it('puts the rest pose at its own height', () => {
    const [x, y, z] = standingRoot(poseToQuaternions(rest()));
    expect([x, z]).toEqual([0, 0]);
    expect(y).toBeCloseTo(REST_HEIGHT, 5);
  });

  it('puts the lowest point of any pose at 0', () => {
    for (let seed = 0; seed < 30; seed++) {
      const pose = rest().map((_, i) => 1.3 * Math.sin(seed * 12.9 + i * 7.7));
      const quaternions = poseToQuaternions(pose);
      const root = standingRoot(quaternions);
      const joints = forwardKinematics(quaternions, root);
      const rotations = worldRotations(quaternions);
      const heights = SUPPORTS.map((s) => placePoint(s, joints, rotations)[1] - s.radius);
      expect(Math.min(...heights)).toBeCloseTo(0, 5);
    }
  });

  it('stands on the other foot when one leg is lifted', () => {
    const pose = rest();
    pose[jointIndex('left_hip') * 3] = -1.5;
    expect(standingRoot(poseToQuaternions(pose))[1]).toBeCloseTo(REST_HEIGHT, 5);
  });
});

describe('picking', () => {
  const joints = forwardKinematics(poseToQuaternions(rest()), [0, REST_HEIGHT, 0]);
  const rotations = worldRotations(poseToQuaternions(rest()));
  const toMiddle = (a: string, b: string) => {
    const [i, j] = [jointIndex(a) * 3, jointIndex(b) * 3];
    const target = [0, 1, 2].map((k) => (joints[i + k] + joints[j + k]) / 2);
    const origin = [0.4, 1.2, 4];
    const d = target.map((c, k) => c - origin[k]);
    const length = Math.hypot(...d);
    return pickBody(
      origin,
      d.map((c) => c / length),
      joints,
      rotations,
    );
  };

  it('selects the joint that turns the limb', () => {
    expect(toMiddle('left_shoulder', 'left_elbow')).toBe(jointIndex('left_shoulder'));
    expect(toMiddle('right_elbow', 'right_wrist')).toBe(jointIndex('right_elbow'));
    expect(toMiddle('left_hip', 'left_knee')).toBe(jointIndex('left_hip'));
    expect(toMiddle('right_knee', 'right_ankle')).toBe(jointIndex('right_knee'));
    expect(pickBody([0, 3, 4], [0, 0, -1], joints, rotations)).toBeNull();
  });

  it('covers every part of the body with a joint that exists', () => {
    for (const { joint, from } of CAPSULES) {
      expect(joint).toBeGreaterThanOrEqual(0);
      expect(PARENTS[from.joint]).toBeLessThan(JOINT_COUNT);
    }
  });

  it('measures the distance to a capsule', () => {
    expect(rayCapsule([0, 0, 5], [0, 0, -1], [-1, 0, 0], [1, 0, 0], 0.5)).toBeCloseTo(4.5, 6);
    expect(rayCapsule([0, 2, 5], [0, 0, -1], [-1, 0, 0], [1, 0, 0], 0.5)).toBeUndefined();
    expect(rayCapsule([0, 0, 5], [0, 0, 1], [-1, 0, 0], [1, 0, 0], 0.5)).toBeUndefined();
    expect(rayCapsule([0, 0, 5], [0, 0, -1], [0, 0, 0], [0, 0, 0], 0.5)).toBeCloseTo(4.5, 6);
  });
});

describe('heading', () => {
  it('is the direction of the pelvis on the floor', () => {
    for (const angle of [-3, -1, 0, 0.4, 2.5]) {
      const pose = rest();
      pose[1] = angle;
      expect(headingOf(poseToQuaternions(pose))).toBeCloseTo(angle, 5);
    }
  });

  it('is where the head points for someone lying on the belly', () => {
    const pose = rest();
    pose[0] = Math.PI / 2;
    expect(headingOf(poseToQuaternions(pose))).toBeCloseTo(0, 5);
  });
});

describe('dragging with the body following', () => {
  const tools = { limits: true, mirror: false, pins: new Set<number>() };
  const stand = (pose: number[] = rest()) => {
    const quaternions = poseToQuaternions(pose);
    return { root: standingRoot(quaternions), quaternions };
  };
  const places = (pose: { root: ArrayLike<number>; quaternions: ArrayLike<number> }) =>
    forwardKinematics(pose.quaternions, pose.root);
  const at = (joints: Float32Array, name: string) => Array.from(joints.subarray(jointIndex(name) * 3).subarray(0, 3));
  const gap = (a: ArrayLike<number>, b: ArrayLike<number>) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  const follow = (drag: IkDrag, way: [number, number, number], steps = 30) => {
    for (let i = 1; i <= steps + 20; i++) drag.to(drag.from.map((c, k) => c + (way[k] * Math.min(i, steps)) / steps));
  };

  it('takes a hand along and leaves the feet on the floor where they are', () => {
    const start = stand();
    const before = places(start);
    const drag = new IkDrag(createIkSolver(), start, jointIndex('left_wrist'), tools);
    follow(drag, [-0.3, 0.25, 0.35]);
    const after = places(drag.pose);
    expect(
      gap(
        at(after, 'left_wrist'),
        drag.from.map((c, k) => c + [-0.3, 0.25, 0.35][k]),
      ),
    ).toBeLessThan(0.01);
    for (const ankle of ['left_ankle', 'right_ankle'])
      expect(gap(at(after, ankle), at(before, ankle))).toBeLessThan(0.002);
    expect(drag.settled).toBe(true);
  });

  it('squats on flat feet when the hips are pulled down, and kept, nothing jumps', () => {
    const start = stand();
    const before = places(start);
    const drag = new IkDrag(createIkSolver(), start, 0, tools);
    follow(drag, [0.04, -0.35, 0]);
    const after = places(drag.pose);
    for (const name of ['left_ankle', 'right_ankle', 'left_foot', 'right_foot'])
      expect(gap(at(after, name), at(before, name)), name).toBeLessThan(0.015);
    expect(drag.pose.root[1]).toBeCloseTo(start.root[1] - 0.35, 2);
    const footing = new Footing(false);
    footing.settle(drag.pose.root);
    expect(gap(footing.root(drag.pose.quaternions), drag.pose.root)).toBeLessThan(1e-6);
    for (let i = 0; i < 30; i++) footing.update(1 / 60);
    expect(footing.settling).toBe(false);
    expect(gap(footing.root(drag.pose.quaternions), drag.pose.root)).toBeLessThan(0.02);
    footing.reset();
    expect(footing.root(drag.pose.quaternions)[0]).toBe(0);
  });

  it('moves both sides alike when mirrored', () => {
    const drag = new IkDrag(createIkSolver(), stand(), jointIndex('left_wrist'), { ...tools, mirror: true });
    follow(drag, [-0.25, 0.3, 0.2]);
    const joints = places(drag.pose);
    const [left, right] = [at(joints, 'left_wrist'), at(joints, 'right_wrist')];
    expect(gap([-left[0], left[1], left[2]], right)).toBeLessThan(0.01);
  });

  it('turns the elbow about the arm while the hand stays', () => {
    const start = stand(bent());
    const before = places(start);
    const drag = new IkDrag(createIkSolver(), start, jointIndex('left_elbow'), tools);
    follow(drag, [0, 0.3, -0.1]);
    const after = places(drag.pose);
    expect(gap(at(after, 'left_wrist'), at(before, 'left_wrist'))).toBeLessThan(0.002);
    expect(at(after, 'left_elbow')[1]).toBeGreaterThan(at(before, 'left_elbow')[1] + 0.03);
  });

  it('holds what is pinned', () => {
    const start = stand();
    const wrist = jointIndex('right_wrist');
    const drag = new IkDrag(createIkSolver(), start, 0, { ...tools, pins: new Set([wrist]) });
    follow(drag, [0, -0.2, 0.05]);
    expect(gap(at(places(drag.pose), 'right_wrist'), at(places(start), 'right_wrist'))).toBeLessThan(0.01);
  });

  it('does not push a foot through the floor', () => {
    const start = stand();
    const drag = new IkDrag(createIkSolver(), start, jointIndex('left_ankle'), tools);
    follow(drag, [0.2, -0.4, 0]);
    expect(at(places(drag.pose), 'left_ankle')[1]).toBeGreaterThan(at(places(start), 'left_ankle')[1] - 0.01);
  });

  it('gives a pose for typed places too', () => {
    const pose = reachPose(rest(), jointIndex('right_wrist'), [-0.3, 1.6, 0.3], tools);
    const joints = places(stand(pose));
    expect(gap(at(joints, 'right_wrist'), [-0.3, 1.6, 0.3])).toBeLessThan(0.02);
  });
});
