/** Avatars for the tests, made of boxes: files as Mixamo, VRM and others write them, with bodies unlike ours. No test library is used. */
import { GlbPack } from '../../../web/core/formats/glb-pack';
import { axisAngleToQuaternion, conjugate, multiply, rotateVector } from '../../../web/core/rotation';

type Vector = [number, number, number];

/** A body; metres, standing on the floor, facing +Z. */
export interface Build {
  thigh: number;
  shin: number;
  ankleHeight: number;
  /** From the ankle to the ball, and from there to the tip. */
  foot: number;
  toes: number;
  /** Half the distance between the hip joints. */
  hips: number;
  /** From the hip joints to the shoulders, and the number of bones between pelvis and chest, the chest counted. */
  back: number;
  backBones: number;
  upperArm: number;
  forearm: number;
  /** Half the distance between the shoulders. */
  shoulders: number;
  /** How far the arms hang down from the T-pose, radians. */
  armDrop: number;
  neck: number;
  head: number;
}

export const LONG_LEGS: Build = {
  thigh: 0.5, shin: 0.47, ankleHeight: 0.09, foot: 0.13, toes: 0.07, hips: 0.09, back: 0.48, backBones: 3,
  upperArm: 0.27, forearm: 0.26, shoulders: 0.18, armDrop: 0, neck: 0.09, head: 0.2,
}; // prettier-ignore
export const SMALL: Build = {
  thigh: 0.27, shin: 0.3, ankleHeight: 0.06, foot: 0.09, toes: 0.05, hips: 0.07, back: 0.34, backBones: 2,
  upperArm: 0.2, forearm: 0.17, shoulders: 0.11, armDrop: 0, neck: 0.06, head: 0.24,
}; // prettier-ignore
export const BROAD: Build = {
  thigh: 0.4, shin: 0.45, ankleHeight: 0.11, foot: 0.15, toes: 0.08, hips: 0.11, back: 0.52, backBones: 5,
  upperArm: 0.3, forearm: 0.24, shoulders: 0.22, armDrop: 0.75, neck: 0.1, head: 0.22,
}; // prettier-ignore

/** A bone: where it begins, what it hangs on, and the boxes that it carries, each from one point to another. */
export interface Bone {
  key: string;
  parent: string | null;
  at: Vector;
  boxes: { from: Vector; to: Vector; thick: number }[];
}

const plus = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const half = (a: Vector, b: Vector): Vector => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2];

/** The bones of a body: hips, back0.., neck, head, and for each side collar, upperArm, forearm, hand, three fingers, thigh, shin, foot, toes. */
export function bodyOf(b: Build): Bone[] {
  const hipY = b.ankleHeight + b.shin + b.thigh;
  const bones: Bone[] = [];
  const add = (key: string, parent: string | null, at: Vector) => bones.push({ key, parent, at, boxes: [] });
  const hips: Vector = [0, hipY + 0.06, -0.01];
  add('hips', null, hips);
  const chestAt: Vector = [0, hipY + 0.72 * b.back, -0.01];
  for (let i = 0; i < b.backBones; i++) {
    const t = (i + 1) / b.backBones;
    add(`back${i}`, i === 0 ? 'hips' : `back${i - 1}`, [
      0,
      hips[1] + t * (chestAt[1] - hips[1]),
      -0.01 - 0.01 * Math.sin(3 * t),
    ]);
  }
  const chest = `back${b.backBones - 1}`;
  const neck: Vector = [0, hipY + b.back + 0.04, -0.01];
  add('neck', chest, neck);
  add('head', 'neck', plus(neck, [0, b.neck, 0.02]));
  for (const side of ['left', 'right'] as const) {
    const x = side === 'left' ? 1 : -1;
    const arm = (length: number): Vector => [x * length * Math.cos(b.armDrop), -length * Math.sin(b.armDrop), 0];
    const shoulder: Vector = [x * b.shoulders, hipY + b.back, -0.02];
    const elbow = plus(shoulder, arm(b.upperArm));
    const wrist = plus(elbow, arm(b.forearm));
    add(`${side}Collar`, chest, [x * 0.03, hipY + b.back - 0.02, 0]);
    add(`${side}UpperArm`, `${side}Collar`, shoulder);
    add(`${side}Forearm`, `${side}UpperArm`, elbow);
    add(`${side}Hand`, `${side}Forearm`, wrist);
    ['Index', 'Middle', 'Ring'].forEach((finger, i) => {
      const root = plus(plus(wrist, arm(0.09)), [0, 0, 0.025 - 0.025 * i]);
      add(`${side}${finger}`, `${side}Hand`, root);
      add(`${side}${finger}2`, `${side}${finger}`, plus(root, arm(0.035)));
    });
    add(`${side}Thigh`, 'hips', [x * b.hips, hipY, 0]);
    add(`${side}Shin`, `${side}Thigh`, [x * b.hips, b.ankleHeight + b.shin, 0.01]);
    add(`${side}Foot`, `${side}Shin`, [x * b.hips, b.ankleHeight, -0.015]);
    add(`${side}Toes`, `${side}Foot`, [x * b.hips, 0.022, b.foot - 0.015]);
    const at = (key: string) => bones.find((bone) => bone.key === `${side}${key}`)!;
    // Boxes of the feet stand on the floor; half as thick as they are long they would not.
    at('Foot').boxes.push({ from: [x * b.hips, 0.03, -0.05], to: [x * b.hips, 0.03, b.foot - 0.015], thick: 0.06 });
    at('Toes').boxes.push({
      from: [x * b.hips, 0.02, b.foot - 0.015],
      to: [x * b.hips, 0.02, b.foot + b.toes],
      thick: 0.04,
    });
  }
  for (const bone of bones) {
    if (bone.boxes.length > 0) continue;
    const child = bones.find(({ parent }) => parent === bone.key);
    const to = child ? child.at : plus(bone.at, bone.key === 'head' ? [0, b.head, 0] : [0, -0.03, 0]);
    const thick = /Thigh|back|hips|head/.test(bone.key)
      ? 0.13
      : /[a-z](Index|Middle|Ring)/.test(bone.key)
        ? 0.015
        : 0.07;
    bone.boxes.push({ from: bone.at, to, thick });
  }
  return bones;
}

