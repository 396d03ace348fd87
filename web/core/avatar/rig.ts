/** An avatar's file as a skeleton: nodes, names, where they rest, what is below its feet. */
import type { BoneMap } from './bones';

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
  /** Which bone is which by the file's own word (VRM humanoid), or null. */
  declared: BoneMap | null;
}

/**
 * Reads the skeleton of an avatar.
 * @throws Error with a sentence for the visitor when the file is damaged, too large or holds no skeleton
 */
export function readAvatarRig(bytes: Uint8Array): AvatarRig {
  throw new Error(`Avatars cannot be read yet (${bytes.length} bytes).`);
}
