/** One drag by inverse kinematics: which goals hold while a joint is taken somewhere. No graphics. */
import { contacts, restingHeight } from '../core/balance';
import { createIkSolver, type IkGoal, type IkSolver } from '../core/ik';
import { limbBentAt, limbEndingIn } from '../core/ik-limb';
import {
  angleBetween,
  conjugate,
  poseToQuaternions,
  quaternionsToPose,
  rotateVector,
  type Numbers,
} from '../core/rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, MIRROR, PARENTS } from '../core/skeleton';
import { spec } from '../core/spec';
import type { PoseTools } from '../core/types';
import { standingRoot } from './body-points';

/** Most that a joint turns from one frame of a drag to the next, degrees. */
const MOST_TURN = 20;
/** Below this a further solve would not be seen, degrees. */
const STILL = 0.05;
/** A lifted foot goes with its leg from this height on, metres over where it stands. */
const LIFTED = 0.3;
const DEGREES = 180 / Math.PI;
const HIPS = ['left_hip', 'right_hip'].map(jointIndex);
const FEET = [spec.skeleton.feet.left, spec.skeleton.feet.right];

type Point = [number, number, number];
type Tools = Pick<PoseTools, 'limits' | 'mirror' | 'pins'>;

/** A pose on its way. */
export interface DraggedPose {
  root: Float32Array;
  quaternions: Float32Array;
}

/** The body while one joint is dragged. */
export class IkDrag {
  /** The latest pose. */
  pose: DraggedPose;
  /** False while the body is still on its way to where the joint is wanted. */
  settled = true;
  /** Where the joint was at the start. */
  readonly from: Point;
  private readonly start: DraggedPose;
  private readonly joints: Float32Array;
  private readonly turns = new Float32Array(JOINT_COUNT * 4);
  private readonly pins: readonly IkGoal[];

  constructor(
    private readonly solver: IkSolver,
    start: { root: Numbers; quaternions: Numbers },
    private readonly joint: number,
    private readonly tools: Tools,
  ) {
    this.start = { root: Float32Array.from(start.root), quaternions: Float32Array.from(start.quaternions) };
    this.pose = { root: this.start.root.slice(), quaternions: this.start.quaternions.slice() };
    this.joints = forwardKinematics(start.quaternions, start.root, undefined, this.turns);
    this.from = this.at(joint);
    this.pins = this.holding();
  }

  /**
   * Takes the joint towards a place; the body follows, by so much a frame that it never flips. Call again while not `settled`.
   * @param target world position, metres
   * @param most degrees that a joint may turn; Infinity = all the way at once
   */
  to(target: Numbers, most = MOST_TURN): DraggedPose {
    const goals = [...this.goals(target), ...this.pins];
    const before = this.pose.quaternions;
    const { root, quaternions } = this.solver.solve(this.pose, goals, {
      limits: this.tools.limits,
      rest: this.start,
      maxTurn: Number.isFinite(most) ? most : undefined,
    });
    this.pose = { root, quaternions };
    let turned = 0;
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const at = joint * 4;
      turned = Math.max(turned, angleBetween(before.subarray(at, at + 4), quaternions.subarray(at, at + 4)) * DEGREES);
    }
    this.settled = turned < STILL;
    return this.pose;
  }

  private at(joint: number): Point {
    return [this.joints[joint * 3], this.joints[joint * 3 + 1], this.joints[joint * 3 + 2]];
  }

  private turn(joint: number): Float32Array {
    return this.turns.slice(joint * 4, joint * 4 + 4);
  }

  /** What is dragged, and on the other side its mirror image. */
  private goals(target: Numbers): IkGoal[] {
    const { joint } = this;
    const over = [target[0], Math.max(target[1], Math.min(restingHeight(joint), this.from[1])), target[2]];
    if (joint === 0 || HIPS.includes(joint)) {
      // A hip sits firmly in the pelvis: dragging it is dragging the pelvis.
      const position = [0, 1, 2].map((i) => this.start.root[i] + over[i] - this.from[i]);
      return [{ joint: 0, position, kind: 'reach' }];
    }
    const goals = [this.goal(joint, over)];
    if (this.tools.mirror && MIRROR[joint] !== joint) goals.push(this.goal(MIRROR[joint], this.mirrored(over)));
    return goals;
  }

  private goal(joint: number, position: Numbers): IkGoal {
    if (limbBentAt(joint)) return { joint, position, kind: 'pole' };
    const foot = FEET.find(({ ankle }) => ankle === joint);
    if (!foot) return { joint, position, kind: 'reach' };
    // A foot near the floor stays as flat as it stood; lifted, it goes with the leg.
    const height = Math.max(position[1], this.at(joint)[1]) - restingHeight(joint);
    const t = Math.min(Math.max(height / LIFTED, 0), 1);
    return { joint, position, kind: 'reach', rotation: this.turn(joint), hold: 1 - t * t * (3 - 2 * t) };
  }

  /** The place on the other side of the figure's own left-right plane. */
  private mirrored(position: Numbers): number[] {
    const turn = this.turn(0);
    const local = rotateVector(
      conjugate(turn),
      [0, 1, 2].map((i) => position[i] - this.start.root[i]),
    );
    return rotateVector(turn, [-local[0], local[1], local[2]]).map((c, i) => c + this.start.root[i]);
  }

  /** What stays: the visitor's pins, the far end of a limb whose elbow or knee is dragged, and feet that stand on the floor. */
  private holding(): IkGoal[] {
    const { joint, tools } = this;
    const dragged = tools.mirror ? [joint, MIRROR[joint]] : [joint];
    const held = new Set(tools.pins);
    const standing = new Set(contacts(this.joints));
    const feet = FEET.filter(({ ankle, toe }) => standing.has(ankle) || standing.has(toe)).map(({ ankle }) => ankle);
    for (const each of dragged) {
      const limb = limbBentAt(each);
      if (limb) held.add(limb.end);
      const parent = PARENTS[each];
      // Toes turn about their ankle.
      if (FEET.some(({ toe }) => toe === each)) held.add(parent);
    }
    if (!dragged.some((each) => limbBentAt(each))) for (const ankle of feet) held.add(ankle);
    if ((joint === 0 || HIPS.includes(joint)) && held.size === 0) for (const { ankle } of FEET) held.add(ankle);
    for (const each of dragged) held.delete(each);
    return [...held].map((each) => ({
      joint: each,
      kind: 'pin',
      position: this.at(each),
      // The toes' own ankle must be free to turn.
      rotation: limbEndingIn(each) && !dragged.some((other) => PARENTS[other] === each) ? this.turn(each) : undefined,
    }));
  }
}

/**
 * The pose after a joint was taken to a place, the body following as in a drag.
 * @param rotations 24 x 3 axis-angle, standing on the floor at the centre of the stage
 * @param target world position, metres
 */
export function reachPose(rotations: Numbers, joint: number, target: Numbers, tools: Tools): number[] {
  const solver = createIkSolver();
  const quaternions = poseToQuaternions(rotations);
  // The solved figure is put back to the middle of the stage, which takes the joint along: what that moved is reached for again.
  for (let round = 0; round < 5; round++) {
    const drag = new IkDrag(solver, { root: standingRoot(quaternions), quaternions }, joint, tools);
    if (Math.hypot(...drag.from.map((c, i) => c - target[i])) < 0.002) break;
    quaternions.set(drag.to(target, Infinity).quaternions);
  }
  return quaternionsToPose(quaternions);
}
