import fc from 'fast-check';
import { validateBytes } from 'gltf-validator';
import { describe, expect, it } from 'vitest';
import { AVATAR_JOINTS, checkBones, type BoneMap } from '../../web/core/avatar/bones';
import { guessBones } from '../../web/core/avatar/guess';
import { AvatarRetargeter } from '../../web/core/avatar/retarget';
import { MAX_AVATAR_BYTES, readAvatarRig, type AvatarRig } from '../../web/core/avatar/rig';
import { frameView } from '../../web/core/motion';
import { jointIndex, JOINTS } from '../../web/core/skeleton';
import {
  anonymousGlb,
  avatarFile,
  bodyOf,
  BROAD,
  chairGlb,
  LONG_LEGS,
  mixamoGlb,
  mixamoName,
  quadrupedGlb,
  SMALL,
  vrm0File,
  vrm1File,
  type Build,
} from './support/avatar-rigs';
import { wildMotion } from './support/wild-motion';

const PARTS: Record<string, string> = {
  hip: 'Thigh',
  knee: 'Shin',
  ankle: 'Foot',
  foot: 'Toes',
  collar: 'Collar',
  shoulder: 'UpperArm',
  elbow: 'Forearm',
  wrist: 'Hand',
};

/** The right mapping of a body made by the tests; its first bone is node `first`. */
function truth(build: Build, first: number): BoneMap {
  const keys = bodyOf(build).map(({ key }) => key);
  const node = (key: string) => first + keys.indexOf(key);
  const back = [0, Math.floor(build.backBones / 2), build.backBones - 1].map((i) => node(`back${i}`));
  if (build.backBones === 2) back[1] = -1;
  const middle: Record<string, number> = {
    pelvis: node('hips'),
    spine1: back[0],
    spine2: back[1],
    spine3: back[2],
    neck: node('neck'),
    head: node('head'),
  };
  return JOINTS.map((joint) => {
    const [, side, part] = /^(?:(left|right)_)?(.*)$/.exec(joint)!;
    return side ? (PARTS[part] ? node(side + PARTS[part]) : -1) : middle[part];
  });
}
const called = (rig: AvatarRig, bones: BoneMap) =>
  AVATAR_JOINTS.map((joint) => `${JOINTS[joint]}: ${rig.names[bones[joint]] ?? '-'}`);

describe('the tests’ own avatars', () => {
  it.each([
    ['Mixamo', mixamoGlb()],
    ['VRM 0', vrm0File()],
    ['VRM 1', vrm1File()],
    ['no names', anonymousGlb()],
    ['an animal', quadrupedGlb()],
    ['a chair', chairGlb()],
  ])('are valid glTF: %s', async (_, bytes) => {
    const { issues } = await validateBytes(bytes, { maxIssues: 20 });
    expect(issues.messages.filter(({ severity }) => severity === 0)).toEqual([]);
  });
});

describe('bones of an avatar', () => {
  it.each<[string, Uint8Array, string, string, Build, number]>([
    ['Mixamo', mixamoGlb(), 'glTF', 'names', LONG_LEGS, 1],
    ['VRM 0', vrm0File(), 'VRM 0', 'file', SMALL, 0],
    ['VRM 1', vrm1File(), 'VRM 1', 'file', BROAD, 0],
    ['numbered bones, arms hanging', anonymousGlb(), 'glTF', 'shape', LONG_LEGS, 0],
    ['numbered bones, T-pose', anonymousGlb(BROAD), 'glTF', 'shape', BROAD, 0],
    ['numbered bones, looking back', anonymousGlb(SMALL, { facing: [0, 1, 0, 0] }), 'glTF', 'shape', SMALL, 0],
    [
      'numbered bones, lying',
      anonymousGlb(LONG_LEGS, { facing: [Math.SQRT1_2, 0, 0, Math.SQRT1_2] }),
      'glTF',
      'shape',
      LONG_LEGS,
      0,
    ],
  ])('are found: %s', (_, bytes, kind, by, build, first) => {
    const rig = readAvatarRig(bytes);
    const guess = guessBones(rig);
    expect(rig.kind).toBe(kind);
    expect(guess.by).toBe(by);
    expect(called(rig, guess.bones)).toEqual(called(rig, truth(build, first)));
    expect(checkBones(rig, guess.bones)).toEqual([]);
  });
});

