/** Opening a character's file. Loaded when the first one comes, with all that reads and shows it. */
import { AVATAR_JOINTS, checkBones, NEEDED_JOINTS, type BoneMap, type BoneProblem } from '../core/avatar/bones';
import { guessBones, type BoneGuess } from '../core/avatar/guess';
import { readAvatarRig, type AvatarRig } from '../core/avatar/rig';
import { JOINTS, JOINT_COUNT } from '../core/skeleton';
import { gltfParts } from './avatar-file';
import type { AvatarMapping, BoneChoice } from './avatar-state';

export { openAvatar } from '../scene/avatar';
export { AVATAR_JOINTS, guessBones };

/** A file that was looked through. */
export interface CharacterFile {
  rig: AvatarRig;
  guess: BoneGuess;
}

/**
 * Looks a file through.
 * @throws Error with a sentence for the visitor when there is no character in it that can dance
 */
export function readCharacter(bytes: Uint8Array): CharacterFile {
  if (!gltfParts(bytes).character) {
    throw new Error(
      'There is no character in it: nothing is moved by bones. Export the mesh together with its skeleton.',
    );
  }
  const rig = readAvatarRig(bytes);
  return { rig, guess: guessBones(rig) };
}

/** What the dialog of bones says about a choice. */
export function judgeBones(rig: AvatarRig, map: BoneMap): Pick<AvatarMapping, 'problems' | 'notes' | 'usable'> {
  const all: readonly BoneProblem[] = checkBones(rig, map);
  const problems = Array.from({ length: JOINT_COUNT }, (_, joint) => {
    const own = all.filter((problem) => problem.joint === joint);
    return (own.find(({ blocking }) => blocking) ?? own[0])?.message ?? null;
  });
  const notes = all.filter(({ joint }) => joint < 0).map(({ message }) => message);
  return { problems, notes, usable: all.every(({ blocking }) => !blocking) };
}

/** The bones of a character, as a list to choose from: what hangs on another stands further in. */
export function boneChoices(rig: AvatarRig): BoneChoice[] {
  const least = Math.min(...rig.candidates.map((node) => rig.depths[node]));
  return rig.candidates.map((node) => ({
    node,
    name: `${'\u2003'.repeat(Math.min(rig.depths[node] - least, 12))}${rig.names[node]}`,
  }));
}

/**
 * A choice of bones by names, on top of a guess.
 * @param bones our joint's name -> the file's node name
 * @throws Error naming what is not there
 */
export function bonesByName(rig: AvatarRig, guess: BoneMap, bones: Readonly<Record<string, string>>): BoneMap {
  const map = [...guess];
  for (const [joint, name] of Object.entries(bones)) {
    const at = JOINTS.indexOf(joint);
    if (at < 0) throw new Error(`No joint is called "${joint}". Joints: ${JOINTS.join(', ')}.`);
    const node = rig.candidates.find((each) => rig.names[each] === name);
    if (node === undefined) throw new Error(`The character has no bone "${name}".`);
    map[at] = node;
  }
  return map;
}

/** True for a map that can only have come from this file. */
export function mapFits(rig: AvatarRig, map: readonly number[]): boolean {
  return NEEDED_JOINTS.every((joint) => map[joint] >= 0) && map.every((node) => node < rig.names.length);
}