export interface FileOptions {
  /** The node's name for a bone. */
  name: (key: string) => string;
  /** Turns the whole body in the file: VRM 0 looks to -Z. */
  facing?: readonly number[];
  /** A node above the bones, as exporters have it. */
  armature?: { rotation: readonly number[]; scale: number };
  /** Bones' own axes: all as the world's, Y along the bone as Mixamo and Blender have it, or any. */
  axes?: 'world' | 'along' | 'wild';
  /** Rotations added to bones after they were bound: the file stands in a pose of its own. */
  posed?: Readonly<Record<string, readonly number[]>>;
  extensions?: (node: (key: string) => number) => Record<string, unknown>;
  /** Without vertices. */
  bare?: boolean;
  /** Writes matrices in place of rotations and translations. */
  matrices?: boolean;
  edit?: (json: Record<string, never>) => void;
}

/** A .glb (or .vrm) file of a body. Node 0 is the armature where there is one; the mesh is the last node. */
export function avatarFile(bones: readonly Bone[], options: FileOptions): Uint8Array<ArrayBuffer> {
  const { armature, facing = [0, 0, 0, 1] } = options;
  const first = armature ? 1 : 0;
  const index = new Map(bones.map(({ key }, i) => [key, i]));
  const places = bones.map(({ at }) => rotateVector<number[]>(facing, at));
  const turns = bones.map(({ key }, i) => worldAxes(bones, places, key, i, options.axes ?? 'world'));
  const base = { turn: armature?.rotation ?? [0, 0, 0, 1], size: armature?.scale ?? 1 };
  const nodes: Record<string, unknown>[] = bones.map(({ key, parent }, i) => {
    const above = parent === null ? -1 : index.get(parent)!;
    const [turn, from] = above < 0 ? [base.turn, [0, 0, 0]] : [turns[above], places[above]];
    const back = conjugate(turn);
    const translation = rotateVector<number[]>(
      back,
      places[i].map((value, k) => (value - from[k]) / base.size),
    );
    // Rounded as a file would, so that no number is beyond 1.
    const rotation = multiply(multiply(back, turns[i]), options.posed?.[key] ?? [0, 0, 0, 1]).map(Math.fround);
    const children = bones.flatMap((each, k) => (each.parent === key ? [k + first] : []));
    const transform = options.matrices ? { matrix: matrixOf(rotation, translation, 1) } : { rotation, translation };
    return { name: options.name(key), ...transform, ...(children.length ? { children } : {}) };
  });
  const roots = bones.flatMap(({ parent }, i) => (parent === null ? [i + first] : []));
  if (armature)
    nodes.unshift({
      name: 'Armature',
      rotation: [...armature.rotation],
      scale: [1, 1, 1].map(() => armature.scale),
      children: roots,
    });
  const pack = new GlbPack();
  const joints = bones.map((_, i) => i + first);
  const inverse = Float32Array.from(
    bones.flatMap((_, i) => {
      // The inverse of p -> place + turn (size p).
      const back = conjugate(turns[i]);
      const moved = rotateVector<number[]>(back, places[i]).map((value) => -value / base.size);
      return matrixOf(back, moved, 1 / base.size);
    }),
  );
  const skins = [{ joints, inverseBindMatrices: pack.add(inverse, 'MAT4') }];
  const scene = armature ? [0] : roots;
  const meshes = options.bare ? [] : [{ primitives: [boxes(bones, facing, pack)] }];
  if (!options.bare) scene.push(nodes.push({ name: 'Body', mesh: 0, skin: 0 }) - 1);
  const extensions = options.extensions?.((key) => index.get(key)! + first);
  const json = {
    asset: { version: '2.0', generator: 'Posebeat tests' },
    scene: 0,
    scenes: [{ nodes: scene }],
    nodes,
    skins,
    ...(options.bare
      ? {}
      : {
          meshes,
          materials: [{ pbrMetallicRoughness: { baseColorFactor: [0.55, 0.75, 0.95, 1], metallicFactor: 0 } }],
        }),
    ...(extensions ? { extensions, extensionsUsed: Object.keys(extensions) } : {}),
  };
  options.edit?.(json as never);
  return pack.toGlb(json);
}

