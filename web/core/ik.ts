/**
 * Whole-body inverse kinematics. The library's damped least squares (closed-chain-ik) moves pelvis, trunk and limbs together, weighted so
 * that limbs go first; arms and legs are then put exactly to their goals in closed form. All of it starts from the pose at hand,
 * so that what one sees while dragging follows on from what one saw.
 */
import { centreOfMass } from './balance';
import { BodyChain, type IkTarget } from './ik-body';
import {
  createPlacedBody,
  fitLimb,
  limbBentAt,
  limbEndingIn,
  limitJoint,
  place,
  setWorldTurn,
  swivelLimb,
  type PlacedBody,
} from './ik-limb';
import {
  distanceTo,
  followPins,
  giveWay,
  kneesOverToes,
  stanceOf,
  tether,
  type Stance,
  type Tether,
} from './ik-stance';
import { directions, limitExcess } from './joint-limits';
import { angleBetween, axisAngleToQuaternion, slerp, type Numbers } from './rotation';
import { forwardKinematics, JOINT_COUNT } from './skeleton';
import type { FramePose } from './types';

/** What a joint is wanted to do. */
export interface IkGoal {
  joint: number;
  /** World position, metres. */
  position: ArrayLike<number>;
  /** World rotation x y z w of a hand or foot. */
  rotation?: ArrayLike<number>;
  /** How much of `rotation` is held against going with the limb, 0..1; missing = 1. */
  hold?: number;
  /** `reach` goes as near as pins let it; `pin` stays; `pole` turns an elbow or knee towards the position. */
  kind: 'reach' | 'pin' | 'pole';
}

/** How to solve. */
export interface IkOptions {
  /** Joints stay inside the human range of motion; one that is outside already does not go further. */
  limits: boolean;
  /** The pose to lean towards where goals leave a choice, such as the pose before the drag; missing = the pose itself. */
  rest?: FramePose;
  /**
   * Most that a joint turns in one solve, degrees, for following a drag: where the limits leave only a far turn, the body gets there over
   * several frames instead of flipping. Missing = any.
   */
  maxTurn?: number;
}

/** A solved pose. */
export interface IkResult {
  root: Float32Array;
  /** 24 x 4. */
  quaternions: Float32Array;
  /** Distance of the worst reach or pin from its goal, metres. */
  error: number;
}

/** Solves poses for goals; keeps its working memory between calls. */
export interface IkSolver {
  solve(pose: FramePose, goals: readonly IkGoal[], options: IkOptions): IkResult;
}

/** Near enough, metres. */
const TOLERANCE = 8e-4;
const MOST_ROUNDS = 24;
const FEWEST_ROUNDS = 2;
/** Share of the way back to the rest pose in the first rounds. */
const LEANING = 0.08;
/** Share of the way that the weight is brought back over its spot in one round. */
const BALANCING = 0.3;
/** A goal further than this is missed, metres. */
const MISSED = 0.004;
/** Fits from each new direction. */
const AFRESH_ROUNDS = 6;
const DEGREES = 180 / Math.PI;

/** Makes a solver. */
export function createIkSolver(): IkSolver {
  const chain = new BodyChain();
  const body = createPlacedBody();
  return { solve: (pose, goals, options) => solve(chain, body, pose, goals, options) };
}

function solve(
  chain: BodyChain,
  body: PlacedBody,
  pose: FramePose,
  goals: readonly IkGoal[],
  { limits, rest, maxTurn }: IkOptions,
): IkResult {
  body.root.set(Array.from(pose.root));
  body.quaternions.set(Array.from(pose.quaternions));
  body.slack = limits ? slackOf(pose.quaternions) : null;
  place(body);

  const pelvis = goals.find(({ joint, kind }) => joint === 0 && kind !== 'pole');
  const held = goals.filter(({ joint, kind }) => joint !== 0 && kind !== 'pole');
  const pins = held.filter(({ kind }) => kind === 'pin');
  const poles = goals.filter(({ kind }) => kind === 'pole');
  const targets: IkTarget[] = held.map(({ joint, position }) => ({ joint, position }));
  // Without anything that holds the body in its place, moving the pelvis would be carrying the figure about.
  const moveRoot = !pelvis && pins.length > 0;

  const tethers = pelvis || moveRoot ? pins.flatMap((pin) => tether(body, pin)) : [];
  const feet = pelvis || moveRoot ? stanceOf(body, pins) : [];
  const weight = pelvis ? centreOfMass(rest ? forwardKinematics(rest.quaternions, rest.root) : body.joints) : null;
  if (pelvis) body.root.set(Array.from(pelvis.position));
  place(body);

  const work: Work = { chain, body, goals: held, targets, tethers, feet, weight, moveRoot, rest };
  approach(work);
  if (maxTurn === undefined) {
    startAfresh(work);
  } else if (calmDown(body, pose, maxTurn)) {
    if (moveRoot) followPins(body, tethers);
    fitAll(body, pins);
  }
  if (pelvis && rest) kneesOverToes(body, feet, rest.quaternions);
  for (const pole of poles) {
    const limb = limbBentAt(pole.joint);
    if (limb) swivelLimb(body, limb, pole.position);
  }
  const error = errorOf(body, pelvis ? [...held, pelvis] : held);
  return { root: body.root.slice(), quaternions: body.quaternions.slice(), error };
}

/** What one solve works on. */
interface Work {
  chain: BodyChain;
  body: PlacedBody;
  goals: readonly IkGoal[];
  targets: readonly IkTarget[];
  tethers: readonly Tether[];
  feet: readonly Stance[];
  /** Where the weight was, for a dragged pelvis. */
  weight: Numbers | null;
  moveRoot: boolean;
  rest?: FramePose;
}

