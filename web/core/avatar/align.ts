/**
 * How an avatar's rest pose differs from our T-pose, bone by bone. The same as reading somebody's motion (formats/retarget.ts), the other
 * way about: our world rotation times the alignment is theirs.
 */
import { bodyFrame, HABIT, LIMB, NEXT, snapped } from '../formats/retarget';
import { boundRest, type WorldRest } from '../formats/gltf-tree';
import { arc } from '../formats/pose-sequence';
import { REST } from '../rest';
import { conjugate, multiply, rotateVector } from '../rotation';
import { jointIndex, JOINTS } from '../skeleton';
import type { BoneMap } from './bones';
import type { AvatarRig } from './rig';
import { dot, minus, norm, pointOf, quaternionOf, type Vector } from '../vector';

const IDENTITY = [0, 0, 0, 1];

/** The alignment of a node that is turned as one of our joints. */
export type Alignment = (node: number, joint: number) => number[];

/**
 * Works out the alignments of an avatar.
 * @param driven all nodes that will be turned
 */
export function alignRest(rig: AvatarRig, bones: Readonly<BoneMap>, driven: readonly number[]): Alignment {
  // VRM says that its nodes stand in the rest pose; other files may stand in the middle of an animation, but not their skins.
  const rest: WorldRest = (rig.declared ? null : boundRest(rig.file, rig.tree, driven)) ?? rig.world;
  const theirs = (joint: string): Vector => pointOf(rest.positions, bones[jointIndex(joint)]);
  const ours = (joint: string): Vector => pointOf(REST, jointIndex(joint));
  const top = ['head', 'neck', 'left_collar', 'left_shoulder'].find((name) => bones[jointIndex(name)] >= 0)!;
  const body = snapped(multiply(bodyFrame(theirs, top), conjugate(bodyFrame(ours, top))));
  const bends = new Map<string, number[]>();

  /** How their rest pose turns a joint away from our T-pose, in their world. */
  const bend = (joint: string): number[] => {
    const known = bends.get(joint);
    if (known) return known;
    const found = workOut(joint);
    bends.set(joint, found);
    return found;
  };
  const workOut = (joint: string): number[] => {
    const [, side = '', part] = /^(left_|right_)?(.*)$/.exec(joint)!;
    // Toes are one with the foot, and a hand hangs as the forearm does: an arm lowered at rest is lowered as a whole.
    if (part === 'foot') return bend(`${side}ankle`);
    const above = part === 'wrist' ? bend(`${side}elbow`) : IDENTITY;
    const next = NEXT[joint];
    const way =
      part === 'wrist'
        ? handWay(rig, rest, bones[jointIndex(joint)])
        : next && bones[jointIndex(next)] >= 0
          ? minus(theirs(next), theirs(joint))
          : null;
    if (!next || !way || !(norm(way) > 1e-9)) return above;
    const unit = (v: Vector) => v.map((value) => value / norm(v));
    const from = rotateVector(multiply(above, body), unit(minus(ours(next), ours(joint))));
    const to = unit(way);
    if (!LIMB.test(joint) && dot(from, to) > HABIT) return above;
    const spare = rotateVector(body, /hip|knee|ankle/.test(joint) ? [1, 0, 0] : [0, 0, 1]);
    return multiply(arc(from, to, spare), above);
  };
  return (node, joint) => multiply(conjugate(multiply(bend(JOINTS[joint]), body)), quaternionOf(rest.rotations, node));
}

/** Where a hand points: to the middle of what hangs on the wrist; null where nothing does. */
function handWay(rig: AvatarRig, rest: WorldRest, wrist: number): Vector | null {
  const fingers = rig.candidates.filter((node) => rig.parents[node] === wrist);
  const way: Vector = [0, 0, 0];
  for (const finger of fingers) {
    const out = minus(pointOf(rest.positions, finger), pointOf(rest.positions, wrist));
    for (let k = 0; k < 3; k++) way[k] += out[k] / fingers.length;
  }
  return norm(way) > 1e-9 ? way : null;
}
