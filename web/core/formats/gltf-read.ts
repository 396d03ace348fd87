/** Poses from glTF 2.0 (.glb, .gltf) and VRM 0.x and 1.0 avatars and animations (.vrm, .vrma): nodes turned by animations, on our skeleton. */
import { canonicalQuaternion, conjugate, matrixToQuaternion, multiply, rotateVector, slerp } from '../rotation';
import { JOINT_COUNT } from '../skeleton';
import { spec } from '../spec';
import { openGltf, type GltfAnimation, type GltfFile, type GltfNode } from './gltf-file';
import { mapHumanoid } from './humanoid';
import { axisOf, MAX_FRAMES, meanUp, turnUpright, type PoseClips, type PoseSequence } from './pose-sequence';
import { Retargeter } from './retarget';

const UPRIGHT = 0.85;
/** Half a turn about Y. */
const ABOUT = [0, 1, 0, 0];

/** Where the nodes are and what hangs on what. */
interface Tree {
  names: string[];
  parents: number[];
  /** Every node after its parent. */
  order: number[];
  /** Local rotations and places, as the file holds them. */
  rotations: number[][];
  translations: number[][];
  scales: number[][];
}

/**
 * Reads a glTF or VRM file.
 * @param bytes - The whole file.
 * @throws Error with a sentence for the visitor when it is none, damaged, or holds no human body
 */
export function readGltf(bytes: Uint8Array): PoseClips {
  const file = openGltf(bytes);
  const bones = vrmBones(file);
  const tree = plantTree(file.json.nodes, bones?.nodes ?? null);
  const still = worldOf(tree, tree.rotations);
  const rest = (bones ? null : boundRest(file, tree)) ?? still;
  const retargeter = new Retargeter({ names: tree.names, parents: tree.parents, ...rest });
  const toPose = (world: Float64Array, out: Float32Array, offset: number) => {
    retargeter.pose(world, out, offset);
    // Avatars of VRM 0.x look to -Z in their own space; everybody turns them round.
    if (bones?.backwards) out.set(multiply(ABOUT, out.subarray(offset, offset + 4)), offset);
  };
  const posed: PoseSequence = { name: '', fps: 0, frames: 1, quaternions: new Float32Array(JOINT_COUNT * 4) };
  toPose(still.rotations, posed.quaternions, 0);

  const needed = new Set<number>();
  for (const joint of retargeter.source) for (let at = joint; at >= 0; at = tree.parents[at]) needed.add(at);
  const clips = file.json.animations.flatMap((animation) => sample(file, tree, animation, needed, toPose) ?? []);
  // glTF is Y up; only a file whose rest and motion both stand on another axis is taken for a wrong export.
  const lying = clips.length > 0 ? axisOf(meanUp(posed), UPRIGHT) : null;
  for (const clip of clips) {
    const up = axisOf(meanUp(clip), UPRIGHT);
    if (up && lying && up[1] === 0 && up.every((value, k) => value === lying[k])) turnUpright(clip, up);
  }
  return { kind: bones ? 'VRM' : 'glTF', clips: clips.length > 0 ? clips : [posed] };
}

/** The humanoid of a VRM avatar or animation: for each node the name of its bone. */
function vrmBones({ json }: GltfFile): { nodes: Map<number, string>; backwards: boolean } | null {
  const record = (value: unknown) =>
    typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {};
  const nodes = new Map<number, string>();
  const put = (bone: unknown, node: unknown) => {
    if (typeof bone === 'string' && typeof node === 'number' && json.nodes[node]) nodes.set(node, bone);
  };
  for (const name of ['VRMC_vrm', 'VRMC_vrm_animation']) {
    const bones = record(record(record(json.extensions[name]).humanoid).humanBones);
    for (const [bone, entry] of Object.entries(bones)) put(bone, record(entry).node);
    if (nodes.size > 0) return { nodes, backwards: false };
  }
  const old = record(record(json.extensions.VRM).humanoid).humanBones;
  if (Array.isArray(old)) for (const entry of old) put(record(entry).bone, record(entry).node);
  return nodes.size > 0 ? { nodes, backwards: true } : null;
}