/** A column-major matrix. */
function matrixOf(q: readonly number[], t: readonly number[], size: number): number[] {
  const columns = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ].map((axis) => rotateVector<number[]>(q, axis).map((value) => value * size));
  return [...columns[0], 0, ...columns[1], 0, ...columns[2], 0, ...t, 1];
}

function worldAxes(
  bones: readonly Bone[],
  places: readonly number[][],
  key: string,
  i: number,
  axes: 'world' | 'along' | 'wild',
): number[] {
  if (axes === 'world') return [0, 0, 0, 1];
  if (axes === 'wild') return axisAngleToQuaternion([Math.sin(i * 7) * 2, Math.cos(i * 5) * 2, Math.sin(i * 3)]);
  const child = bones.findIndex(({ parent }) => parent === key);
  const above = bones.findIndex((bone) => bone.key === bones[i].parent);
  const [a, b] =
    child >= 0
      ? [places[i], places[child]]
      : above >= 0
        ? [places[above], places[i]]
        : [
            [0, 0, 0],
            [0, 1, 0],
          ];
  const way = b.map((value, k) => value - a[k]);
  const size = Math.hypot(...way);
  const [x, y, z] = way.map((value) => value / size);
  return y < -0.9999 ? [1, 0, 0, 0] : [z, 0, -x, 1 + y].map((value) => value / Math.hypot(z, x, 1 + y));
}

function boxes(bones: readonly Bone[], facing: readonly number[], pack: GlbPack) {
  const positions: number[] = [];
  const carriers: number[] = [];
  const triangles: number[] = [];
  bones.forEach((bone, b) => {
    for (const { from, to, thick } of bone.boxes) {
      const start = positions.length / 3;
      const way = [0, 1, 2].map((k) => to[k] - from[k]);
      const size = Math.hypot(...way) || 1;
      const along = way.map((value) => value / size);
      // Level sides where the box lies, so that soles are flat.
      const level = Math.abs(along[1]) > 0.9 ? [1, 0, 0] : [0, 1, 0];
      const part = level[0] * along[0] + level[1] * along[1];
      const u = level.map((value, k) => value - part * along[k]);
      const long = Math.hypot(...u);
      const side = u.map((value) => ((value / long) * thick) / 2);
      const other = [
        along[1] * side[2] - along[2] * side[1],
        along[2] * side[0] - along[0] * side[2],
        along[0] * side[1] - along[1] * side[0],
      ];
      for (const end of [from, to])
        for (const [s, t] of [
          [-1, -1],
          [1, -1],
          [1, 1],
          [-1, 1],
        ]) {
          positions.push(
            ...rotateVector<number[]>(
              facing,
              [0, 1, 2].map((k) => end[k] + s * side[k] + t * other[k]),
            ),
          );
          carriers.push(b, 0, 0, 0);
        }
      const quads = [
        [0, 1, 2, 3],
        [7, 6, 5, 4],
        [0, 4, 5, 1],
        [1, 5, 6, 2],
        [2, 6, 7, 3],
        [3, 7, 4, 0],
      ];
      for (const [p, q, r, s] of quads) triangles.push(...[p, r, q, p, s, r].map((corner) => start + corner));
    }
  });
  const weights = Float32Array.from(carriers, (_, i) => (i % 4 === 0 ? 1 : 0));
  const attributes = {
    POSITION: pack.add(Float32Array.from(positions), 'VEC3', { target: 34962, bounds: true }),
    JOINTS_0: pack.add(Uint8Array.from(carriers), 'VEC4', { target: 34962 }),
    WEIGHTS_0: pack.add(weights, 'VEC4', { target: 34962 }),
  };
  return { attributes, indices: pack.add(Uint16Array.from(triangles), 'SCALAR', { target: 34963 }), material: 0 };
}

