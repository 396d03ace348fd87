/** The change of the edited pose that is under way: joints turn (FK), or one moves with the body following (IK). No graphics. */
import { createIkSolver, type IkSolver } from '../core/ik';
import type { Numbers } from '../core/rotation';
import type { PoseTools } from '../core/types';
import { FkTurn } from './fk-turn';
import { Footing } from './footing';
import { IkDrag } from './ik-drag';
import { PoseEdit, rotateLocal } from './pose-edit';

/** Keyboard changes within this time are one change, so that holding a key is one step to undo. Milliseconds. */
const NUDGE_PAUSE = 450;

/** What a change needs to know of whoever makes it. */
export interface ChangeHost {
  /** The pointer holds something: the change is kept when it lets go, not before. */
  holding(): boolean;
  /** The pose, or where it stands, is another one. */
  changed(): void;
}

/** One change after the other, each kept or taken back. */
export class PoseChange {
  readonly edit = new PoseEdit();
  private readonly turning = new FkTurn(this.edit);
  private readonly footing: Footing;
  private solver: IkSolver | null = null;
  /** The drag by inverse kinematics under way and where its joint is wanted. */
  private drag: { ik: IkDrag; target: number[] } | null = null;
  private nudgeTimer: ReturnType<typeof setTimeout> | undefined;

  /** @param calm no animations */
  constructor(
    private readonly host: ChangeHost,
    calm: boolean,
  ) {
    this.footing = new Footing(calm);
  }

  /** Where the pelvis is, metres. */
  get root(): ArrayLike<number> {
    return this.drag ? this.drag.ik.pose.root : this.footing.root(this.edit.quaternions);
  }

  /** Takes up another pose, 24 x 3 axis-angle; a change by the keyboard is kept first. */
  load(rotations: ArrayLike<number>): void {
    this.drag = null;
    this.flush();
    const before = this.edit.quaternions.slice();
    this.edit.load(rotations);
    // Another pose stands in the middle of the stage; the same one stays where its feet are.
    if (this.edit.quaternions.some((value, i) => Math.abs(value - before[i]) > 1e-5)) this.footing.reset();
  }

  /** Back to the middle of the stage. */
  centre(): void {
    this.footing.reset();
  }

  /** Begins to turn a joint. */
  startTurn(joint: number): void {
    this.turning.start(joint);
  }

  /** Gives a joint a rotation, x y z w. */
  turn(joint: number, rotation: ArrayLike<number>, tools: PoseTools): void {
    this.turning.to(joint, rotation, tools);
    this.host.changed();
  }

  /** Begins to move a joint. Returns where it is, metres in the world. */
  startMove(joint: number, tools: PoseTools): readonly [number, number, number] {
    const { root } = this;
    this.edit.start();
    this.solver ??= createIkSolver();
    const ik = new IkDrag(this.solver, { root, quaternions: this.edit.quaternions }, joint, tools);
    this.drag = { ik, target: ik.from.slice() };
    return ik.from;
  }

  /** Moves the joint towards a place, metres in the world, where a move has begun. */
  moveTo(target: Numbers): void {
    if (!this.drag) return;
    this.drag.target = Array.from(target);
    this.edit.setAll(this.drag.ik.to(target).quaternions);
    this.host.changed();
  }

  /** Turns a joint about one of its own axes, by the keyboard. */
  nudge(joint: number, axis: 'x' | 'y' | 'z', radians: number, tools: PoseTools): void {
    if (this.drag) this.flush();
    if (!this.edit.open) this.startTurn(joint);
    const q = this.edit.quaternions.slice();
    rotateLocal(q, joint, axis, radians);
    this.turn(joint, q.subarray(joint * 4, joint * 4 + 4), tools);
    this.expire();
  }

  /** Moves a joint by so many metres in the world, by the keyboard. */
  nudgeBy(joint: number, by: readonly [number, number, number], tools: PoseTools): void {
    const from = this.drag ? this.drag.target : this.startMove(joint, tools);
    this.moveTo(by.map((metres, i) => from[i] + metres));
    this.expire();
  }

  /** Time goes by; true while something moves by itself. */
  update(seconds: number): boolean {
    const moving = this.drag !== null && !this.drag.ik.settled;
    if (this.drag && moving) this.moveTo(this.drag.target);
    else if (this.footing.update(seconds)) this.host.changed();
    return moving || this.footing.settling;
  }

  /** Keeps the change. */
  keep(): void {
    const { drag } = this;
    this.drag = null;
    if (drag) this.footing.settle(drag.ik.pose.root);
    this.edit.commit();
    this.host.changed();
  }

  /** Keeps a keyboard change that is still open. */
  flush(): void {
    this.stopTimer();
    if (this.host.holding()) return;
    if (this.drag) this.keep();
    else this.edit.commit();
  }

  /** Takes the change back. */
  cancel(): void {
    this.stopTimer();
    this.drag = null;
    if (!this.edit.open) return;
    this.edit.cancel();
    this.host.changed();
  }

  /** Forgets that a keyboard change is to be kept. */
  dispose(): void {
    this.stopTimer();
  }

  /** A keyboard change is kept when nothing more comes for a while. */
  private expire(): void {
    this.stopTimer();
    this.nudgeTimer = setTimeout(() => this.flush(), NUDGE_PAUSE);
  }

  private stopTimer(): void {
    clearTimeout(this.nudgeTimer);
  }
}
