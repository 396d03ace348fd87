/** A guess at which bone is which. */
import type { BoneMap } from './bones';
import type { AvatarRig } from './rig';

export interface BoneGuess {
  bones: BoneMap;
  /** What the guess rests on: the file's own word, the names, or where the bones are. */
  by: 'file' | 'names' | 'shape';
}

/**
 * Guesses which bone is which. The guess may lack joints: `checkBones` says which, and the visitor is asked.
 * @throws Error with a sentence for the visitor when it is surely no human body (a chair, an animal on four legs)
 */
export function guessBones(rig: AvatarRig): BoneGuess {
  throw new Error(`Avatars cannot be read yet (${rig.kind}).`);
}