const sideOf = (key: string) => (/^(left|right)/.exec(key)?.[0] ?? '') as '' | 'left' | 'right';
const partOf = (key: string) => key.replace(/^(left|right)/, '');

/** Mixamo's name for a bone. */
export function mixamoName(key: string): string {
  const parts: Record<string, string> = {
    hips: 'Hips', back0: 'Spine', back1: 'Spine1', back2: 'Spine2', back3: 'Spine3', back4: 'Spine4', neck: 'Neck', head: 'Head', Collar: 'Shoulder',
    UpperArm: 'Arm', Forearm: 'ForeArm', Hand: 'Hand', Thigh: 'UpLeg', Shin: 'Leg', Foot: 'Foot', Toes: 'ToeBase',
    Index: 'HandIndex1', Index2: 'HandIndex2', Middle: 'HandMiddle1', Middle2: 'HandMiddle2', Ring: 'HandRing1', Ring2: 'HandRing2',
  }; // prettier-ignore
  const side = sideOf(key);
  return `mixamorig:${side ? side[0].toUpperCase() + side.slice(1) : ''}${parts[partOf(key)]}`;
}

/** VRM's name for a bone; undefined where VRM has none. */
export function vrmName(key: string, backBones: number): string | undefined {
  const back: Record<number, string[]> = {
    2: ['spine', 'chest'],
    3: ['spine', 'chest', 'upperChest'],
    5: ['spine', '', 'chest', '', 'upperChest'],
  };
  const parts: Record<string, string> = {
    hips: 'hips', neck: 'neck', head: 'head', Collar: 'Shoulder', UpperArm: 'UpperArm', Forearm: 'LowerArm', Hand: 'Hand', Thigh: 'UpperLeg',
    Shin: 'LowerLeg', Foot: 'Foot', Toes: 'Toes',
  }; // prettier-ignore
  if (key.startsWith('back')) return back[backBones]?.[Number(key.slice(4))] || undefined;
  const part = parts[partOf(key)];
  return part && sideOf(key) + part;
}

/** A file as Mixamo's tools make it: long legs, centimetres under an armature of 0.01 that stands the Z-up bones upright. */
export function mixamoGlb(options: Partial<FileOptions> = {}, build: Build = LONG_LEGS): Uint8Array<ArrayBuffer> {
  const armature = { rotation: axisAngleToQuaternion([-Math.PI / 2, 0, 0]), scale: 0.01 };
  return avatarFile(bodyOf(build), { name: mixamoName, armature, axes: 'along', ...options });
}

/** A VRM 0 avatar: small, big head, looks to -Z, axes as the world's, node names that say nothing. */
export function vrm0File(options: Partial<FileOptions> = {}, build: Build = SMALL): Uint8Array<ArrayBuffer> {
  const bones = bodyOf(build);
  const facing = [0, 1, 0, 0];
  const extensions = (node: (key: string) => number) => ({
    VRM: {
      specVersion: '0.0',
      meta: { title: 'Box' },
      humanoid: {
        humanBones: bones.flatMap(({ key }) => {
          const bone = vrmName(key, build.backBones);
          return bone ? [{ bone, node: node(key), useDefaultValues: true }] : [];
        }),
      },
    },
  });
  return avatarFile(bones, {
    name: (key) => `J_${bones.findIndex((bone) => bone.key === key)}`,
    facing,
    extensions,
    ...options,
  });
}

