/**
 * A guess at a body from the places of its bones alone: two pairs of limbs of equal length, one pointing away from the back (legs), the
 * other spread the widest (arms).
 */
import { JOINT_COUNT, jointIndex } from '../skeleton';
import type { BoneMap } from './bones';
import { splitArm, splitLeg } from './limbs';
import type { AvatarRig } from './rig';
import { cross, distance, dot, mean, minus, norm, pointOf, type Vector } from '../vector';

/** Limbs that differ by less than this share in length are a pair. */
const ALIKE = 0.15;
/** Of a bone with very many children the longest are looked at: a hostile file must not take long. */
const MOST_CHILDREN = 12;
/** No limb has more bones than this. */
const MOST_STEPS = 60;
/** Cosines between back and legs: below the first a body stands upright, up to the second it goes on four legs. */
const UPRIGHT = -0.42;
const FOUR_LEGS = 0.5;

/** What was found. */
export interface BodyShape {
  bones: BoneMap;
  /** Surely an animal. */
  fourLegs: boolean;
}

interface Pair {
  /** The bone on which both hang. */
  node: number;
  a: number[];
  b: number[];
  /** Length of one, mean direction of both from the root to the tip, distance between the tips. */
  length: number;
  way: Vector;
  span: number;
}

/** Looks for a body; bones that it cannot tell are -1. */
export function bodyByShape(rig: AvatarRig): BodyShape {
  const tree = growTree(rig);
  const pairs = findPairs(rig, tree);
  const at = (node: number) => pointOf(rig.world.positions, node);
  let best: { legs: Pair; arms: Pair; score: number } | null = null;
  let fourLegs = false;
  for (const legs of pairs) {
    for (const arms of pairs) {
      if (legs.node === arms.node || within(rig, arms.node, legs) || within(rig, legs.node, arms)) continue;
      const back = minus(at(arms.node), at(legs.node));
      const cosine = dot(back, legs.way) / (norm(back) * norm(legs.way) || 1);
      const score = legs.length + arms.span;
      if (cosine < UPRIGHT) {
        if (!best || score > best.score) best = { legs, arms, score };
      } else if (cosine < FOUR_LEGS && dot(legs.way, arms.way) > 0.7 * norm(legs.way) * norm(arms.way)) {
        fourLegs ||= legs.length > 0.25 * rig.size && arms.length > 0.25 * rig.size;
      }
    }
  }
  const bones = new Array<number>(JOINT_COUNT).fill(-1);
  if (best && !(fourLegs && best.score < 0.6 * rig.size)) {
    fillIn(rig, tree, best.legs, best.arms, bones);
    fourLegs = false;
  }
  return { bones, fourLegs };
}

interface Tree {
  children: number[][];
  /** The longest chain from each bone on downwards, in bones, and how long it is. */
  next: Int32Array;
  reach: Float64Array;
}

function growTree({ candidates, parents, world }: AvatarRig): Tree {
  const chosen = new Set(candidates);
  const children: number[][] = parents.map(() => []);
  const next = new Int32Array(parents.length).fill(-1);
  const reach = new Float64Array(parents.length);
  for (let i = candidates.length - 1; i >= 0; i--) {
    const node = candidates[i];
    const parent = parents[node];
    if (!chosen.has(parent)) continue;
    children[parent].unshift(node);
    const whole = reach[node] + distance(pointOf(world.positions, node), pointOf(world.positions, parent));
    if (whole > reach[parent] || next[parent] < 0) [reach[parent], next[parent]] = [whole, node];
  }
  return { children, next, reach };
}

/** The longest chain from a bone on, bones on top of each other left out. */
function chainFrom({ next }: Tree, node: number, rig: AvatarRig): number[] {
  const chain = [node];
  for (let at = next[node], steps = 0; at >= 0 && steps < MOST_STEPS; at = next[at], steps++) {
    const last = pointOf(rig.world.positions, chain[chain.length - 1]);
    if (distance(last, pointOf(rig.world.positions, at)) > 0.004 * rig.size) chain.push(at);
  }
  return chain;
}

function findPairs(rig: AvatarRig, tree: Tree): Pair[] {
  const pairs: Pair[] = [];
  for (const node of rig.candidates) {
    const limbs = tree.children[node]
      .filter((child) => tree.reach[child] > 0.1 * rig.size)
      .sort((a, b) => tree.reach[b] - tree.reach[a])
      .slice(0, MOST_CHILDREN)
      .map((child) => chainFrom(tree, child, rig))
      .filter((chain) => chain.length >= 3);
    for (let i = 0; i < limbs.length; i++) {
      for (let k = i + 1; k < limbs.length; k++) {
        const pair = pairOf(rig, tree, node, limbs[i], limbs[k]);
        if (pair) pairs.push(pair);
      }
    }
  }
  return pairs.sort((a, b) => b.length - a.length).slice(0, 60);
}

