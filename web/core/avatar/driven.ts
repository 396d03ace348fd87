/** Which of an avatar's nodes are turned, as which of our joints, and how they hang together. */
import { conjugate, multiply, rotateVector } from '../rotation';
import { jointIndex } from '../skeleton';
import { alignRest } from './align';
import { AVATAR_JOINTS, type BoneMap } from './bones';
import type { AvatarRig } from './rig';
import { minus, pointOf, quaternionOf } from '../vector';

/** A node that is turned in every frame. */
export interface DrivenNode {
  node: number;
  /** Our joint whose world rotation it takes; `share` of the way to that of `other`, where its back has other bones than ours. */
  joint: number;
  other: number;
  share: number;
  /** Place in the list of the one it hangs on; -1 for the hips. */
  parent: number;
  /** Our world rotation times this is its world rotation. */
  alignment: Float64Array;
  /** Rotation of what lies between it and its parent, and its place in the parent's axes, scene units. */
  between: Float64Array;
  offset: Float64Array;
}

const BACK = ['pelvis', 'spine1', 'spine2', 'spine3'].map(jointIndex);
const NECK = ['neck', 'head'].map(jointIndex);

/** Nodes that are turned, each after its parent; the hips first. */
export function driveNodes(rig: AvatarRig, bones: Readonly<BoneMap>): DrivenNode[] {
  const sources = new Map<number, { joint: number; other: number; share: number }>();
  for (const joint of AVATAR_JOINTS) {
    if (bones[joint] >= 0) sources.set(bones[joint], { joint, other: joint, share: 0 });
  }
  const chest = [...BACK].reverse().find((joint) => bones[joint] >= 0)!;
  spread(rig, bones, [...BACK], chest, sources);
  const neck = [...NECK].reverse().find((joint) => bones[joint] >= 0);
  // The neck goes on from the chest, whichever bone that is.
  if (neck !== undefined) {
    const above = bones.map((node, joint) => (joint === BACK[3] ? bones[chest] : node));
    spread(rig, above, [BACK[3], ...NECK], neck, sources);
  }
  const order = rig.tree.order.filter((node) => sources.has(node));
  const place = new Map(order.map((node, i) => [node, i]));
  const align = alignRest(rig, bones, order);
  return order.map((node, i) => {
    let parent = rig.parents[node];
    while (i > 0 && !place.has(parent)) parent = rig.parents[parent];
    const above = rig.parents[node];
    const rest = (at: number) => (at < 0 ? [0, 0, 0, 1] : quaternionOf(rig.world.rotations, at));
    const base = i > 0 ? rest(parent) : [0, 0, 0, 1];
    const way = i > 0 ? minus(pointOf(rig.world.positions, node), pointOf(rig.world.positions, parent)) : [0, 0, 0];
    const source = sources.get(node)!;
    return {
      node,
      ...source,
      parent: i > 0 ? place.get(parent)! : -1,
      alignment: Float64Array.from(align(node, source.joint)),
      between: Float64Array.from(multiply(conjugate(base), rest(above))),
      offset: Float64Array.from(rotateVector(conjugate(base), way)),
    };
  });
}

/**
 * Spreads the turns of a chain of our joints over all bones of theirs: theirs that are mapped take their joint's, the last one that of our
 * last, so that nothing of the bend is lost, and those between take what is between.
 */
function spread(
  rig: AvatarRig,
  bones: Readonly<BoneMap>,
  joints: readonly number[],
  last: number,
  sources: Map<number, { joint: number; other: number; share: number }>,
): void {
  const [first] = joints;
  if (bones[last] === bones[first]) return;
  const chain: number[] = [];
  for (let at = bones[last]; at >= 0 && at !== bones[first]; at = rig.parents[at]) chain.unshift(at);
  const anchors = [{ index: -1, place: 0 }];
  chain.forEach((node, index) => {
    const place = index === chain.length - 1 ? joints.length - 1 : joints.findIndex((joint) => bones[joint] === node);
    if (place > anchors[anchors.length - 1].place) anchors.push({ index, place });
  });
  for (let i = 1; i < anchors.length; i++) {
    const [from, to] = [anchors[i - 1], anchors[i]];
    for (let index = from.index + 1; index <= to.index; index++) {
      const place = from.place + ((to.place - from.place) * (index - from.index)) / (to.index - from.index);
      const low = Math.min(Math.floor(place), joints.length - 2);
      sources.set(chain[index], { joint: joints[low], other: joints[low + 1], share: place - low });
    }
  }
}
