/** Which joint of somebody's skeleton is which of ours, by the names that motion capture, games and avatars use. */
import { jointIndex, JOINT_COUNT } from '../skeleton';

type Side = 'left' | 'right';

/** A skeleton with names. */
export interface NamedSkeleton {
  names: readonly string[];
  /** Index of each joint's parent; -1 for a root. */
  parents: readonly number[];
}

/** Stems for each joint of a side, the surest first. Some words mean two things: see `stemsOf`. */
const STEMS = {
  hip: ['upleg', 'upperleg', 'thigh', 'hip'],
  knee: ['lowerleg', 'lowleg', 'shin', 'calf', 'knee', 'leg'],
  ankle: ['ankle', 'foot'],
  foot: ['toebase', 'toes', 'toe', 'toe0', 'toe01', 'ball'],
  collar: ['collar', 'clavicle'],
  shoulder: ['upperarm', 'uparm', 'arm', 'shldr', 'shoulder'],
  elbow: ['forearm', 'lowerarm', 'lowarm', 'elbow'],
  wrist: ['wrist', 'hand'],
  hand: ['handmiddle1', 'middle1', 'middle01', 'middlefinger1', 'middleproximal'],
} as const;
type Part = keyof typeof STEMS;
const PARTS = Object.keys(STEMS) as Part[];
/** Without these there is no pose to take. */
const NEEDED: readonly Part[] = ['hip', 'knee', 'shoulder', 'elbow'];

/** A joint's name without prefixes, signs and side. */
export function plainName(name: string): { side: Side | null; stem: string } {
  let text = name
    .replace(/^.*[:|]/, '')
    .replace(/^mixamorig\d*_?/i, '')
    .replace(/^(j_bip_(c_)?|bip\d*[ _]|def[-_]|org[-_]|m_avg_|avg_|cc_base_|valvebiped[._])/i, '');
  let side: Side | null = null;
  const word = /left|right/i.exec(text);
  const alone = /(?:^|[\s_.-])([lr])(?=$|[\s_.-])/i.exec(text);
  const leading = /^([lrLR])(?=[A-Z])/.exec(text);
  const trailing = /[a-z0-9]([LR])$/.exec(text);
  if (word) {
    side = word[0].toLowerCase() as Side;
    text = text.replace(word[0], '');
  } else if (alone) {
    side = alone[1].toLowerCase() === 'l' ? 'left' : 'right';
    text = text.replace(alone[0], '');
  } else if (leading) {
    side = leading[1].toLowerCase() === 'l' ? 'left' : 'right';
    text = text.slice(1);
  } else if (trailing) {
    side = trailing[1] === 'L' ? 'left' : 'right';
    text = text.slice(0, -1);
  }
  const stem = text
    .toLowerCase()
    .replace(/[^a-z0-9]/g, '')
    .replace(/(joint|jnt|bone)$/, '');
  return { side, stem };
}

/** The stems that stand for a part, given which stems the side has: a foot after an ankle is the toes, and so on. */
function stemsOf(part: Part, has: ReadonlySet<string>): readonly string[] {
  if (part === 'foot' && has.has('ankle')) return [...STEMS.foot, 'foot'];
  if (part === 'hand' && has.has('wrist')) return ['hand', ...STEMS.hand];
  if (part === 'collar' && ['upperarm', 'uparm', 'arm'].some((stem) => has.has(stem)))
    return [...STEMS.collar, 'shoulder'];
  return STEMS[part];
}

/**
 * The joints of arms, legs, neck and head that a skeleton's names tell, and its pelvis where one is called so.
 * @returns for each of our joints the index of theirs, -1 where no name tells
 */
export function jointsByName(names: readonly string[]): number[] {
  const map = new Array<number>(JOINT_COUNT).fill(-1);
  const plain = names.map(plainName);
  const find = (side: Side | null, stems: readonly string[], taken: ReadonlySet<number> = new Set()): number => {
    for (const stem of stems) {
      const at = plain.findIndex((each, i) => each.side === side && each.stem === stem && !taken.has(i));
      if (at >= 0) return at;
    }
    return -1;
  };
  for (const side of ['left', 'right'] as const) {
    const has = new Set(plain.filter((each) => each.side === side).map((each) => each.stem));
    const taken = new Set<number>();
    for (const part of PARTS) {
      const at = find(side, stemsOf(part, has), taken);
      if (at < 0) continue;
      taken.add(at);
      map[jointIndex(`${side}_${part}`)] = at;
    }
  }
  map[jointIndex('pelvis')] = find(null, ['hips', 'pelvis', 'hip']);
  map[jointIndex('neck')] = find(null, ['neck', 'neck1', 'neck01', 'neck0']);
  map[jointIndex('head')] = find(null, ['head']);
  return map;
}

/**
 * Finds our 24 joints in a skeleton.
 * @returns for each of our joints the index of theirs, -1 where they have none
 * @throws Error naming what is missing when it is no human body
 */
export function mapHumanoid({ names, parents }: NamedSkeleton): number[] {
  const map = jointsByName(names);
  const missing = (['left', 'right'] as const).flatMap((side) =>
    NEEDED.filter((part) => map[jointIndex(`${side}_${part}`)] < 0).map((part) => `${side} ${part}`),
  );
  if (missing.length > 0) {
    throw new Error(
      `This skeleton is not one that Posebeat can read: no joint is named like the ${missing.slice(0, 3).join(', ')}${
        missing.length > 3 ? ` and ${missing.length - 3} more` : ''
      }. Common names (CMU, Mixamo, VRM, SMPL, Unreal) are understood.`,
    );
  }
  const above = (joint: number): number[] => {
    const chain: number[] = [];
    for (let at = joint; at >= 0 && chain.length <= parents.length; at = parents[at]) chain.push(at);
    return chain;
  };
  const at = (name: string) => map[jointIndex(name)];
  const common = (a: number, b: number) => {
    const others = new Set(above(b));
    return above(a).find((joint) => others.has(joint)) ?? -1;
  };
  const pelvis = at('pelvis') >= 0 ? at('pelvis') : common(parents[at('left_hip')], parents[at('right_hip')]);
  if (pelvis < 0) throw new Error('The legs of this skeleton hang together nowhere: Posebeat cannot read it.');
  map[jointIndex('pelvis')] = pelvis;

  // The back is told by its place, not by its names, which differ most: what the arms hang on and the legs do not.
  const legs = new Set([...above(at('left_hip')), ...above(at('right_hip')), pelvis]);
  const chest = common(at('left_shoulder'), at('right_shoulder'));
  const back = above(chest)
    .filter((joint) => !legs.has(joint))
    .reverse();
  const spine = ['spine1', 'spine2', 'spine3'].map(jointIndex);
  if (back.length > 0) map[spine[0]] = back[0];
  if (back.length > 1) map[spine[2]] = back[back.length - 1];
  if (back.length > 2) map[spine[1]] = back[Math.floor(back.length / 2)];
  return map;
}
