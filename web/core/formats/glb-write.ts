/**
 * GLB files (glTF 2.0, Khronos specification 2.0.1): our 24 joints as nodes in a true T-pose, an animation of them, and, where it is
 * wanted, a skinned figure. Metres, Y up, facing +Z, as glTF has it, so nothing is turned or scaled.
 */
import { REST, REST_HEIGHT } from '../rest';
import { JOINT_COUNT, JOINTS, OFFSETS, PARENTS } from '../skeleton';
import { ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, GlbPack } from './glb-pack';

/** How one joint turns or moves through time: glTF's animation sampler (specification, section 3.11) and its target in one. */
export interface GlbSampler {
  /** Which joint, 0..23 in the skeleton's order; 24 + i is the figure's helper bone i. */
  joint: number;
  /** `rotation`: x y z w against the parent. `translation`: metres against the parent; of the pelvis, its place in the world. */
  path: 'rotation' | 'translation';
  /** Seconds, ascending, from 0 or later. Samplers that share the very same array share it in the file too. */
  times: Float32Array;
  /**
   * LINEAR: one value (4 or 3 numbers) per time. CUBICSPLINE: three per time: in-tangent, value, out-tangent; tangents are per second
   * (appendix C). A normalised Int16Array (32767 = 1) is for rotations whose last digits do not matter.
   */
  values: Float32Array | Int16Array;
  interpolation: 'LINEAR' | 'CUBICSPLINE';
}

/** A bone that the skin needs beside the joints: a child of a joint, at the same place. */
export interface GlbHelper {
  name: string;
  joint: number;
}

/** Triangles of one material. */
export interface GlbPart {
  name: string;
  /** Corners' vertex numbers, m x 3. */
  triangles: Uint16Array | Uint32Array;
  /** 0..1 */
  roughness: number;
}

/** A figure in the rest pose that stands on the floor at the origin (see {@link REST}); n vertices. */
export interface GlbFigure {
  /** n x 3, metres. */
  positions: Float32Array;
  /** n x 3, unit. */
  normals: Float32Array;
  /** n x 4, linear RGBA, 255 = 1. */
  colours: Uint8Array;
  /** n x 4: joints, or 24 + helper. A bone of weight 0 is 0. */
  bones: Uint8Array;
  /** n x 4, each row adds up to 1. */
  weights: Float32Array;
  helpers: readonly GlbHelper[];
  parts: readonly GlbPart[];
}

/** What goes into a file. */
export interface GlbContents {
  /** Name of the animation and of the scene. */
  name: string;
  samplers: readonly GlbSampler[];
  /** Missing: the skeleton alone. */
  figure?: GlbFigure;
  /** Anything to be kept with the file, under `asset.extras`. */
  extras?: Readonly<Record<string, unknown>>;
}

/**
 * Writes a GLB file. Nodes bear the joints' names in their order (node i is joint i), at the rest offsets; the pelvis stands at its
 * height. The skeleton alone has a skin too, because some readers know bones only by it.
 * @throws Error when a sampler does not fit the skeleton or itself, or the figure's arrays do not fit each other
 */
export function writeGlb({ name, samplers, figure, extras }: GlbContents): Uint8Array<ArrayBuffer> {
  const helpers = figure?.helpers ?? [];
  const bones = JOINT_COUNT + helpers.length;
  checkSamplers(samplers, bones);
  const pack = new GlbPack();
  const nodes: Record<string, unknown>[] = JOINTS.map((joint, i) => ({
    name: joint,
    translation: i === 0 ? [0, REST_HEIGHT, 0] : [...OFFSETS[i]],
  }));
  for (const helper of helpers) nodes.push({ name: helper.name });
  const parentOf = (node: number) => (node < JOINT_COUNT ? PARENTS[node] : helpers[node - JOINT_COUNT].joint);
  for (let node = 1; node < bones; node++) {
    const parent = nodes[parentOf(node)];
    parent.children = [...((parent.children as number[] | undefined) ?? []), node];
  }
  const joints = Array.from({ length: bones }, (_, node) => node);
  const inverse = new Float32Array(bones * 16);
  for (const bone of joints) {
    const joint = bone < JOINT_COUNT ? bone : helpers[bone - JOINT_COUNT].joint;
    for (let k = 0; k < 4; k++) inverse[bone * 16 + k * 5] = 1;
    for (let k = 0; k < 3; k++) inverse[bone * 16 + 12 + k] = -REST[joint * 3 + k];
  }
  const skin = { name: 'skeleton', joints, skeleton: 0, inverseBindMatrices: pack.add(inverse, 'MAT4') };
  const roots = [0];
  if (figure) roots.push(nodes.push({ name: 'figure', mesh: 0, skin: 0 }) - 1);
  return pack.toGlb({
    asset: { version: '2.0', generator: 'Posebeat', ...(extras ? { extras } : {}) },
    scene: 0,
    scenes: [{ name, nodes: roots }],
    nodes,
    skins: [skin],
    ...(figure ? meshOf(figure, bones, pack) : {}),
    ...(samplers.length > 0 ? { animations: [animationOf(name, samplers, pack)] } : {}),
  });
}

