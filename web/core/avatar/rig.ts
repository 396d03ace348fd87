/** An avatar's file as a skeleton: nodes, names, where they rest, what is below its feet. */
import { openGltf, type GltfFile } from '../formats/gltf-file';
import { plantTree, vrmBones, worldOf, type GltfTree, type WorldRest } from '../formats/gltf-tree';

/** What a .glb, .vrm or self-contained .gltf file says about its nodes; node i is the file's node i. Units are the file's scene units. */
export interface AvatarRig {
  kind: 'glTF' | 'VRM 0' | 'VRM 1';
  /** Title in the file; empty where it has none. */
  title: string;
  /** The file's node names; where it gives none, `Node 12`. */
  names: readonly string[];
  /** Parent of each node; -1 for a root. */
  parents: readonly number[];
  /** Nodes that can be bones, each after its parent, depth first: what a mapping dialog lists. */
  candidates: readonly number[];
  /** How many candidates are above a candidate, for indenting; by node. */
  depths: readonly number[];
  /** For each node the name of its bone by the file's own word (VRM humanoid); null where the file has none. */
  declared: ReadonlyMap<number, string> | null;
  tree: GltfTree;
  /** Where the nodes stand. */
  world: WorldRest & { sizes: Float64Array };
  /** The longest way between two bones along an axis, scene units. */
  size: number;
  file: GltfFile;
}

/** Larger files are refused: a page that holds the file, its copy and its pictures runs out of memory. */
export const MAX_AVATAR_BYTES = 200 * 2 ** 20;
/** Pelvis, hips, knees, ankles, shoulders and elbows. */
const FEWEST = 11;

/**
 * Reads the skeleton of an avatar.
 * @throws Error with a sentence for the visitor when the file is damaged, too large or holds no skeleton
 */
export function readAvatarRig(bytes: Uint8Array): AvatarRig {
  if (bytes.length > MAX_AVATAR_BYTES) {
    throw new Error(
      `This file has ${Math.round(bytes.length / 2 ** 20)} MB: avatars up to ${MAX_AVATAR_BYTES / 2 ** 20} MB can be used.`,
    );
  }
  const file = openGltf(bytes);
  const vrm = vrmBones(file);
  if (vrm?.kind === 'VRMA')
    throw new Error('This is a motion without a body (.vrma): bring it in as a pose file instead.');
  const tree = plantTree(file.json.nodes, null);
  const world = worldOf(tree, tree.rotations);
  if (!world.positions.every(Number.isFinite) || !world.rotations.every(Number.isFinite)) {
    throw new Error('The places of the bones in this file are no numbers: it is damaged.');
  }
  const declared = vrm?.nodes ?? null;
  const { candidates, depths } = bonesOf(file, tree, declared);
  if (candidates.length < FEWEST) {
    throw new Error(
      `There is no body in this file: it has ${candidates.length === 1 ? 'one bone' : `${candidates.length} bones`}, and a body with arms and legs has ${FEWEST} at least.`,
    );
  }
  const span = [0, 1, 2].map((k) => {
    const along = candidates.map((node) => world.positions[node * 3 + k]);
    return along.reduce((a, b) => Math.max(a, b)) - along.reduce((a, b) => Math.min(a, b));
  });
  const size = Math.max(...span);
  if (!(size > 0)) throw new Error('All bones of this file are at the same place: there is no body in it.');
  return {
    kind: vrm ? (vrm.kind as AvatarRig['kind']) : 'glTF',
    title: titleOf(file),
    names: tree.names.map((name, node) => name || `Node ${node}`),
    parents: tree.parents,
    candidates,
    depths,
    declared,
    tree,
    world,
    size,
    file,
  };
}

/** Skinned joints and what lies between them; without a skin, everything. */
function bonesOf({ json }: GltfFile, tree: GltfTree, declared: ReadonlyMap<number, string> | null) {
  const nodes = tree.names.length;
  const marked = new Set<number>(declared?.keys());
  for (const { joints } of json.skins) for (const joint of joints) if (joint < nodes) marked.add(joint);
  const chosen = new Uint8Array(nodes);
  if (marked.size === 0) chosen.fill(1);
  // How many marked nodes are at or below each; the nodes from one marked node up to where all meet are bones.
  const below = new Uint32Array(nodes);
  for (let i = nodes - 1; i >= 0; i--) {
    const node = tree.order[i];
    if (marked.has(node)) below[node]++;
    if (tree.parents[node] >= 0) below[tree.parents[node]] += below[node];
  }
  for (const node of tree.order) {
    const split =
      below[node] === marked.size && !marked.has(node) && onlyOneBranch(json.nodes[node].children, below, marked.size);
    if (below[node] > 0 && !split) chosen[node] = 1;
  }
  const candidates: number[] = [];
  const depths = new Array<number>(nodes).fill(0);
  const waiting = tree.order.filter((node) => tree.parents[node] < 0).reverse();
  for (let node = waiting.pop(); node !== undefined; node = waiting.pop()) {
    const parent = tree.parents[node];
    depths[node] = parent < 0 ? 0 : depths[parent] + chosen[parent];
    if (chosen[node]) candidates.push(node);
    const children = json.nodes[node].children ?? [];
    for (let i = children.length - 1; i >= 0; i--) waiting.push(children[i]);
  }
  return { candidates, depths };
}

/** True when all that is marked hangs on one child: the node is above the skeleton, not in it. */
function onlyOneBranch(children: readonly number[] = [], below: Uint32Array, all: number): boolean {
  return children.some((child) => below[child] === all);
}

function titleOf({ json }: GltfFile): string {
  const meta = (name: string) => (json.extensions[name] as { meta?: Record<string, unknown> } | null | undefined)?.meta;
  const title = meta('VRMC_vrm')?.name ?? meta('VRM')?.title;
  return typeof title === 'string' ? title.slice(0, 100) : '';
}