function plantTree(nodes: readonly GltfNode[], bones: ReadonlyMap<number, string> | null): Tree {
  const parents = nodes.map(() => -1);
  nodes.forEach(({ children = [] }, parent) => {
    for (const child of children) {
      if (!nodes[child] || parents[child] >= 0)
        throw new Error('The nodes of this glTF file are no tree: it is damaged.');
      parents[child] = parent;
    }
  });
  const order = [...nodes.keys()].filter((node) => parents[node] < 0);
  for (let i = 0; i < order.length; i++) order.push(...(nodes[order[i]].children ?? []));
  if (order.length < nodes.length) throw new Error('The nodes of this glTF file are no tree: it is damaged.');
  const local = nodes.map(localOf);
  return {
    names: nodes.map((node, i) => (bones ? (bones.get(i) ?? '') : (node.name ?? ''))),
    parents,
    order,
    rotations: local.map(({ rotation }) => rotation),
    translations: local.map(({ translation }) => translation),
    scales: local.map(({ scale }) => scale),
  };
}

function localOf({ matrix, rotation, translation, scale }: GltfNode) {
  if (matrix) {
    const { rotation: turn, position, scale: size } = takeApart(matrix);
    return { rotation: turn, translation: position, scale: [size, size, size] };
  }
  return {
    rotation: canonicalQuaternion(rotation ?? [0, 0, 0, 1]),
    translation: translation ?? [0, 0, 0],
    scale: scale ?? [1, 1, 1],
  };
}

/** Rotation, place and size of a column-major matrix without shear. */
function takeApart(m: ArrayLike<number>): { rotation: number[]; position: number[]; scale: number } {
  const lengths = [0, 4, 8].map((at) => Math.hypot(m[at], m[at + 1], m[at + 2]) || 1);
  const [a, b, c] = lengths;
  const rotation = matrixToQuaternion([
    m[0] / a, m[4] / b, m[8] / c,
    m[1] / a, m[5] / b, m[9] / c,
    m[2] / a, m[6] / b, m[10] / c,
  ]); // prettier-ignore
  return { rotation, position: [m[12], m[13], m[14]], scale: (a + b + c) / 3 };
}

/** World rotations and places of all nodes for given local rotations. */
function worldOf(tree: Tree, local: readonly (readonly number[])[]) {
  const rotations = new Float64Array(tree.names.length * 4);
  const positions = new Float64Array(tree.names.length * 3);
  const sizes = new Float64Array(tree.names.length * 3);
  for (const node of tree.order) {
    const parent = tree.parents[node];
    const turn = parent < 0 ? [0, 0, 0, 1] : rotations.subarray(parent * 4, parent * 4 + 4);
    rotations.set(multiply(turn, local[node]), node * 4);
    const size = [0, 1, 2].map((k) => (parent < 0 ? 1 : sizes[parent * 3 + k]));
    const place = rotateVector(
      turn,
      tree.translations[node].map((value, k) => value * size[k]),
    );
    for (let k = 0; k < 3; k++) {
      sizes[node * 3 + k] = size[k] * tree.scales[node][k];
      positions[node * 3 + k] = (parent < 0 ? 0 : positions[parent * 3 + k]) + place[k];
    }
  }
  return { rotations, positions };
}