describe('a mapping', () => {
  const rig = readAvatarRig(mixamoGlb());
  const { bones } = guessBones(rig);
  const changed = (edit: Record<string, number>) => {
    const other = [...bones];
    for (const [joint, node] of Object.entries(edit)) other[jointIndex(joint)] = node;
    return checkBones(rig, other);
  };
  const of = (joint: string) => bones[jointIndex(joint)];

  it('says what is missing', () => {
    expect(changed({ left_knee: -1 })).toEqual([
      { joint: jointIndex('left_knee'), message: 'Choose the bone for the left knee.', blocking: true },
    ]);
    expect(changed({ left_wrist: -1, neck: -1, spine2: -1, right_foot: -1, left_collar: -1 })).toEqual([]);
  });

  it('says which bone hangs wrong', () => {
    const [first] = changed({ left_knee: of('right_knee') });
    expect(first.message).toMatch(
      /Left knee must be below left hip: “mixamorig:RightLeg” does not hang on “mixamorig:LeftUpLeg”/,
    );
    expect(
      changed({ head: of('spine1') })
        .map(({ message }) => message)
        .join(),
    ).toMatch(/Head and spine 1 are the same bone/);
    expect(changed({ pelvis: of('spine1') })[0].message).toMatch(/same bone|must be below pelvis/);
  });

  it('warns of sides that are swapped', () => {
    const swap: Record<string, number> = {};
    for (const part of ['hip', 'knee', 'ankle', 'foot', 'collar', 'shoulder', 'elbow', 'wrist']) {
      swap[`left_${part}`] = of(`right_${part}`);
      swap[`right_${part}`] = of(`left_${part}`);
    }
    expect(changed(swap)).toMatchObject([{ blocking: false, message: expect.stringContaining('swapped') }]);
  });

  it('of another file is told', () => {
    expect(checkBones(rig, [1, 2])[0].message).toMatch(/another avatar/);
    expect(changed({ head: 9999 })[0].message).toMatch(/another avatar/);
  });
});

describe('names of other tools', () => {
  const unreal: Record<string, string> = {
    hips: 'pelvis', neck: 'neck_01', head: 'head', Collar: 'clavicle', UpperArm: 'upperarm', Forearm: 'lowerarm', Hand: 'hand', Thigh: 'thigh', Shin: 'calf', Foot: 'foot', Toes: 'ball',
  }; // prettier-ignore
  const creator: Record<string, string> = {
    hips: 'CC_Base_Hip', neck: 'CC_Base_NeckTwist01', head: 'CC_Base_Head', Collar: 'Clavicle', UpperArm: 'Upperarm', Forearm: 'Forearm', Hand: 'Hand', Thigh: 'Thigh', Shin: 'Calf', Foot: 'Foot', Toes: 'ToeBase',
  }; // prettier-ignore
  const rigify: Record<string, string> = {
    hips: 'DEF-spine', neck: 'DEF-neck', head: 'DEF-head', Collar: 'DEF-shoulder', UpperArm: 'DEF-upper_arm', Forearm: 'DEF-forearm', Hand: 'DEF-hand', Thigh: 'DEF-thigh', Shin: 'DEF-shin', Foot: 'DEF-foot', Toes: 'DEF-toe',
  }; // prettier-ignore
  const sided = (key: string, write: (side: string, part: string) => string) => {
    const [, side, part] = /^(left|right)?(.*)$/.exec(key)!;
    return write(side ?? '', part);
  };
  it.each<[string, (key: string) => string]>([
    ['Unreal', (key) => sided(key, (side, part) => (unreal[part] ?? part) + (side && `_${side[0]}`))],
    [
      'Character Creator',
      (key) =>
        sided(key, (side, part) =>
          side ? `CC_Base_${side[0].toUpperCase()}_${creator[part] ?? part}` : (creator[part] ?? `CC_Base_${part}`),
        ),
    ],
    [
      'Rigify',
      (key) => sided(key, (side, part) => (rigify[part] ?? `DEF-${part}`) + (side && `.${side[0].toUpperCase()}`)),
    ],
    ['Unity', (key) => key.replace(/^(left|right)/, (side) => `${side} `)],
  ])('are understood: %s', (_, name) => {
    const rig = readAvatarRig(avatarFile(bodyOf(LONG_LEGS), { name }));
    const guess = guessBones(rig);
    const right = truth(LONG_LEGS, 0);
    for (const joint of [0, 3, 9, ...[1, 4, 7, 10, 13, 16, 18, 20].flatMap((left) => [left, left + 1])]) {
      expect(`${JOINTS[joint]} ${rig.names[guess.bones[joint]]}`).toBe(`${JOINTS[joint]} ${rig.names[right[joint]]}`);
    }
    expect(checkBones(rig, guess.bones).filter(({ blocking }) => blocking)).toEqual([]);
  });

  it('that only some bones have are completed by where the bones are', () => {
    const rig = readAvatarRig(
      avatarFile(bodyOf(LONG_LEGS), { name: (key) => (/Shin|Forearm/.test(key) ? `x${key.length}` : mixamoName(key)) }),
    );
    const guess = guessBones(rig);
    expect(guess.by).toBe('shape');
    expect(called(rig, guess.bones)).toEqual(called(rig, truth(LONG_LEGS, 0)));
  });
});

