/** Random reachable goals and smooth paths for inverse kinematics: the unit test asserts on them, tests/bench/ik.ts prints them. */
import { JOINT_LIMITS, clampRotation, limitExcess } from '../../../web/core/joint-limits';
import { LIMBS } from '../../../web/core/ik-limb';
import type { IkGoal, IkSolver } from '../../../web/core/ik';
import { seededRandom, type Random } from '../../../web/core/random';
import { angleBetween, axisAngleToQuaternion, multiply, poseToQuaternions } from '../../../web/core/rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../../../web/core/skeleton';

const DEGREES = 180 / Math.PI;
/** What the stage's drags use. */
const TURN = 20;
const ROOT = [0, 0.93, 0];

/** What the trials of one limb came to. */
export interface Trials {
  name: string;
  solved: number;
  targets: number;
  /** Metres. */
  worstError: number;
  medianError: number;
  /** Degrees beyond the limits, worst joint. */
  worstExcess: number;
  /** Degrees a joint turned between two frames of a smooth path, worst. */
  worstTurn: number;
  /** Which joint that was, and in which frame. */
  turned: string;
  /** Paths whose end was reached. */
  arrived: number;
  paths: number;
  /** Milliseconds, median: from afar, and following a path. */
  coldTime: number;
  warmTime: number;
}

/** Arms hanging, elbows and knees a little bent: how people stand. */
export function standing(): Float32Array {
  const pose = new Array<number>(JOINT_COUNT * 3).fill(0);
  const set = (name: string, x: number, y: number, z: number) =>
    [x, y, z].forEach((c, i) => (pose[jointIndex(name) * 3 + i] = c / DEGREES));
  set('left_shoulder', 0, 0, -72);
  set('right_shoulder', 0, 0, 72);
  set('left_elbow', 0, -22, 0);
  set('right_elbow', 0, 22, 0);
  set('left_hip', -6, 0, 2);
  set('right_hip', -6, 0, -2);
  set('left_knee', 12, 0, 0);
  set('right_knee', 12, 0, 0);
  set('left_ankle', -6, 0, 0);
  set('right_ankle', -6, 0, 0);
  return poseToQuaternions(pose);
}

/** A rotation that the joint can have: any direction of its swing with any of its twist. */
function anyRotation(joint: number, random: Random): number[] {
  const limit = JOINT_LIMITS[joint]!;
  const across = [0, 1, 2].filter((axis) => axis !== limit.axis);
  const range = (values: number[]) => Math.min(...values) + random() * (Math.max(...values) - Math.min(...values));
  for (;;) {
    const swing = [0, 0, 0];
    across.forEach((axis, i) => (swing[axis] = range(limit.swing.map((corner) => corner[i])) / DEGREES));
    const twist = [0, 0, 0];
    twist[limit.axis] = range([...limit.twist]) / DEGREES;
    const q = multiply(axisAngleToQuaternion(swing), axisAngleToQuaternion(twist));
    if (limitExcess(joint, clampRotation(joint, q)) < 0.1 && limitExcess(joint, q) === 0) return q;
  }
}

/** A place where the limb's end is in some pose within limits, the rest of the body standing. */
export function reachable(limb: number, random: Random): number[] {
  const quaternions = standing();
  const { upper, middle, end } = LIMBS[limb];
  for (const joint of [upper, middle]) quaternions.set(anyRotation(joint, random), joint * 4);
  const joints = forwardKinematics(quaternions, ROOT);
  return Array.from(joints.subarray(end * 3, end * 3 + 3));
}

const median = (values: number[]) => values.slice().sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** Degrees of the joint that turned most between two poses. */
export function mostTurned(a: ArrayLike<number>, b: ArrayLike<number>): [number, number] {
  let worst: [number, number] = [0, 0];
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const pick = (q: ArrayLike<number>) => [0, 1, 2, 3].map((i) => q[joint * 4 + i]);
    const turn = angleBetween(pick(a), pick(b)) * DEGREES;
    if (turn > worst[0]) worst = [turn, joint];
  }
  return worst;
}