/** The pose in which the skin was bound to the joints: the one rest pose that no exporter forgets. Null without a skin that has all. */
function boundRest({ json, numbers }: GltfFile, tree: Tree) {
  const wanted = mapHumanoid(tree).filter((node) => node >= 0);
  const skin = json.skins.find(({ joints }) => wanted.every((node) => joints.includes(node)));
  if (!skin || skin.inverseBindMatrices === undefined) return null;
  const matrices = numbers(skin.inverseBindMatrices);
  if (matrices.length < skin.joints.length * 16) return null;
  const rotations = Float64Array.from({ length: tree.names.length * 4 }, (_, i) => (i % 4 === 3 ? 1 : 0));
  const positions = new Float64Array(tree.names.length * 3);
  skin.joints.forEach((node, i) => {
    if (node >= tree.names.length) return;
    const { rotation, position, scale } = takeApart(matrices.subarray(i * 16, i * 16 + 16));
    // The inverse of p -> s R p + t.
    const back = conjugate(rotation);
    rotations.set(back, node * 4);
    positions.set(
      rotateVector(
        back,
        position.map((value) => -value / scale),
      ),
      node * 3,
    );
  });
  return { rotations, positions };
}

interface Track {
  node: number;
  times: Float32Array;
  values: Float32Array;
  mode: string;
}

/** An animation at spec.fps; null when it turns no joint of the body. */
function sample(
  file: GltfFile,
  tree: Tree,
  animation: GltfAnimation,
  needed: ReadonlySet<number>,
  toPose: (world: Float64Array, out: Float32Array, offset: number) => void,
): PoseSequence | null {
  const tracks: Track[] = [];
  for (const { sampler, target } of animation.channels) {
    if (target.path !== 'rotation' || target.node === undefined || !needed.has(target.node)) continue;
    const source = animation.samplers[sampler];
    if (!source) throw new Error('An animation of this glTF file is damaged.');
    const [times, values] = [file.numbers(source.input), file.numbers(source.output)];
    const size = source.interpolation === 'CUBICSPLINE' ? 12 : 4;
    if (times.length === 0 || values.length < times.length * size)
      throw new Error('An animation of this glTF file is damaged.');
    tracks.push({ node: target.node, times, values, mode: source.interpolation });
  }
  if (tracks.length === 0) return null;
  const start = Math.min(...tracks.map(({ times }) => times[0]));
  const length = Math.max(...tracks.map(({ times }) => times[times.length - 1])) - start;
  const fps = Math.min(spec.fps, length > 0 ? (MAX_FRAMES - 1) / length : spec.fps);
  // Times are 32-bit: ten minutes in, they are off by a thousandth of a frame.
  const frames = Math.floor(Math.max(0, length) * fps + 0.01) + 1;
  const quaternions = new Float32Array(frames * JOINT_COUNT * 4);
  const local = [...tree.rotations];
  for (let frame = 0; frame < frames; frame++) {
    for (const track of tracks) local[track.node] = valueAt(track, start + frame / fps);
    toPose(worldOf(tree, local).rotations, quaternions, frame * JOINT_COUNT * 4);
  }
  return { name: animation.name ?? '', fps: frames > 1 ? fps : 0, frames, quaternions };
}

/** A rotation between keys (specification, appendix C). */
function valueAt({ times, values, mode }: Track, time: number): number[] {
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const cubic = mode === 'CUBICSPLINE';
  const size = cubic ? 12 : 4;
  const key = (at: number, part = cubic ? 4 : 0) => Array.from(values.subarray(at * size + part, at * size + part + 4));
  if (time <= times[low] || high === low) return canonicalQuaternion(key(low));
  if (time >= times[high]) return canonicalQuaternion(key(high));
  const span = times[high] - times[low];
  const t = (time - times[low]) / span;
  if (mode === 'STEP') return canonicalQuaternion(key(low));
  if (!cubic) return slerp(canonicalQuaternion(key(low)), canonicalQuaternion(key(high)), t);
  const [out, into] = [key(low, 8), key(high, 0)];
  const [a, b] = [key(low), key(high)];
  const [t2, t3] = [t * t, t * t * t];
  return canonicalQuaternion(
    a.map(
      (value, k) =>
        (2 * t3 - 3 * t2 + 1) * value +
        span * (t3 - 2 * t2 + t) * out[k] +
        (-2 * t3 + 3 * t2) * b[k] +
        span * (t3 - t2) * into[k],
    ),
  );
}