describe('what is no avatar', () => {
  it('is refused with a sentence: a chair, an animal', () => {
    expect(() => guessBones(readAvatarRig(chairGlb()))).toThrow(/no body in this file/);
    expect(() => guessBones(readAvatarRig(quadrupedGlb()))).toThrow(/four legs/);
    const parts = ['upleg', 'leg', 'foot', 'toebase'];
    const arms = ['arm', 'forearm', 'hand', 'finger'];
    const named = quadrupedGlb((key) =>
      key.replace(/_hind_(\d)/, (_, i) => parts[i]).replace(/_fore_(\d)/, (_, i) => arms[i]),
    );
    expect(() => guessBones(readAvatarRig(named))).toThrow(/four legs/);
  });

  it('is refused with a sentence: bones that are no body', () => {
    const bones = Array.from({ length: 30 }, (_, i) => ({
      key: `k${i}`,
      parent: i ? `k${i - 1}` : null,
      at: [0, i / 10, 0] as [number, number, number],
      boxes: [],
    }));
    expect(() => guessBones(readAvatarRig(avatarFile(bones, { name: (key) => key, bare: true })))).toThrow(
      /arms and legs/,
    );
  });

  it('is refused with a sentence: broken and oversized files, in no time', () => {
    const refused = (bytes: Uint8Array) => () => guessBones(readAvatarRig(bytes));
    expect(refused(new Uint8Array(0))).toThrow(/damaged/);
    expect(refused(new TextEncoder().encode('a song'))).toThrow(/damaged/);
    expect(refused(mixamoGlb().slice(0, 900))).toThrow(/damaged/);
    expect(refused(new Uint8Array(MAX_AVATAR_BYTES + 1))).toThrow(/up to 200 MB/);
    const looped = mixamoGlb({
      edit: (json) => ((json as unknown as { nodes: object[] }).nodes[5] = { children: [5] }),
    });
    expect(refused(looped)).toThrow(/no tree/);
    const many = Array.from({ length: 19_000 }, (_, i) => ({
      key: `k${i}`,
      parent: i > 0 ? `k${i < 12_000 ? i - 1 : i % 50}` : null,
      at: [Math.sin(i), Math.cos(i * 3), i / 19_000] as [number, number, number],
      boxes: [],
    }));
    const start = performance.now();
    const big = refused(wideFile(many));
    try {
      big();
    } catch (error) {
      expect((error as Error).message).toMatch(/\.$/);
    }
    expect(performance.now() - start).toBeLessThan(5000);
  });

  it('never gives anything but a sentence or a dance, whichever byte is wrong', () => {
    const good = vrm0File();
    fc.assert(
      fc.property(fc.nat(good.length - 1), fc.nat(255), (at, value) => {
        const bytes = good.slice();
        bytes[at] = value;
        try {
          const rig = readAvatarRig(bytes);
          const retargeter = new AvatarRetargeter(rig, guessBones(rig).bones);
          const frame = retargeter.frame(pose, retargeter.createFrame());
          return [...frame.rotations, ...frame.hips].every(Number.isFinite);
        } catch (error) {
          return /\.$/.test((error as Error).message);
        }
      }),
      { numRuns: 150, seed: 7 },
    );
  });
});

const pose = frameView(wildMotion(1, 8), 0);

/** A file of many nodes, without the care that a real one takes. */
function wideFile(bones: readonly { key: string; parent: string | null; at: [number, number, number] }[]): Uint8Array {
  const index = new Map(bones.map(({ key }, i) => [key, i]));
  const children = bones.map(() => [] as number[]);
  bones.forEach(({ parent }, i) => parent !== null && children[index.get(parent)!].push(i));
  const nodes = bones.map(({ key, at }, i) => ({
    name: key,
    translation: at,
    ...(children[i].length ? { children: children[i] } : {}),
  }));
  return new TextEncoder().encode(JSON.stringify({ asset: { version: '2.0' }, nodes }));
}
