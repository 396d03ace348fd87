/** Our dance on an avatar, frame by frame. */
import type { FramePose } from '../types';
import type { BoneMap } from './bones';
import type { AvatarRig } from './rig';

/** What an avatar's nodes are set to. */
export interface AvatarFrame {
  /** Local rotations of `nodes`, nodes x 4 (x y z w). */
  rotations: Float32Array;
  /** Local translation of `nodes[0]`, 3 numbers in its parent's units. */
  hips: Float32Array;
}

/** Carries our poses over to an avatar. The same pose always gives the same frame, whatever came before. */
export class AvatarRetargeter {
  /** The file's nodes that are turned, each after its parent; the first is the hips, the only one that is moved too. */
  readonly nodes: readonly number[] = [];
  /** The avatar's leg over ours: scene units per metre of our dance. */
  readonly scale: number = 1;
  /** Height of the avatar standing, scene units. */
  readonly height: number = 1;
  /** What its scene is to be scaled by on the stage: 1 unless it is no human size in metres. */
  readonly displayScale: number = 1;

  /** @throws Error with the first blocking problem of the mapping */
  constructor(rig: AvatarRig, bones: Readonly<BoneMap>) {
    throw new Error(`Avatars cannot dance yet (${rig.kind}, ${bones.length}).`);
  }

  /** Room for a frame. */
  createFrame(): AvatarFrame {
    return { rotations: new Float32Array(this.nodes.length * 4), hips: new Float32Array(3) };
  }

  /**
   * One frame, without garbage.
   * @param pose metres, floor at y = 0
   * @returns out
   */
  frame(pose: FramePose, out: AvatarFrame): AvatarFrame {
    void pose;
    return out;
  }
}
