/** What of an avatar's feet touches the floor: the outermost low points of its mesh, or, without one, what its bones suggest. */
import { HEEL_OFFSET } from '../contact-body';
import { conjugate, rotateVector, type Numbers } from '../rotation';
import { OFFSETS } from '../skeleton';
import { spec } from '../spec';
import type { DrivenNode } from './driven';
import { readMeshes } from './mesh';
import type { AvatarRig } from './rig';

/** Points of one foot, n x 3 each, scene units. */
export interface Sole {
  /** From the ankle, in the axes of its node. */
  ankle: Float64Array;
  /** From the toes' joint, in the axes of its node; empty without one. */
  toe: Float64Array;
  /** The ball of the foot from the ankle, in the axes of its node, for a foot without toes. */
  ball: Float64Array;
}

/** A foot's nodes in the list of those that are turned; toe -1 = it has none. */
export interface FootNodes {
  ankle: number;
  toe: number;
}

const FEET = [spec.skeleton.feet.left, spec.skeleton.feet.right];
/** Directions in which the outermost point is looked for, in our axes: down, and down and aside to all sides, steep and less steep. */
const WAYS: readonly (readonly number[])[] = [
  [0, -1, 0],
  ...[0.35, 1].flatMap((aside) =>
    Array.from({ length: 8 }, (_, i) => {
      const angle = (i * Math.PI) / 4;
      return [aside * Math.sin(angle), -1, aside * Math.cos(angle)];
    }),
  ),
];

/**
 * Finds the soles.
 * @param scale scene units per metre of ours, by the length of the legs
 */
export function findSoles(
  rig: AvatarRig,
  driven: readonly DrivenNode[],
  feet: readonly FootNodes[],
  scale: number,
): Sole[] {
  const owners = feet.flatMap(({ ankle, toe }) => (toe < 0 ? [ankle] : [ankle, toe]));
  const support = new Map(owners.map((owner) => [owner, new Support(driven[owner].alignment)]));
  readMeshes(rig, driven, (owner, x, y, z) => support.get(owner)?.look(x, y, z));
  return feet.map(({ ankle, toe }, foot) => {
    const { alignment } = driven[ankle];
    const ours = (v: Numbers) =>
      rotateVector(conjugate(Array.from(alignment)), [v[0] * scale, v[1] * scale, v[2] * scale]);
    const ball = Float64Array.from(ours(OFFSETS[FEET[foot].toe]));
    const points = [support.get(ankle)!.points(), toe < 0 ? new Float64Array(0) : support.get(toe)!.points()];
    const sound = isSound(points[0], driven[ankle], 0.4 * scale);
    if (sound) return { ankle: points[0], toe: points[1], ball };
    // No mesh to be read: as thick as ours.
    const below = [0, -spec.skeleton.toeHeight, 0];
    const heel = HEEL_OFFSET.map((value, k) => value + below[k]);
    if (toe < 0) {
      const front = OFFSETS[FEET[foot].toe].map((value, k) => value + below[k]);
      return { ankle: Float64Array.from([...ours(heel), ...ours(front)]), toe: points[1], ball };
    }
    // The heel is as low as the ball, however high this ankle is.
    const way = rotateVector(Array.from(alignment), driven[toe].offset);
    heel[1] = way[1] / scale + below[1];
    const front = rotateVector(
      conjugate(Array.from(driven[toe].alignment)),
      below.map((value) => value * scale),
    );
    return { ankle: Float64Array.from(ours(heel)), toe: Float64Array.from(front), ball };
  });
}

/** True when there are points, and the lowest is below the ankle, not further than `most`. */
function isSound(points: Float64Array, { alignment }: DrivenNode, most: number): boolean {
  let lowest = 0;
  for (let i = 0; i < points.length; i += 3) {
    lowest = Math.min(lowest, rotateVector(Array.from(alignment), points.subarray(i, i + 3))[1]);
  }
  return lowest < -1e-3 * most && lowest > -most;
}

/** The outermost of many points in some directions. */
class Support {
  readonly #ways: number[][];
  readonly #most = new Float64Array(WAYS.length).fill(-Infinity);
  readonly #found = new Float64Array(WAYS.length * 3);

  /** @param alignment of the node in whose axes the points are */
  constructor(alignment: Float64Array) {
    const back = conjugate(Array.from(alignment));
    this.#ways = WAYS.map((way) => Array.from(rotateVector(back, way)));
  }

  look(x: number, y: number, z: number): void {
    for (let i = 0; i < this.#ways.length; i++) {
      const way = this.#ways[i];
      const far = x * way[0] + y * way[1] + z * way[2];
      if (!(far > this.#most[i])) continue;
      this.#most[i] = far;
      this.#found[i * 3] = x;
      this.#found[i * 3 + 1] = y;
      this.#found[i * 3 + 2] = z;
    }
  }

  points(): Float64Array {
    return this.#most[0] > -Infinity ? this.#found : new Float64Array(0);
  }
}
