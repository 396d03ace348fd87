/** The nodes of a glTF file as a tree in the world, and which of them a VRM file calls which bone. */
import { canonicalQuaternion, conjugate, matrixToQuaternion, multiply, rotateVector } from '../rotation';
import type { GltfFile, GltfNode } from './gltf-file';

/** Where the nodes are and what hangs on what. */
export interface GltfTree {
  names: string[];
  parents: number[];
  /** Every node after its parent. */
  order: number[];
  /** Local rotations and places, as the file holds them. */
  rotations: number[][];
  translations: number[][];
  scales: number[][];
}

/** Where nodes are in the world. */
export interface WorldRest {
  /** nodes x 4 (x y z w). */
  rotations: Float64Array;
  /** nodes x 3. */
  positions: Float64Array;
}

/** A VRM file's own word on its bones. */
export interface VrmBones {
  /** For each node the name of its bone. */
  nodes: Map<number, string>;
  /** Avatars of VRM 0 look to -Z. */
  kind: 'VRM 0' | 'VRM 1' | 'VRMA';
}

/** The humanoid of a VRM avatar or animation: for each node the name of its bone. */
export function vrmBones({ json }: GltfFile): VrmBones | null {
  const record = (value: unknown) =>
    typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {};
  const nodes = new Map<number, string>();
  const put = (bone: unknown, node: unknown) => {
    if (typeof bone === 'string' && typeof node === 'number' && json.nodes[node]) nodes.set(node, bone);
  };
  for (const name of ['VRMC_vrm', 'VRMC_vrm_animation']) {
    const bones = record(record(record(json.extensions[name]).humanoid).humanBones);
    for (const [bone, entry] of Object.entries(bones)) put(bone, record(entry).node);
    if (nodes.size > 0) return { nodes, kind: name === 'VRMC_vrm' ? 'VRM 1' : 'VRMA' };
  }
  const old = record(record(json.extensions.VRM).humanoid).humanBones;
  if (Array.isArray(old)) for (const entry of old) put(record(entry).bone, record(entry).node);
  return nodes.size > 0 ? { nodes, kind: 'VRM 0' } : null;
}

/**
 * Parents, order and local transforms of a file's nodes.
 * @param bones for each node the name to give it instead of its own
 * @throws Error when the nodes are no tree
 */
export function plantTree(nodes: readonly GltfNode[], bones: ReadonlyMap<number, string> | null): GltfTree {
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

/** World rotations, places and sizes of all nodes for given local rotations. */
export function worldOf(tree: GltfTree, local: readonly (readonly number[])[]): WorldRest & { sizes: Float64Array } {
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
  return { rotations, positions, sizes };
}

/** The pose in which the skin was bound to the joints: the one rest pose that no exporter forgets. Null without a skin that has all. */
export function boundRest({ json, numbers }: GltfFile, tree: GltfTree, nodes: readonly number[]): WorldRest | null {
  const wanted = nodes.filter((node) => node >= 0);
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