/** Degrees that the worst joint is beyond its range. */
export function worstExcess(quaternions: ArrayLike<number>): number {
  let worst = 0;
  for (let joint = 0; joint < JOINT_COUNT; joint++)
    worst = Math.max(
      worst,
      limitExcess(
        joint,
        [0, 1, 2, 3].map((i) => quaternions[joint * 4 + i]),
      ),
    );
  return worst;
}

/** Pins on both feet as they stand. */
export function pinnedFeet(quaternions: ArrayLike<number>, root: ArrayLike<number> = ROOT): IkGoal[] {
  const turns = new Float32Array(JOINT_COUNT * 4);
  const joints = forwardKinematics(quaternions, root, undefined, turns);
  return ['left_ankle', 'right_ankle'].map((name) => {
    const joint = jointIndex(name);
    return {
      joint,
      kind: 'pin',
      position: joints.slice(joint * 3, joint * 3 + 3),
      rotation: turns.slice(joint * 4, joint * 4 + 4),
    };
  });
}

/**
 * Solves for random reachable goals from the standing pose, then follows smooth paths between them.
 * @param pins what else holds
 * @param step length of a path's step, metres
 */
export function runTrials(
  solver: IkSolver,
  limb: number,
  { name = '', count = 200, paths = 40, step = 0.015, pins = [] as IkGoal[] } = {},
): Trials {
  const random = seededRandom(40 + limb);
  const { end } = LIMBS[limb];
  const start = { root: ROOT, quaternions: standing() };
  const errors: number[] = [];
  const cold: number[] = [];
  const warm: number[] = [];
  let excess = 0;
  for (let i = 0; i < count; i++) {
    const goals: IkGoal[] = [{ joint: end, position: reachable(limb, random), kind: 'reach' }, ...pins];
    const before = performance.now();
    const { quaternions, error } = solver.solve(start, goals, { limits: true, rest: start });
    cold.push(performance.now() - before);
    errors.push(error);
    excess = Math.max(excess, worstExcess(quaternions));
  }
  let worstTurn = 0;
  let arrived = 0;
  let turned = '';
  let pose: { root: ArrayLike<number>; quaternions: ArrayLike<number> } = start;
  const joints = forwardKinematics(start.quaternions, ROOT);
  let from = Array.from(joints.subarray(end * 3, end * 3 + 3));
  for (let path = 0; path < paths; path++) {
    const to = reachable(limb, random);
    const length = Math.hypot(...to.map((c, i) => c - from[i]));
    const steps = Math.max(2, Math.ceil(length / step));
    for (let i = 1; i <= steps; i++) {
      const position = from.map((c, k) => c + ((to[k] - c) * i) / steps);
      const before = performance.now();
      const next = solver.solve(pose, [{ joint: end, position, kind: 'reach' }, ...pins], {
        limits: true,
        rest: start,
        maxTurn: TURN,
      });
      warm.push(performance.now() - before);
      const [turn, joint] = mostTurned(pose.quaternions, next.quaternions);
      if (turn > worstTurn) {
        worstTurn = turn;
        turned = `joint ${joint}, path ${path}, step ${i}/${steps}`;
      }
      excess = Math.max(excess, worstExcess(next.quaternions));
      pose = next;
    }
    // Once the pointer rests, the stage goes on solving until the body is there.
    for (let i = 0; i < 30; i++)
      pose = solver.solve(pose, [{ joint: end, position: to, kind: 'reach' }, ...pins], {
        limits: true,
        rest: start,
        maxTurn: TURN,
      });
    const there = forwardKinematics(pose.quaternions, pose.root).subarray(end * 3, end * 3 + 3);
    if (Math.hypot(...to.map((c, i) => c - there[i])) < 0.01) arrived++;
    from = to;
  }
  return {
    name,
    targets: count,
    solved: errors.filter((error) => error < 0.01).length,
    worstError: Math.max(...errors),
    medianError: median(errors),
    worstExcess: excess,
    worstTurn,
    turned,
    arrived,
    paths,
    coldTime: median(cold),
    warmTime: warm.length ? median(warm) : 0,
  };
}
