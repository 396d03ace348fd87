import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { createIkSolver, type IkGoal } from '../../web/core/ik';
import { LIMBS } from '../../web/core/ik-limb';
import { angleBetween } from '../../web/core/rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../../web/core/skeleton';
import { mostTurned, pinnedFeet, runTrials, standing, worstExcess } from './support/ik-trials';

const DEGREES = 180 / Math.PI;
const start = { root: [0, 0.93, 0], quaternions: standing() };
const before = forwardKinematics(start.quaternions, start.root);
const at = (joints: Float32Array, name: string) => Array.from(joints.subarray(jointIndex(name) * 3).subarray(0, 3));
const gap = (a: ArrayLike<number>, b: ArrayLike<number>) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
const reach = (name: string, position: number[]): IkGoal => ({ joint: jointIndex(name), position, kind: 'reach' });
const turned = (a: ArrayLike<number>, b: ArrayLike<number>, name: string) => {
  const pick = (q: ArrayLike<number>) => [0, 1, 2, 3].map((i) => q[jointIndex(name) * 4 + i]);
  return angleBetween(pick(a), pick(b)) * DEGREES;
};

describe.each(['left arm', 'right arm', 'left leg', 'right leg'].map((name, limb) => [name, limb] as const))(
  'reaching with the %s',
  (_, limb) => {
    const trials = runTrials(createIkSolver(), limb, { paths: 12 });

    it('gets within 1 cm of 200 reachable places', () => {
      expect(trials.solved).toBe(trials.targets);
      expect(trials.targets).toBe(200);
    });

    it('stays within the human range of motion', () => {
      expect(trials.worstExcess).toBeLessThan(0.5);
    });

    it('does not flip while the goal moves smoothly', () => {
      expect(trials.worstTurn, trials.turned).toBeLessThan(30);
      expect(trials.arrived).toBeGreaterThanOrEqual(trials.paths * 0.8);
    });
  },
);

