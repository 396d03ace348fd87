/** A guess at which bone is which: the file's own word first, then names, then places. */
import { jointsByName } from '../formats/humanoid';
import { jointIndex } from '../skeleton';
import { AVATAR_JOINTS, checkBones, hangsOn, NEEDED_JOINTS, type BoneMap } from './bones';
import type { AvatarRig } from './rig';
import { bodyByShape } from './shape';

/** A mapping that may lack joints. */
export interface BoneGuess {
  bones: BoneMap;
  /** What the guess rests on: the file's own word, the names, or where the bones are. */
  by: 'file' | 'names' | 'shape';
}

const HANDS = ['left_hand', 'right_hand'].map(jointIndex);
const ENDS = ['left_shoulder', 'right_shoulder', 'left_hip', 'right_hip'].map(jointIndex);
const SPINE = ['spine1', 'spine2', 'spine3'].map(jointIndex);
/** Skins of one file whose names are looked at one by one, where the file holds several figures. */
const MOST_SKINS = 8;

/**
 * Guesses which bone is which. The guess may lack joints: `checkBones` says which, and the visitor is asked.
 * @throws Error with a sentence for the visitor when it is surely no human body (a chair, an animal on four legs)
 */
export function guessBones(rig: AvatarRig): BoneGuess {
  if (rig.declared) {
    const { declared } = rig;
    const bones = byNames(rig, (node) => declared.get(node) ?? '');
    if (missing(bones) === 0) return { bones, by: 'file' };
  }
  const named = bestByNames(rig);
  if (missing(named) === 0) {
    const animal = checkBones(rig, named).find(({ joint, blocking }) => joint < 0 && blocking);
    if (animal) throw new Error(animal.message);
    return { bones: named, by: 'names' };
  }
  const { bones: shaped, fourLegs } = bodyByShape(rig);
  if (fourLegs) {
    throw new Error(
      'This looks like an animal on four legs: Posebeat dances on two. Choose a figure with arms and legs.',
    );
  }
  const few = missing(named) > NEEDED_JOINTS.length / 2;
  if (few && missing(shaped) > NEEDED_JOINTS.length / 2 && missing(named) >= NEEDED_JOINTS.length - 2) {
    throw new Error(
      'No body was found in this file: nothing in it looks like arms and legs. Choose a figure that has both.',
    );
  }
  const bones = few
    ? shaped
    : named.map((node, joint) => (node < 0 && !named.includes(shaped[joint]) ? shaped[joint] : node));
  findMiddle(rig, bones);
  return { bones, by: 'shape' };
}

function missing(bones: Readonly<BoneMap>): number {
  return NEEDED_JOINTS.filter((joint) => bones[joint] < 0).length;
}

function byNames(
  rig: AvatarRig,
  nameOf: (node: number) => string,
  only: ReadonlySet<number> = new Set(rig.candidates),
): BoneMap {
  const bones = jointsByName(rig.names.map((_, node) => (only.has(node) ? nameOf(node) : '')));
  for (const hand of HANDS) bones[hand] = -1;
  findMiddle(rig, bones);
  return bones;
}

/** By names, all bones together or, where a file holds several figures, the skin that makes the best body. */
function bestByNames(rig: AvatarRig): BoneMap {
  const nameOf = (node: number) => rig.names[node];
  const all = byNames(rig, nameOf);
  if (missing(all) > 0 || checkBones(rig, all).every(({ blocking }) => !blocking)) return all;
  const skins = [...rig.file.json.skins].sort((a, b) => b.joints.length - a.joints.length).slice(0, MOST_SKINS);
  const sound = skins
    .map(({ joints }) => byNames(rig, nameOf, new Set(joints)))
    .find((bones) => missing(bones) === 0 && checkBones(rig, bones).every(({ blocking }) => !blocking));
  return sound ?? all;
}

/** Pelvis and back by their place, in place: what carries arms and legs, and what is between. Their names differ most of all. */
function findMiddle(rig: AvatarRig, bones: BoneMap): void {
  const ends = ENDS.map((joint) => bones[joint]);
  if (ends.some((node) => node < 0)) return;
  const carries = (node: number) => node >= 0 && ends.every((end) => hangsOn(rig, end, node));
  if (!carries(bones[0])) bones[0] = common(rig, ends);
  for (const joint of SPINE) bones[joint] = -1;
  const chest = common(rig, ends.slice(0, 2));
  const back: number[] = [];
  for (let at = chest; at >= 0 && at !== bones[0]; at = rig.parents[at]) back.unshift(at);
  const taken = new Set(AVATAR_JOINTS.map((joint) => bones[joint]));
  const free = back.filter((node) => !taken.has(node));
  if (bones[0] < 0 || free.length === 0) return;
  bones[SPINE[0]] = free[0];
  if (free.length > 1) bones[SPINE[2]] = free[free.length - 1];
  if (free.length > 2) bones[SPINE[1]] = free[Math.floor(free.length / 2)];
}

/** The lowest bone that all of these hang on; -1 where there is none. */
function common({ parents }: AvatarRig, nodes: readonly number[]): number {
  const above = nodes.map((node) => {
    const chain: number[] = [];
    for (let at = parents[node]; at >= 0; at = parents[at]) chain.push(at);
    return chain;
  });
  const others = above.slice(1).map((chain) => new Set(chain));
  return above[0].find((node) => others.every((chain) => chain.has(node))) ?? -1;
}
