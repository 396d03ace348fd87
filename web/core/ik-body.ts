/** The whole body as a chain for closed-chain-ik: one weighted, damped least-squares step towards a set of goals. */
import { DOF, Goal, Joint, Link, Solver } from 'closed-chain-ik/src/core/index.js';
import { axisAngleToQuaternion, multiply, rotateVector, type Numbers } from './rotation';
import { JOINT_COUNT, JOINTS, OFFSETS, PARENTS } from './skeleton';

/** A figure in the solver's hands. */
export interface IkBody {
  /** Pelvis position, metres. */
  root: Float32Array;
  /** 24 x 4 local rotations. */
  quaternions: Float32Array;
}

/** A joint that should be at a place. */
export interface IkTarget {
  joint: number;
  position: Numbers;
}

type Three = readonly [number, number, number];

/** How readily a joint turns about its own X, Y and Z; 0 = not at all. Limbs go before the trunk, hinges about their hinge. */
const STIFFNESS: Readonly<Record<string, Three>> = {
  pelvis: [0.26, 0.1, 0.12],
  spine1: [0.26, 0.15, 0.17],
  spine2: [0.22, 0.17, 0.17],
  spine3: [0.21, 0.17, 0.16],
  neck: [0.6, 0.4, 0.5],
  head: [0.4, 0.3, 0.4],
  collar: [0, 0.28, 0.34],
  shoulder: [0.8, 1, 1],
  elbow: [0, 1, 0.05],
  wrist: [0.2, 0.5, 0.7],
  hip: [1, 0.8, 1],
  knee: [1, 0, 0.03],
  ankle: [0.5, 0.3, 0.3],
};
/** How readily the pelvis moves, per metre. */
const ROOT_STIFFNESS = 0.14;
/** More damping than the library's own: a straight arm must not throw the elbow about. */
const DAMPING = 0.04;
/** Longest way a goal is approached in one step, metres. */
const STRIDE = 0.2;
/** Largest turn of a joint in one step, radians. */
const TURN = 0.6;

/**
 * A joint whose degrees of freedom are counted in units of its own: the least-squares step, being the shortest in those units, then
 * moves willing joints more than stiff ones.
 */
class WeightedJoint extends Joint {
  readonly weights = new Float64Array(6);
  /** Less than 1 while the joint stands at its limit, so that others take over. */
  ease = 1;

  override getDeltaWorldMatrix(dof: number, delta: number, out: ArrayLike<number>): boolean {
    return super.getDeltaWorldMatrix(dof, delta * this.weights[dof] * this.ease, out);
  }
}

const ROTATIONS = [DOF.EX, DOF.EY, DOF.EZ];
const TRANSLATIONS = [DOF.X, DOF.Y, DOF.Z];

/** The chain, its goals and the library's solver. */
export class BodyChain {
  private readonly joints: WeightedJoint[] = [];
  private readonly links: Link[] = [];
  private readonly goals = new Map<number, Goal>();
  private solver: Solver | null = null;
  private structure = '';

  constructor() {
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const turning = new WeightedJoint();
      const link = new Link();
      const parent = PARENTS[joint];
      turning.setPosition(...OFFSETS[joint]);
      turning.addChild(link);
      if (parent >= 0) {
        this.links[parent].addChild(turning);
        this.free(turning, joint, false);
      }
      this.joints.push(turning);
      this.links.push(link);
    }
  }

  /**
   * One step of the whole body, in place.
   * @param moveRoot whether the pelvis may move and turn
   * @param eased joints at their limits
   */
  step(body: IkBody, targets: readonly IkTarget[], moveRoot: boolean, eased: ReadonlySet<number>): void {
    if (targets.length === 0) return;
    this.prepare(targets, moveRoot);
    const { root, quaternions } = body;
    this.joints.forEach((joint, index) => {
      const at = index * 4;
      joint.ease = eased.has(index) ? 0.25 : 1;
      joint.setQuaternion(quaternions[at], quaternions[at + 1], quaternions[at + 2], quaternions[at + 3]);
      joint.setDoFValues(...joint.dof.map(() => 0));
    });
    this.joints[0].setPosition(root[0], root[1], root[2]);
    for (const { joint, position } of targets) {
      this.goals.get(joint)!.setPosition(position[0], position[1], position[2]);
    }
    this.solver!.solve();
    this.joints.forEach((joint, index) => this.apply(joint, index, body));
  }

  /** Each solve starts from the pose at hand with all degrees of freedom at zero: no Euler angle ever grows large enough to lock. */
  private apply(joint: WeightedJoint, index: number, { root, quaternions }: IkBody): void {
    if (joint.dof.length === 0) return;
    const { dofValues, weights, ease } = joint;
    const moved = (dof: number) => dofValues[dof] * weights[dof] * ease;
    const q = quaternions.subarray(index * 4, index * 4 + 4);
    if (index === 0) {
      const way = rotateVector(q, TRANSLATIONS.map(moved));
      for (let i = 0; i < 3; i++) root[i] += way[i];
    }
    const turn = ROTATIONS.map(moved);
    const size = Math.hypot(...turn);
    if (size === 0) return;
    const scale = Math.min(1, TURN / size);
    multiply(q, axisAngleToQuaternion(turn.map((c) => c * scale)), q);
    const length = Math.hypot(q[0], q[1], q[2], q[3]);
    for (let i = 0; i < 4; i++) q[i] /= length;
  }

  /** Rebuilds the library's structure when other joints have goals than before. */
  private prepare(targets: readonly IkTarget[], moveRoot: boolean): void {
    const structure = `${moveRoot} ${targets.map(({ joint }) => joint).join(' ')}`;
    if (structure === this.structure) return;
    this.structure = structure;
    for (const [joint, goal] of this.goals) goal.removeChild(this.links[joint]);
    this.goals.clear();
    for (const { joint } of targets) {
      const goal = new Goal();
      goal.setGoalDoF(...TRANSLATIONS);
      goal.makeClosure(this.links[joint]);
      this.goals.set(joint, goal);
    }
    this.free(this.joints[0], 0, moveRoot);
    const solver = new Solver([this.joints[0], ...this.goals.values()]);
    solver.maxIterations = 1;
    solver.stallThreshold = 0;
    solver.restPoseFactor = 0;
    solver.divergeThreshold = Infinity;
    // Every goal stays in the equations, or a pin that is met would be let go while another goal is approached.
    solver.translationConvergeThreshold = 0;
    solver.rotationConvergeThreshold = 0;
    solver.dampingFactor = DAMPING;
    solver.translationErrorClamp = STRIDE;
    this.solver = solver;
  }

  private free(turning: WeightedJoint, joint: number, moveRoot: boolean): void {
    const turns = STIFFNESS[JOINTS[joint].replace(/^(left|right)_/, '')] ?? [0, 0, 0];
    const movable = joint > 0 || moveRoot;
    for (let i = 0; i < 3; i++) {
      turning.weights[ROTATIONS[i]] = turns[i];
      turning.weights[TRANSLATIONS[i]] = joint === 0 ? ROOT_STIFFNESS : 0;
    }
    const dofs = movable ? [...TRANSLATIONS, ...ROTATIONS].filter((dof) => turning.weights[dof] > 0) : [];
    turning.setDoF(...dofs);
  }
}