/** Rounds of least squares for the whole body and closed form for the limbs, until every goal is met. */
function approach({ chain, body, goals, targets, tethers, feet, weight: over, moveRoot, rest }: Work): void {
  const eased = new Set<number>();
  const weight = rest && moveRoot ? centreOfMass(forwardKinematics(rest.quaternions, rest.root)) : null;
  for (let round = 0; round < MOST_ROUNDS; round++) {
    if (rest && round < MOST_ROUNDS / 2) lean(body, rest, LEANING * (1 - (2 * round) / MOST_ROUNDS), weight);
    place(body);
    // What an arm or leg does alone is left to it: a straight one cannot bend by small steps, and the trunk would go instead.
    fitAll(body, goals);
    if (errorOf(body, goals) > TOLERANCE) {
      chain.step(body, targets, moveRoot, eased);
      eased.clear();
      for (let joint = 1; joint < JOINT_COUNT; joint++) if (limitJoint(body, joint)) eased.add(joint);
      place(body);
    }
    followPins(body, tethers);
    fitAll(body, goals);
    const stands = giveWay(body, feet, over);
    if (!stands) {
      followPins(body, tethers);
      fitAll(body, goals);
    }
    if (stands && errorOf(body, goals) < TOLERANCE && round + 1 >= FEWEST_ROUNDS) return;
  }
}

/** What each joint is beyond its range at the start: that much is left to it. */
function slackOf(quaternions: Numbers): Float32Array {
  return Float32Array.from({ length: JOINT_COUNT }, (_, joint) =>
    limitExcess(
      joint,
      [0, 1, 2, 3].map((i) => quaternions[joint * 4 + i]),
    ),
  );
}

function errorOf({ joints }: PlacedBody, goals: readonly IkGoal[]): number {
  let worst = 0;
  for (const { joint, position } of goals) worst = Math.max(worst, distanceTo(joints, joint, position));
  return worst;
}

/** A share of the way back to the rest pose; a pelvis that is free keeps the weight over the same spot, as bodies do. */
function lean(body: PlacedBody, rest: FramePose, share: number, weight: Numbers | null): void {
  const { root, quaternions } = body;
  for (let joint = weight ? 0 : 1; joint < JOINT_COUNT; joint++) {
    const q = quaternions.subarray(joint * 4, joint * 4 + 4);
    slerp(
      q,
      [0, 1, 2, 3].map((i) => rest.quaternions[joint * 4 + i]),
      share,
      q,
    );
  }
  if (!weight) return;
  root[1] += (rest.root[1] - root[1]) * share;
  place(body);
  const now = centreOfMass(body.joints);
  for (const i of [0, 2]) root[i] += (weight[i] - now[i]) * BALANCING;
}

/** Arms and legs exactly to their goals, hands and feet turned as wanted. */
function fitAll(body: PlacedBody, goals: readonly IkGoal[]): void {
  for (const { joint, position, rotation, hold = 1 } of goals) {
    const limb = limbEndingIn(joint);
    if (!limb) continue;
    fitLimb(body, limb, position);
    if (rotation) {
      const turn = body.turns.subarray(joint * 4, joint * 4 + 4);
      setWorldTurn(body, joint, hold < 1 ? slerp(turn, rotation, hold) : rotation);
    }
  }
}

/** Goals that a limb did not get to from where it was are tried from other directions of its upper joint, the middle one half bent. */
function startAfresh(work: Work): void {
  const { body, goals } = work;
  for (const goal of goals) {
    const limb = limbEndingIn(goal.joint);
    const miss = () => distanceTo(body.joints, goal.joint, goal.position);
    if (!limb || miss() < MISSED) continue;
    let best = { root: body.root.slice(), quaternions: body.quaternions.slice() };
    let least = miss();
    const keepBetter = () => {
      if (miss() >= least) return;
      least = miss();
      best = { root: body.root.slice(), quaternions: body.quaternions.slice() };
    };
    const takeBest = () => {
      body.root.set(best.root);
      body.quaternions.set(best.quaternions);
      place(body);
    };
    const half = axisAngleToQuaternion(limb.hinge);
    for (const start of directions(limb.upper)) {
      if (least < MISSED) break;
      body.quaternions.set(start, limb.upper * 4);
      body.quaternions.set(half, limb.middle * 4);
      place(body);
      for (let round = 0; round < AFRESH_ROUNDS; round++) fitAll(body, [goal]);
      keepBetter();
    }
    takeBest();
    if (least >= MISSED) {
      approach({ ...work, rest: undefined });
      keepBetter();
      takeBest();
    }
  }
}

/** Keeps every joint within `most` degrees of where it was; true when something was held back. */
function calmDown(body: PlacedBody, before: FramePose, most: number): boolean {
  let share = 1;
  const pick = (q: Numbers, joint: number) => [0, 1, 2, 3].map((i) => q[joint * 4 + i]);
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const turn = angleBetween(pick(before.quaternions, joint), pick(body.quaternions, joint)) * DEGREES;
    if (turn > most) share = Math.min(share, most / turn);
  }
  if (share === 1) return false;
  // All joints by the same share, so that what belongs together stays together.
  for (let joint = 0; joint < JOINT_COUNT; joint++) {
    const q = slerp(pick(before.quaternions, joint), pick(body.quaternions, joint), share);
    body.quaternions.set(q, joint * 4);
    limitJoint(body, joint);
  }
  for (let i = 0; i < 3; i++) body.root[i] = before.root[i] + (body.root[i] - before.root[i]) * share;
  place(body);
  return true;
}
