/** Turns of a joint by forward kinematics: within its limits, and mirrored on the other side. No graphics. */
import { clampRotation, limitExcess } from '../core/joint-limits';
import { MIRROR } from '../core/skeleton';
import type { PoseTools } from '../core/types';
import type { PoseEdit } from './pose-edit';

/** Changes the pose that is edited, one turn after the other. */
export class FkTurn {
  /** Degrees that the joint was outside its limits before, and its other side. */
  private slack = [0, 0];

  constructor(private readonly edit: PoseEdit) {}

  /** Begins a change. */
  start(joint: number): void {
    this.edit.start();
    const { quaternions } = this.edit;
    this.slack = [joint, MIRROR[joint]].map((each) => limitExcess(each, quaternions.subarray(each * 4, each * 4 + 4)));
  }

  /** Gives the joint a rotation (x y z w), inside the limits where they are on, and the other side its mirror image. */
  to(joint: number, rotation: ArrayLike<number>, { limits, mirror }: Pick<PoseTools, 'limits' | 'mirror'>): void {
    const next = this.edit.quaternions.slice();
    const set = (each: number, value: ArrayLike<number>, slack: number) =>
      next.set(limits ? clampRotation(each, value, undefined, slack) : value, each * 4);
    set(joint, rotation, this.slack[0]);
    const [x, y, z, w] = next.subarray(joint * 4, joint * 4 + 4);
    const other = MIRROR[joint];
    if (mirror && other !== joint) set(other, [x, -y, -z, w], Math.max(...this.slack));
    this.edit.setAll(next);
  }
}
