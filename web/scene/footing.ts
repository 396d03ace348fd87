/** Where the edited figure stands while poses, which are rotations only, come and go. */
import type { Numbers } from '../core/rotation';
import { standingRoot } from './body-points';

/** Time in which the figure settles on the floor after a drag, seconds. */
const SETTLING = 0.22;
/** A figure that walked this far from the middle goes back there, metres. */
const ASTRAY = 0.6;

/**
 * The pelvis of the edited figure. A pose says nothing of it: the lowest point of the body stands on the floor, at a spot that is
 * kept from edit to edit. A drag that holds feet in place moves the pelvis over them; when it is kept, the spot goes with it, so that
 * planted feet stay where they are, and only what is left in the air sinks to the floor, within a moment.
 */
export class Footing {
  private spot: [number, number] = [0, 0];
  private from: readonly number[] | null = null;
  private elapsed = 0;

  /** @param calm no animation: settles at once */
  constructor(private readonly calm: boolean) {}

  /** Whether the figure is on its way to the floor. */
  get settling(): boolean {
    return this.from !== null;
  }

  /** Pelvis position of a pose, metres. */
  root(quaternions: Numbers): [number, number, number] {
    const to: [number, number, number] = [this.spot[0], standingRoot(quaternions)[1], this.spot[1]];
    if (!this.from) return to;
    const t = this.elapsed / SETTLING;
    const eased = 1 - (1 - t) ** 3;
    return [0, 1, 2].map((i) => this.from![i] + (to[i] - this.from![i]) * eased) as [number, number, number];
  }

  /** A drag ended with the pelvis here. */
  settle(root: Numbers): void {
    this.spot = Math.hypot(root[0], root[2]) > ASTRAY ? [0, 0] : [root[0], root[2]];
    this.from = this.calm ? null : [root[0], root[1], root[2]];
    this.elapsed = 0;
  }

  /** Time goes by; true while the figure moves. */
  update(seconds: number): boolean {
    if (!this.from) return false;
    this.elapsed += seconds;
    if (this.elapsed >= SETTLING) this.from = null;
    return true;
  }

  /** Back to the middle of the stage, at once. */
  reset(): void {
    this.spot = [0, 0];
    this.from = null;
  }
}
