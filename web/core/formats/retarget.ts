/**
 * Poses of another skeleton on ours. What is carried over is how far each joint is turned from the rest pose, in the world; where their
 * rest pose holds an arm or a leg elsewhere than our T-pose, the difference of the bones' rest directions is added, so that every bone of
 * arms and legs points where theirs does, whatever the proportions.
 */
import { multiply, conjugate, matrixToQuaternion, rotateVector, type Numbers } from '../rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, JOINTS, PARENTS } from '../skeleton';
import { cross, dot, minus, type Vector } from '../vector';
import { mapHumanoid, type NamedSkeleton } from './humanoid';
import { arc, axisOf } from './pose-sequence';

/** Somebody's skeleton in its rest pose, in the world. */
export interface SourceRig extends NamedSkeleton {
  /** joints x 3, any unit. */
  positions: Numbers;
  /** joints x 4 (x y z w). */
  rotations: Numbers;
}

const IDENTITY = new Float32Array(JOINT_COUNT * 4).map((_, i) => (i % 4 === 3 ? 1 : 0));
const REST = forwardKinematics(IDENTITY, [0, 0, 0]);
/** For each joint the one its bone leads to; the middle of the body is turned as a whole. */
export const NEXT: Readonly<Record<string, string>> = {
  left_hip: 'left_knee',
  left_knee: 'left_ankle',
  left_ankle: 'left_foot',
  left_collar: 'left_shoulder',
  left_shoulder: 'left_elbow',
  left_elbow: 'left_wrist',
  left_wrist: 'left_hand',
  right_hip: 'right_knee',
  right_knee: 'right_ankle',
  right_ankle: 'right_foot',
  right_collar: 'right_shoulder',
  right_shoulder: 'right_elbow',
  right_elbow: 'right_wrist',
  right_wrist: 'right_hand',
};
/** Bones whose rest direction is a matter of the rest pose. Of the others it is mostly a habit of the rig: where a joint was put. */
export const LIMB = /_(hip|knee|shoulder|elbow)$/;
/** Cosine of 40 degrees: further off than that, other bones were posed too. */
export const HABIT = Math.cos((40 * Math.PI) / 180);
/** A rest pose that is turned by less than 20 degrees from an axis stands on that axis. */
const SNAP = Math.cos((20 * Math.PI) / 180);

function unit(v: Vector): Vector {
  const length = Math.hypot(...v);
  if (!(length > 1e-9)) throw new Error('The rest pose of this skeleton has joints on top of each other.');
  return [v[0] / length, v[1] / length, v[2] / length];
}

/** Left, up and forward of a body, as a rotation from ours (left = +X, up = +Y, forward = +Z). */
export function bodyFrame(at: (joint: string) => Vector, top: string): number[] {
  const middle = (a: Vector, b: Vector): Vector => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2];
  const up = unit(minus(at(top), middle(at('left_hip'), at('right_hip'))));
  const across = minus(at('left_hip'), at('right_hip'));
  const along = dot(across, up);
  const left = unit([across[0] - up[0] * along, across[1] - up[1] * along, across[2] - up[2] * along]);
  const forward = cross(left, up);
  // Columns left, up, forward.
  return matrixToQuaternion([left[0], up[0], forward[0], left[1], up[1], forward[1], left[2], up[2], forward[2]]);
}

/** The nearest turn by right angles, where one is near. */
export function snapped(q: number[]): number[] {
  const [left, up] = [axisOf(rotateVector(q, [1, 0, 0]), SNAP), axisOf(rotateVector(q, [0, 1, 0]), SNAP)];
  if (!left || !up || dot(left, up) !== 0) return q;
  const forward = cross(left, up);
  return matrixToQuaternion([left[0], up[0], forward[0], left[1], up[1], forward[1], left[2], up[2], forward[2]]);
}

/** Carries poses over. */
export class Retargeter {
  /** For each of our joints the index of theirs; -1 = it keeps still against its parent. */
  readonly source: readonly number[];
  /** Which way is up in their rest pose. */
  readonly up: Vector;
  /** Their rest rotation undone, our rest turned to theirs: their world rotation times this is ours. */
  readonly #correction: (number[] | null)[];

  /** @throws Error when it is no human skeleton */
  constructor(rig: SourceRig) {
    this.source = mapHumanoid(rig);
    const theirs = (joint: string): Vector => {
      const i = this.source[jointIndex(joint)] * 3;
      return [rig.positions[i], rig.positions[i + 1], rig.positions[i + 2]];
    };
    const ours = (joint: string): Vector => {
      const i = jointIndex(joint) * 3;
      return [REST[i], REST[i + 1], REST[i + 2]];
    };
    const top = ['head', 'neck', 'left_collar', 'left_shoulder'].find((name) => this.source[jointIndex(name)] >= 0)!;
    const body = snapped(multiply(bodyFrame(theirs, top), conjugate(bodyFrame(ours, top))));
    this.up = rotateVector(body, [0, 1, 0]) as Vector;
    this.#correction = JOINTS.map((name, joint) => {
      const s = this.source[joint];
      if (s < 0) return null;
      const rest = [0, 1, 2, 3].map((k) => rig.rotations[s * 4 + k]);
      return multiply(conjugate(rest), multiply(this.#bend(name, body, ours, theirs), body));
    });
  }

  /** How their rest pose turns a bone away from our T-pose. */
  #bend(name: string, body: number[], ours: (joint: string) => Vector, theirs: (joint: string) => Vector): number[] {
    const next = NEXT[name];
    if (!next || this.source[jointIndex(next)] < 0) return [0, 0, 0, 1];
    const way = minus(theirs(next), theirs(name));
    if (!(Math.hypot(...way) > 1e-9)) return [0, 0, 0, 1];
    const from = rotateVector(body, unit(minus(ours(next), ours(name))));
    const to = unit(way);
    if (!LIMB.test(name) && dot(from, to) > HABIT) return [0, 0, 0, 1];
    // Legs that lie up the body in the rest pose are folded about the axis through the hips, arms about the one forward.
    return arc(from, to, rotateVector(body, /hip|knee|ankle/.test(name) ? [1, 0, 0] : [0, 0, 1]));
  }

  /**
   * One frame.
   * @param world their world rotations, joints x 4
   * @param out receives our 24 x 4 local rotations, from `offset`
   */
  pose(world: Numbers, out: Float32Array, offset = 0): void {
    const turned: number[][] = [];
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const correction = this.#correction[joint];
      const parent = PARENTS[joint];
      const s = this.source[joint] * 4;
      const now = correction
        ? multiply([world[s], world[s + 1], world[s + 2], world[s + 3]], correction)
        : turned[parent];
      turned.push(now);
      out.set(parent < 0 ? now : multiply(conjugate(turned[parent]), now), offset + joint * 4);
    }
  }
}