function pairOf(rig: AvatarRig, tree: Tree, node: number, a: number[], b: number[]): Pair | null {
  const at = (bone: number) => pointOf(rig.world.positions, bone);
  const [la, lb] = [tree.reach[a[0]], tree.reach[b[0]]];
  if (Math.abs(la - lb) > ALIKE * Math.max(la, lb)) return null;
  const [tipA, tipB] = [at(a[a.length - 1]), at(b[b.length - 1])];
  const [wayA, wayB] = [minus(tipA, at(a[0])), minus(tipB, at(b[0]))];
  const span = distance(tipA, tipB);
  // A finger beside its neighbour, or one chain behind the other, is no pair of limbs.
  if (span < 0.05 * rig.size) return null;
  return { node, a, b, length: (la + lb) / 2, way: mean(wayA, wayB), span };
}

/** True when a bone is part of the limbs. */
function within({ parents }: AvatarRig, node: number, { a, b }: Pair): boolean {
  for (let at = node; at >= 0; at = parents[at]) if (at === a[0] || at === b[0]) return true;
  return false;
}

function fillIn(rig: AvatarRig, tree: Tree, legs: Pair, arms: Pair, bones: BoneMap): void {
  const at = (node: number) => pointOf(rig.world.positions, node);
  const up = minus(at(arms.node), at(legs.node));
  const put = (name: string, node: number | undefined) => (bones[jointIndex(name)] = node ?? -1);
  const legsOf = [legs.a, legs.b].map((chain) => splitLeg(chain, chain.map(at), up));
  const left = leftWay(
    up,
    legsOf.map(({ ankle, tip }) => minus(at(tip), at(ankle))),
  );
  const sides = (pair: Pair) =>
    dot(minus(at(pair.a[0]), at(pair.b[0])), left) >= 0 ? ['left', 'right'] : ['right', 'left'];
  sides(legs).forEach((side, i) => {
    const { hip, knee, ankle, toe } = legsOf[i];
    put(`${side}_hip`, hip);
    put(`${side}_knee`, knee);
    put(`${side}_ankle`, ankle);
    put(`${side}_foot`, toe);
  });
  sides(arms).forEach((side, i) => {
    const chain = cutAtFingers([arms.a, arms.b][i], tree);
    const { collar, shoulder, elbow, wrist } = splitArm(chain.bones, chain.bones.map(at), chain.cut);
    put(`${side}_collar`, collar);
    put(`${side}_shoulder`, shoulder);
    put(`${side}_elbow`, elbow);
    put(`${side}_wrist`, wrist);
  });
  const rest = tree.children[arms.node].filter((child) => child !== arms.a[0] && child !== arms.b[0]);
  const above = rest
    .map((child) => ({ child, height: dot(minus(at(child), at(arms.node)), up) }))
    .filter(({ height }) => height > 0)
    .sort((a, b) => b.height - a.height)[0]?.child;
  if (above === undefined) return;
  const higher = tree.children[above].find(
    (child) => dot(minus(at(child), at(above)), up) > 0 && tree.children[above].length === 1,
  );
  if (higher === undefined) put('head', above);
  else {
    put('neck', above);
    put('head', higher);
  }
}

/** Which way is left: up crossed with where the toes point; where they do not tell, glTF's own forward, +Z. */
function leftWay(up: Vector, feet: readonly Vector[]): Vector {
  const flat = (v: Vector): Vector => {
    const along = dot(v, up) / dot(up, up);
    return [v[0] - along * up[0], v[1] - along * up[1], v[2] - along * up[2]];
  };
  const toes = flat(mean(feet[0], feet[1]));
  const sure = norm(toes) > 0.02 * norm(up);
  const forward = sure
    ? toes
    : [
        [0, 0, 1],
        [0, -1, 0],
        [1, 0, 0],
      ]
        .map((v) => flat(v as Vector))
        .find((v) => norm(v) > 0.5)!;
  return cross(up, forward);
}

/** An arm's chain up to the bone from which fingers go out: the wrist. */
function cutAtFingers(chain: readonly number[], { children }: Tree): { bones: number[]; cut: boolean } {
  const wrist = chain.findIndex(
    (node, i) => i >= 2 && children[node].filter((child) => children[child].length > 0).length >= 3,
  );
  return wrist < 0 ? { bones: [...chain], cut: false } : { bones: chain.slice(0, wrist + 1), cut: true };
}
