/** Which bone of an avatar is which of our joints: checking a mapping. */
import type { AvatarRig } from './rig';

/** For each of our 24 joints the avatar's node, -1 = it has none. */
export type BoneMap = number[];

/** What is wrong with a mapping. */
export interface BoneProblem {
  /** Our joint that it is about; -1 = the whole body. */
  joint: number;
  /** A sentence for the visitor. */
  message: string;
  /** False: the avatar dances all the same, perhaps not well. */
  blocking: boolean;
}

/** Our joints that an avatar can have bones for, from the pelvis up, left before right: what a mapping dialog lists. */
export const AVATAR_JOINTS: readonly number[] = [];
/** Those without which it cannot dance. */
export const NEEDED_JOINTS: readonly number[] = [];

/** Checks a mapping; empty = all is well. */
export function checkBones(rig: AvatarRig, bones: Readonly<BoneMap>): BoneProblem[] {
  void [rig, bones];
  return [];
}
