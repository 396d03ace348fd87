/** The vertices of an avatar, each with the bone that carries it most. */
import * as v from 'valibot';
import { conjugate, rotateVector } from '../rotation';
import type { DrivenNode } from './driven';
import type { AvatarRig } from './rig';
import { pointOf, quaternionOf } from '../vector';

const index = v.pipe(v.number(), v.integer(), v.minValue(0));
const schema = v.array(v.object({ primitives: v.array(v.object({ attributes: v.record(v.string(), v.unknown()) })) }));

/** Receives the place in the list of the node that carries a vertex, and where it is from that node, in its axes, scene units. */
type See = (owner: number, x: number, y: number, z: number) => void;

/** Vertices beyond these are not looked at: feet are known long before. */
const MOST_VERTICES = 2_000_000;

/**
 * Goes through all vertices that can be read; those of compressed meshes cannot.
 */
export function readMeshes(rig: AvatarRig, driven: readonly DrivenNode[], see: See): void {
  const { json } = rig.file;
  const meshes = v.safeParse(schema, json.meshes);
  if (!meshes.success) return;
  const owners = ownersOf(rig, driven);
  const done = new Set<string>();
  const carriers = new Map<number, Carrier[]>();
  const carriersOf = (skin: number) => {
    const known = carriers.get(skin) ?? json.skins[skin].joints.map((node) => carrierFor(rig, driven, owners, node));
    carriers.set(skin, known);
    return known;
  };
  let budget = MOST_VERTICES;
  json.nodes.forEach(({ mesh, skin }, node) => {
    const bindings = skin === undefined ? null : json.skins[skin];
    for (const { attributes } of (mesh === undefined ? undefined : meshes.output[mesh])?.primitives ?? []) {
      const keys = [attributes.POSITION, attributes.JOINTS_0, attributes.WEIGHTS_0];
      // Parts of one figure often share their vertices.
      const key = [...keys, bindings ? `s${skin}` : node].join();
      if (done.has(key) || budget <= 0) continue;
      done.add(key);
      try {
        const numbers = (accessor: unknown) => rig.file.numbers(v.parse(index, accessor));
        const positions = numbers(keys[0]);
        budget -= positions.length / 3;
        if (!bindings) {
          eachRigid(carrierFor(rig, driven, owners, node), positions, see);
        } else if (bindings.inverseBindMatrices !== undefined) {
          const skinned = { carriers: carriersOf(skin!), inverse: numbers(bindings.inverseBindMatrices) };
          eachSkinned(skinned, positions, numbers(keys[1]), numbers(keys[2]), see);
        }
      } catch {
        // Compressed or damaged: the figure may be seen all the same, its soles come from its bones.
      }
    }
  });
}

/** For each node the place in `driven` of the nearest that is turned, at it or above it; -1 = none. */
function ownersOf(rig: AvatarRig, driven: readonly DrivenNode[]): Int32Array {
  const owners = new Int32Array(rig.parents.length).fill(-1);
  driven.forEach(({ node }, i) => (owners[node] = i));
  for (const node of rig.tree.order) {
    if (owners[node] < 0 && rig.parents[node] >= 0) owners[node] = owners[rig.parents[node]];
  }
  return owners;
}

/** Brings a point in a node's own axes and units to the axes of the node that turns it; null where none does. */
type Carrier = { owner: number; carry: (point: ArrayLike<number>) => ArrayLike<number> } | null;

function carrierFor({ world }: AvatarRig, driven: readonly DrivenNode[], owners: Int32Array, node: number): Carrier {
  const owner = owners[node];
  if (!(owner >= 0)) return null;
  const above = driven[owner].node;
  const [place, from] = [pointOf(world.positions, node), pointOf(world.positions, above)];
  const turn = quaternionOf(world.rotations, node);
  const back = conjugate(quaternionOf(world.rotations, above));
  const size = pointOf(world.sizes, node);
  const out = [0, 0, 0];
  const carry = (point: ArrayLike<number>) => {
    for (let k = 0; k < 3; k++) out[k] = point[k] * size[k];
    rotateVector(turn, out, out);
    for (let k = 0; k < 3; k++) out[k] += place[k] - from[k];
    return rotateVector(back, out, out);
  };
  return { owner, carry };
}

function eachRigid(carrier: Carrier, positions: Float32Array, see: See): void {
  if (!carrier) return;
  for (let i = 0; i < positions.length; i += 3) {
    const p = carrier.carry([positions[i], positions[i + 1], positions[i + 2]]);
    see(carrier.owner, p[0], p[1], p[2]);
  }
}

function eachSkinned(
  { carriers, inverse }: { carriers: readonly Carrier[]; inverse: Float32Array },
  positions: Float32Array,
  bones: Float32Array,
  weights: Float32Array,
  see: See,
): void {
  const point = [0, 0, 0];
  for (let i = 0; i < positions.length / 3; i++) {
    let most = 0;
    for (let k = 1; k < 4; k++) if (weights[i * 4 + k] > weights[i * 4 + most]) most = k;
    const bone = bones[i * 4 + most];
    const carrier = carriers[bone];
    if (!carrier || inverse.length < (bone + 1) * 16) continue;
    const m = bone * 16;
    const [x, y, z] = [positions[i * 3], positions[i * 3 + 1], positions[i * 3 + 2]];
    for (let k = 0; k < 3; k++) {
      point[k] = inverse[m + k] * x + inverse[m + 4 + k] * y + inverse[m + 8 + k] * z + inverse[m + 12 + k];
    }
    const p = carrier.carry(point);
    see(carrier.owner, p[0], p[1], p[2]);
  }
}
