import { Group } from 'three';
import { DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import type { FramePose } from '../core/types';
import { Figure } from './figure';
import type { FigureAsset } from './figure-asset';

/** Two dances side by side stand this far from where each is danced, metres. */
export const APART = 0.8;

/** A pose moved sideways. */
export function aside(pose: FramePose, x: number): FramePose {
  return { quaternions: pose.quaternions, root: [pose.root[0] + x, pose.root[1], pose.root[2]] };
}

/** A second dancer, left of the first, so that two dances can be told apart at a glance. */
export class Beside {
  readonly group = new Group();
  /** Where it dances; null while there is none. */
  root: readonly [number, number] | null = null;
  private figure: Figure | null = null;
  private look: Readonly<FigureLook> = DEFAULT_LOOK;

  /** Shows a pose, or nobody. */
  set(asset: FigureAsset | null, pose: FramePose | null): void {
    this.group.visible = pose !== null;
    this.root = pose && [pose.root[0], pose.root[2]];
    if (!pose || !asset) return;
    if (!this.figure) {
      this.figure = new Figure(asset);
      this.figure.wear(this.look);
      this.group.add(this.figure.mesh);
    }
    this.figure.show(aside(pose, -APART));
  }

  /** Dresses the second dancer, also one who is yet to come. */
  wear(look: Readonly<FigureLook>): void {
    this.look = look;
    this.figure?.wear(look);
  }

  /** Frees the dancer. */
  dispose(): void {
    this.figure?.dispose();
  }
}