describe('the whole body', () => {
  const solver = createIkSolver();

  it('holds both feet while a hand reaches for the floor, and bends knees and back for it', () => {
    const pins = pinnedFeet(start.quaternions);
    let pose: { root: ArrayLike<number>; quaternions: ArrayLike<number> } = start;
    const hand = at(before, 'left_wrist');
    const floor = [0.25, 0.12, 0.35];
    let error = 1;
    for (let i = 1; i <= 60; i++) {
      const position = hand.map((c, k) => c + (floor[k] - c) * Math.min(1, i / 50));
      const goals = [reach('left_wrist', position), ...pins];
      ({ error, ...pose } = solver.solve(pose, goals, { limits: true, rest: start, maxTurn: 20 }));
    }
    expect(error).toBeLessThan(0.01);
    const joints = forwardKinematics(pose.quaternions, pose.root);
    for (const pin of pins) expect(gap(joints.subarray(pin.joint * 3), pin.position)).toBeLessThan(0.002);
    for (const ankle of ['left_ankle', 'right_ankle']) {
      const turns = new Float32Array(JOINT_COUNT * 4);
      forwardKinematics(pose.quaternions, pose.root, undefined, turns);
      const pin = pins.find(({ joint }) => joint === jointIndex(ankle))!;
      expect(angleBetween(turns.subarray(jointIndex(ankle) * 4), pin.rotation!) * DEGREES).toBeLessThan(12);
    }
    expect(pose.root[1]).toBeLessThan(0.85);
    expect(worstExcess(pose.quaternions)).toBeLessThan(0.5);
  });

  it('squats when the pelvis is pulled down on pinned feet: knees to the front, feet flat, back as it was', () => {
    const pins = pinnedFeet(start.quaternions);
    let pose: { root: ArrayLike<number>; quaternions: ArrayLike<number> } = start;
    for (let i = 1; i <= 30; i++) {
      const goals: IkGoal[] = [{ joint: 0, position: [0, 0.93 - i * 0.012, -i * 0.006], kind: 'reach' }, ...pins];
      const next = solver.solve(pose, goals, { limits: true, rest: start, maxTurn: 20 });
      expect(next.error).toBeLessThan(0.005);
      expect(mostTurned(pose.quaternions, next.quaternions)[0]).toBeLessThan(20.5);
      pose = next;
    }
    const joints = forwardKinematics(pose.quaternions, pose.root);
    for (const side of ['left', 'right']) {
      expect(gap(at(joints, `${side}_ankle`), at(before, `${side}_ankle`))).toBeLessThan(0.002);
      expect(at(joints, `${side}_knee`)[2]).toBeGreaterThan(at(before, `${side}_knee`)[2] + 0.1);
      expect(turned(pose.quaternions, start.quaternions, `${side}_knee`)).toBeGreaterThan(50);
    }
    expect(turned(pose.quaternions, start.quaternions, 'spine1')).toBeLessThan(1);
    expect(worstExcess(pose.quaternions)).toBeLessThan(0.5);
  });

  it('keeps the pelvis within reach of pinned feet rather than letting go of them', () => {
    const pins = pinnedFeet(start.quaternions);
    const goals: IkGoal[] = [{ joint: 0, position: [0.9, 1.4, 0], kind: 'reach' }, ...pins];
    const { root, quaternions, error } = solver.solve(start, goals, { limits: true });
    const joints = forwardKinematics(quaternions, root);
    for (const pin of pins) expect(gap(joints.subarray(pin.joint * 3), pin.position)).toBeLessThan(0.005);
    expect(error).toBeGreaterThan(0.2);
  });

  it('leaves what has nothing to do with a goal alone, and the trunk nearly so while the arm is long enough', () => {
    const { quaternions, root } = solver.solve(start, [reach('left_wrist', [0.35, 1.35, 0.3])], {
      limits: true,
      rest: start,
    });
    expect(Array.from(root)).toEqual(Array.from(Float32Array.from(start.root)));
    for (const name of ['right_shoulder', 'left_knee', 'head', 'right_hip'])
      expect(turned(quaternions, start.quaternions, name)).toBeLessThan(0.1);
    for (const name of ['spine1', 'spine2', 'spine3'])
      expect(turned(quaternions, start.quaternions, name)).toBeLessThan(8);
  });

  it('leaves the standing legs and the trunk alone while a straight arm is drawn in', () => {
    const straight = { root: start.root, quaternions: new Float32Array(96).map((_, i) => (i % 4 === 3 ? 1 : 0)) };
    const pins = pinnedFeet(straight.quaternions);
    const from = at(forwardKinematics(straight.quaternions, straight.root), 'left_wrist');
    let pose: { root: ArrayLike<number>; quaternions: ArrayLike<number> } = straight;
    for (let i = 1; i <= 40; i++) {
      const way = Math.min(1, i / 8);
      const goals = [reach('left_wrist', [from[0] - 0.36 * way, from[1] + 0.15 * way, from[2]]), ...pins];
      pose = solver.solve(pose, goals, { limits: true, rest: straight, maxTurn: 20 });
      for (const name of ['left_knee', 'right_knee', 'pelvis', 'spine1'])
        expect(turned(pose.quaternions, straight.quaternions, name), name).toBeLessThan(8);
    }
    expect(turned(pose.quaternions, straight.quaternions, 'left_elbow')).toBeGreaterThan(60);
  });

  it('leans with the trunk for what the arm alone does not reach', () => {
    const far = [0.15, 1.1, 0.72];
    const { quaternions, error } = solver.solve(start, [reach('left_wrist', far)], { limits: true, rest: start });
    expect(error).toBeLessThan(0.01);
    const trunk = ['spine1', 'spine2', 'spine3'].map((name) => turned(quaternions, start.quaternions, name));
    expect(trunk.reduce((sum, turn) => sum + turn, 0)).toBeGreaterThan(8);
    // Shared out, not one kink.
    expect(Math.max(...trunk)).toBeLessThan(0.7 * trunk.reduce((sum, turn) => sum + turn, 0));
  });

  it('stretches calmly towards what nobody reaches', () => {
    const { quaternions, error } = solver.solve(start, [reach('right_wrist', [-4, 2, 1])], { limits: true });
    expect(error).toBeGreaterThan(1);
    expect(quaternions.every(Number.isFinite)).toBe(true);
    expect(worstExcess(quaternions)).toBeLessThan(0.5);
    const joints = forwardKinematics(quaternions, start.root);
    expect(gap(at(joints, 'right_wrist'), at(joints, 'right_shoulder'))).toBeGreaterThan(0.5);
  });

  it('bends elbows to the front and knees to the back, from straight limbs too', () => {
    const straight = { root: [0, 0.93, 0], quaternions: new Float32Array(96).map((_, i) => (i % 4 === 3 ? 1 : 0)) };
    const goals = [reach('left_wrist', [0.35, 1.4, 0.1]), reach('right_ankle', [-0.1, 0.4, 0.1])];
    const { quaternions, error } = solver.solve(straight, goals, { limits: false });
    expect(error).toBeLessThan(0.01);
    expect(quaternions[jointIndex('left_elbow') * 4 + 1]).toBeLessThan(-0.2);
    expect(quaternions[jointIndex('right_knee') * 4]).toBeGreaterThan(0.2);
  });

  it('lets limits be broken only when they are off', () => {
    const behind = [0.3, 1.5, -0.45];
    const free = solver.solve(start, [reach('left_wrist', behind)], { limits: false });
    const bound = solver.solve(start, [reach('left_wrist', behind)], { limits: true });
    expect(free.error).toBeLessThan(0.01);
    expect(worstExcess(free.quaternions)).toBeGreaterThan(1);
    expect(worstExcess(bound.quaternions)).toBeLessThan(0.5);
  });

  it('gives the same answer every time, whatever was solved in between', () => {
    const goals = [reach('left_wrist', [0.3, 1.7, 0.2]), ...pinnedFeet(start.quaternions)];
    const first = createIkSolver().solve(start, goals, { limits: true });
    solver.solve(start, [reach('head', [0.1, 1.5, 0.2])], { limits: true });
    const second = solver.solve(start, goals, { limits: true });
    for (let i = 0; i < 96; i++) expect(second.quaternions[i]).toBeCloseTo(first.quaternions[i], 5);
  });

  it('is never broken by goals from anywhere', () => {
    const coordinate = fc.double({ min: -3, max: 3, noNaN: true });
    fc.assert(
      fc.property(fc.integer({ min: 0, max: 23 }), fc.tuple(coordinate, coordinate, coordinate), (joint, position) => {
        const pins = pinnedFeet(start.quaternions);
        const { quaternions, root } = solver.solve(start, [{ joint, position, kind: 'reach' }, ...pins], {
          limits: true,
        });
        expect([...quaternions, ...root].every(Number.isFinite)).toBe(true);
        for (let i = 0; i < 24; i++) expect(Math.hypot(...quaternions.subarray(i * 4, i * 4 + 4))).toBeCloseTo(1, 4);
      }),
      { numRuns: 25 },
    );
  });
});

describe('poles', () => {
  it('turn the elbow round the line from shoulder to hand, and the hand stays', () => {
    const solver = createIkSolver();
    const bent = solver.solve(start, [reach('left_wrist', [0.4, 1.25, 0.25])], { limits: true });
    const joints = forwardKinematics(bent.quaternions, bent.root);
    const elbow = LIMBS[0].middle;
    const up: IkGoal = { joint: elbow, position: [0.6, 1.9, 0.1], kind: 'pole' };
    const pinned: IkGoal = { joint: LIMBS[0].end, position: at(joints, 'left_wrist'), kind: 'pin' };
    const { quaternions, root } = solver.solve(bent, [pinned, up], { limits: true });
    const after = forwardKinematics(quaternions, root);
    expect(gap(at(after, 'left_wrist'), at(joints, 'left_wrist'))).toBeLessThan(0.001);
    expect(at(after, 'left_elbow')[1]).toBeGreaterThan(at(joints, 'left_elbow')[1] + 0.05);
    expect(worstExcess(quaternions)).toBeLessThan(0.5);
  });
});
