/** The pose being edited, without any graphics: local rotations in, changed rotations out, every change in phases. */
import { JOINTS } from '../core/skeleton';
import { axisAngleToQuaternion, multiply, poseToQuaternions, quaternionsToPose, type Numbers } from '../core/rotation';

/** A change begins, goes on, and is then kept or taken back. */
export type PosePhase = 'start' | 'change' | 'commit' | 'cancel';
/** `rotations`: 24 x 3 axis-angle, radians. */
export type PoseListener = (rotations: number[], phase: PosePhase) => void;

const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] } as const;

/** Plain-English name of a joint, e.g. "Left elbow". */
export function jointLabel(joint: number): string {
  const words: Record<string, string> = {
    pelvis: 'Hips (whole body)',
    spine1: 'Lower back',
    spine2: 'Waist',
    spine3: 'Chest',
  };
  const name = JOINTS[joint];
  const plain = words[name] ?? name.replace('_foot', '_toes').replace('_hand', '_fingers').replace('_', ' ');
  return plain[0].toUpperCase() + plain.slice(1);
}

/** Turns one joint about one of its own axes, in place. */
export function rotateLocal(quaternions: Float32Array, joint: number, axis: 'x' | 'y' | 'z', radians: number): void {
  const turn = axisAngleToQuaternion(AXES[axis].map((c) => c * radians));
  const q = multiply(quaternions.subarray(joint * 4, joint * 4 + 4), turn);
  const length = Math.hypot(q[0], q[1], q[2], q[3]);
  for (let i = 0; i < 4; i++) quaternions[joint * 4 + i] = q[i] / length;
}

/** A pose with begin / change / commit / cancel. */
export class PoseEdit {
  /** Local rotations, 24 x 4. */
  readonly quaternions = poseToQuaternions(new Array<number>(JOINTS.length * 3).fill(0));
  private before: Float32Array | null = null;
  private readonly listeners = new Set<PoseListener>();

  /** Whether a change has begun and is neither kept nor taken back. */
  get open(): boolean {
    return this.before !== null;
  }

  /** Loads a pose, dropping a change that is under way. No listener hears of it. */
  load(rotations: Numbers): void {
    this.before = null;
    poseToQuaternions(rotations, this.quaternions);
  }

  /** Listens to changes; returns how to stop. */
  listen(listener: PoseListener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Begins a change unless one is under way. */
  start(): void {
    if (this.before) return;
    this.before = this.quaternions.slice();
    this.tell('start');
  }

  /** Sets every joint's local rotation, 24 x 4. */
  setAll(quaternions: Numbers): void {
    this.start();
    this.quaternions.set(Array.from(quaternions));
    this.tell('change');
  }

  /** Keeps the change. */
  commit(): void {
    if (!this.before) return;
    this.before = null;
    this.tell('commit');
  }

  /** Takes the change back. */
  cancel(): void {
    if (!this.before) return;
    this.quaternions.set(this.before);
    this.before = null;
    this.tell('cancel');
  }

  private tell(phase: PosePhase): void {
    const rotations = quaternionsToPose(this.quaternions);
    for (const listener of this.listeners) listener(rotations, phase);
  }
}