/** A VRM 1 avatar: broad, arms hanging 43 degrees, five bones in its back, any axes, node names that say nothing. */
export function vrm1File(options: Partial<FileOptions> = {}, build: Build = BROAD): Uint8Array<ArrayBuffer> {
  const bones = bodyOf(build);
  const extensions = (node: (key: string) => number) => ({
    VRMC_vrm: {
      specVersion: '1.0',
      meta: { name: 'Box', authors: ['Posebeat'], licenseUrl: 'https://vrm.dev/licenses/1.0/' },
      humanoid: {
        humanBones: Object.fromEntries(
          bones.flatMap(({ key }) => {
            const bone = vrmName(key, build.backBones);
            return bone ? [[bone, { node: node(key) }]] : [];
          }),
        ),
      },
    },
  });
  return avatarFile(bones, {
    name: (key) => `J_${bones.findIndex((bone) => bone.key === key)}`,
    axes: 'wild',
    extensions,
    ...options,
  });
}

/** A body whose bones are called bone_01, bone_02, ... */
export function anonymousGlb(
  build: Build = { ...LONG_LEGS, armDrop: 0.6 },
  options: Partial<FileOptions> = {},
): Uint8Array<ArrayBuffer> {
  const bones = bodyOf(build);
  const name = (key: string) => `bone_${String(bones.findIndex((bone) => bone.key === key) + 1).padStart(2, '0')}`;
  return avatarFile(bones, { name, axes: 'along', ...options });
}

/** An animal on four legs. */
export function quadrupedGlb(name: (key: string) => string = (key) => key): Uint8Array<ArrayBuffer> {
  const bones: Bone[] = [];
  const add = (key: string, parent: string | null, at: Vector) => bones.push({ key, parent, at, boxes: [] });
  add('root', null, [0, 0.6, -0.4]);
  ['a', 'b', 'c'].forEach((part, i) =>
    add(`back_${part}`, i === 0 ? 'root' : `back_${'abc'[i - 1]}`, [0, 0.62, -0.15 + 0.25 * i]),
  );
  add('throat', 'back_c', [0, 0.75, 0.5]);
  add('skull', 'throat', [0, 0.85, 0.6]);
  for (const side of ['left', 'right'] as const) {
    const x = side === 'left' ? 0.12 : -0.12;
    for (const [end, above, z] of [
      ['hind', 'root', -0.4],
      ['fore', 'back_c', 0.35],
    ] as const) {
      [0.55, 0.32, 0.1, 0.02].forEach((y, i) =>
        add(`${side}_${end}_${i}`, i === 0 ? above : `${side}_${end}_${i - 1}`, [
          x,
          y,
          z + (i === 3 ? 0.07 : 0.02 * (i % 2)),
        ]),
      );
    }
  }
  for (const bone of bones) {
    const child = bones.find(({ parent }) => parent === bone.key);
    bone.boxes.push({
      from: bone.at,
      to: child ? half(child.at, child.at) : plus(bone.at, [0, 0.02, 0.05]),
      thick: 0.06,
    });
  }
  return avatarFile(bones, { name });
}

/** A chair: four legs, a seat, a back; no bones. */
export function chairGlb(): Uint8Array<ArrayBuffer> {
  const leg = (i: number): Vector => [i % 2 ? 0.2 : -0.2, 0.45, i < 2 ? 0.2 : -0.2];
  const bones: Bone[] = [
    { key: 'seat', parent: null, at: [0, 0.45, 0], boxes: [{ from: [0, 0.45, -0.2], to: [0, 0.45, 0.2], thick: 0.1 }] },
    {
      key: 'rest',
      parent: 'seat',
      at: [0, 0.5, -0.2],
      boxes: [{ from: [0, 0.5, -0.2], to: [0, 0.95, -0.2], thick: 0.05 }],
    },
    ...[0, 1, 2, 3].map((i) => ({
      key: `leg${i}`,
      parent: 'seat',
      at: leg(i),
      boxes: [{ from: leg(i), to: [leg(i)[0], 0, leg(i)[2]] as Vector, thick: 0.05 }],
    })),
  ];
  return avatarFile(bones, { name: (key) => key });
}