function animationOf(name: string, samplers: readonly GlbSampler[], pack: GlbPack) {
  const inputs = new Map<Float32Array, number>();
  const inputOf = (times: Float32Array) => {
    const input = inputs.get(times) ?? pack.add(times, 'SCALAR', { bounds: true });
    inputs.set(times, input);
    return input;
  };
  return {
    name,
    channels: samplers.map(({ joint, path }, sampler) => ({ sampler, target: { node: joint, path } })),
    samplers: samplers.map(({ path, times, values, interpolation }) => ({
      input: inputOf(times),
      output: pack.add(values, path === 'rotation' ? 'VEC4' : 'VEC3', { normalized: values instanceof Int16Array }),
      interpolation,
    })),
  };
}

function meshOf({ positions, normals, colours, bones, weights, parts }: GlbFigure, count: number, pack: GlbPack) {
  const n = positions.length / 3;
  const fits =
    normals.length === n * 3 && colours.length === n * 4 && bones.length === n * 4 && weights.length === n * 4;
  if (!fits || bones.some((bone) => bone >= count)) throw new Error('The arrays of the figure do not fit each other.');
  const target = ARRAY_BUFFER;
  const attributes = {
    POSITION: pack.add(positions, 'VEC3', { target, bounds: true }),
    NORMAL: pack.add(normals, 'VEC3', { target }),
    COLOR_0: pack.add(colours, 'VEC4', { target, normalized: true }),
    JOINTS_0: pack.add(bones, 'VEC4', { target }),
    WEIGHTS_0: pack.add(weights, 'VEC4', { target }),
  };
  return {
    meshes: [
      {
        name: 'figure',
        primitives: parts.map(({ triangles }, material) => ({
          attributes,
          indices: pack.add(triangles, 'SCALAR', { target: ELEMENT_ARRAY_BUFFER }),
          material,
        })),
      },
    ],
    materials: parts.map(({ name, roughness }) => ({
      name,
      pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: roughness },
    })),
  };
}

function checkSamplers(samplers: readonly GlbSampler[], bones: number): void {
  const targets = new Set<string>();
  for (const { joint, path, times, values, interpolation } of samplers) {
    const what = `The ${path} of joint ${joint}`;
    if (!(Number.isInteger(joint) && joint >= 0 && joint < bones)) throw new Error(`${what}: there is no such joint.`);
    if (targets.has(`${joint} ${path}`)) throw new Error(`${what} is given twice.`);
    targets.add(`${joint} ${path}`);
    const width = (path === 'rotation' ? 4 : 3) * (interpolation === 'CUBICSPLINE' ? 3 : 1);
    // A cubic spline needs two keys (specification, section 3.11).
    const least = interpolation === 'CUBICSPLINE' ? 2 : 1;
    if (times.length < least || values.length !== times.length * width) {
      throw new Error(`${what} has ${times.length} times and ${values.length} numbers: ${width} a time are needed.`);
    }
    if (values instanceof Int16Array && path !== 'rotation') throw new Error(`${what} cannot be whole numbers.`);
    if (!values.every(Number.isFinite)) throw new Error(`${what} holds numbers that are not finite.`);
    for (let i = 0; i < times.length; i++) {
      if (!(times[i] >= 0 && times[i] < Infinity && (i === 0 || times[i] > times[i - 1]))) {
        throw new Error(`${what}: its times must ascend from 0 or later.`);
      }
    }
  }
}
