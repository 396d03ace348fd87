/** Which bone of an avatar is which of our joints: what is needed, and what is wrong with a mapping. */
import { JOINT_COUNT, jointIndex, JOINTS } from '../skeleton';
import type { AvatarRig } from './rig';
import { distance, dot, mean, minus, norm, pointOf, type Vector } from '../vector';

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

const SIDES = ['left', 'right'] as const;
const sided = (...parts: string[]) => parts.flatMap((part) => SIDES.map((side) => jointIndex(`${side}_${part}`)));

/** Our joints that an avatar can have bones for: what a mapping dialog lists. Fingers follow the wrist, so there are no hands. */
export const AVATAR_JOINTS: readonly number[] = [
  ...['pelvis', 'spine1', 'spine2', 'spine3', 'neck', 'head'].map(jointIndex),
  ...sided('collar', 'shoulder', 'elbow', 'wrist', 'hip', 'knee', 'ankle', 'foot'),
];
/** Those without which it cannot dance. */
export const NEEDED_JOINTS: readonly number[] = [0, ...sided('hip', 'knee', 'ankle', 'shoulder', 'elbow')];

/** Which joint must be above which: the nearest of these that has a bone. */
const ABOVE: Readonly<Record<string, readonly string[]>> = {
  spine1: ['pelvis'],
  spine2: ['spine1', 'pelvis'],
  spine3: ['spine2', 'spine1', 'pelvis'],
  neck: ['spine3', 'spine2', 'spine1', 'pelvis'],
  head: ['neck', 'spine3', 'spine2', 'spine1', 'pelvis'],
  collar: ['pelvis'],
  shoulder: ['collar', 'pelvis'],
  elbow: ['shoulder'],
  wrist: ['elbow'],
  hip: ['pelvis'],
  knee: ['hip'],
  ankle: ['knee'],
  foot: ['ankle'],
};

/** `Left knee`, as the page calls it. */
export function jointTitle(joint: number): string {
  const words = JOINTS[joint].replace(/_/g, ' ').replace(/(\d)/, ' $1');
  return words[0].toUpperCase() + words.slice(1);
}
const lower = (joint: number) => jointTitle(joint).toLowerCase();

/** The nearest joint above that has a bone; -1 for the pelvis. */
export function jointAbove(bones: Readonly<BoneMap>, joint: number): number {
  const [, side = '', part] = /^(left_|right_)?(.*)$/.exec(JOINTS[joint])!;
  for (const name of ABOVE[part] ?? []) {
    const above = Math.max(JOINTS.indexOf(side + name), JOINTS.indexOf(name));
    if (bones[above] >= 0) return above;
  }
  return -1;
}

/** True when `node` hangs on `above`, however far down. */
export function hangsOn({ parents }: Pick<AvatarRig, 'parents'>, node: number, above: number): boolean {
  for (let at = parents[node]; at >= 0; at = parents[at]) if (at === above) return true;
  return false;
}

/** Checks a mapping; empty = all is well. The blocking ones come first. */
export function checkBones(rig: AvatarRig, bones: Readonly<BoneMap>): BoneProblem[] {
  const blocking: BoneProblem[] = [];
  const stop = (joint: number, message: string) => blocking.push({ joint, message, blocking: true });
  if (bones.length !== JOINT_COUNT || bones.some((node) => node !== -1 && rig.names[node] === undefined)) {
    stop(-1, 'This mapping belongs to another avatar: choose the bones again.');
    return blocking;
  }
  for (const joint of NEEDED_JOINTS) {
    if (bones[joint] < 0) stop(joint, `Choose the bone for the ${lower(joint)}.`);
  }
  const owner = new Map<number, number>();
  for (const joint of AVATAR_JOINTS) {
    const node = bones[joint];
    if (node < 0) continue;
    const other = owner.get(node);
    if (other !== undefined) {
      stop(joint, `${jointTitle(joint)} and ${lower(other)} are the same bone, “${rig.names[node]}”: change one.`);
      continue;
    }
    owner.set(node, joint);
    const above = jointAbove(bones, joint);
    if (above >= 0 && bones[above] !== node && !hangsOn(rig, node, bones[above])) {
      stop(
        joint,
        `${jointTitle(joint)} must be below ${lower(above)}: “${rig.names[node]}” does not hang on “${rig.names[bones[above]]}”.`,
      );
    }
  }
  if (blocking.length > 0) return blocking;
  return [...shapeProblems(rig, bones)].sort((a, b) => Number(b.blocking) - Number(a.blocking));
}

/** Cosine between the back and the legs above which it is no upright body: 65 degrees from straight. */
const UPRIGHT = -0.42;

/** What the places of the bones say; the mapping has all that is needed. */
function* shapeProblems(rig: AvatarRig, bones: Readonly<BoneMap>): Generator<BoneProblem> {
  const at = (name: string): Vector => pointOf(rig.world.positions, bones[jointIndex(name)]);
  const has = (name: string) => bones[jointIndex(name)] >= 0;
  for (const side of SIDES) {
    for (const [from, to] of [
      ['hip', 'knee'],
      ['knee', 'ankle'],
      ['shoulder', 'elbow'],
    ] as const) {
      const joint = jointIndex(`${side}_${to}`);
      if (!(distance(at(`${side}_${from}`), at(`${side}_${to}`)) > 1e-4 * rig.size)) {
        const message = `${jointTitle(joint)} is at the same place as ${side} ${from}: choose bones that are apart.`;
        yield { joint, message, blocking: true };
      }
    }
  }
  const hips = mean(at('left_hip'), at('right_hip'));
  const up = minus(mean(at('left_shoulder'), at('right_shoulder')), hips);
  const legs = minus(mean(at('left_ankle'), at('right_ankle')), hips);
  if (dot(up, legs) > UPRIGHT * norm(up) * norm(legs)) {
    const message = 'The legs do not point away from the back, as on an animal on four legs: Posebeat dances on two.';
    yield { joint: -1, message, blocking: true };
    return;
  }
  for (const [from, to] of [
    ['hip', 'ankle'],
    ['shoulder', 'elbow'],
  ] as const) {
    const [left, right] = SIDES.map((side) => distance(at(`${side}_${from}`), at(`${side}_${to}`)));
    if (Math.abs(left - right) > 0.25 * Math.max(left, right)) {
      const message = `The left and the right ${from === 'hip' ? 'leg' : 'arm'} differ in length: look whether the bones are right.`;
      yield { joint: jointIndex(`left_${to}`), message, blocking: false };
    }
  }
  if (has('left_foot') && has('right_foot')) {
    const across = minus(at('left_hip'), at('right_hip'));
    const forward: Vector = [
      across[1] * up[2] - across[2] * up[1],
      across[2] * up[0] - across[0] * up[2],
      across[0] * up[1] - across[1] * up[0],
    ];
    const toes = mean(minus(at('left_foot'), at('left_ankle')), minus(at('right_foot'), at('right_ankle')));
    if (dot(toes, forward) < -0.3 * norm(toes) * norm(forward)) {
      const message = 'The toes point backwards: left and right seem to be swapped.';
      yield { joint: jointIndex('left_foot'), message, blocking: false };
    }
  }
}
