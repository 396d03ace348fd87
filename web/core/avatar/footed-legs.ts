/** The legs of an avatar with the soles under them. */
import { jointIndex, OFFSETS } from '../skeleton';
import { rotateVector } from '../rotation';
import { spec } from '../spec';
import type { DrivenNode } from './driven';
import type { PlacedLeg } from './leg';
import type { AvatarRig } from './rig';
import { findSoles, type Sole } from './soles';

const { feet } = spec.skeleton;

/** A leg with all that its foot needs. */
export interface FootedLeg extends PlacedLeg {
  sole: Sole;
  /** Places of its nodes in the list. */
  at: { hip: number; knee: number; ankle: number; toe: number };
  /** Ours. */
  foot: { ankle: number; toe: number };
  /** From the ankle: the lowest point of the sole (its height) and the ball. */
  low: number;
  ball: Float64Array;
  target: Float64Array;
  across: Float64Array;
  /** How much further aside the ball stands at rest than ours would, along the foot's own left, scene units. */
  aside: number;
  /** 1 = the foot goes to its place, 0 = it keeps its angles. */
  hold: number;
}

/** The nodes of an avatar that are turned. */
interface TurnedNodes {
  driven: readonly DrivenNode[];
  /** Of our joints: the place in the list of the node that is turned as it; -1 = none. */
  placeOf: readonly number[];
  /** Places and world rotations of the list's nodes: the legs see what becomes of them. */
  places: readonly Float64Array[];
  turns: readonly Float64Array[];
}

/** Left and right leg of an avatar. */
export function makeLegs(rig: AvatarRig, { driven, placeOf, places, turns }: TurnedNodes): FootedLeg[] {
  const at = (['left', 'right'] as const).map((side) => {
    const [hip, knee, ankle, toe] = ['hip', 'knee', 'ankle', 'foot'].map(
      (part) => placeOf[jointIndex(`${side}_${part}`)],
    );
    return { hip, knee, ankle, toe };
  });
  const long = (place: number) => Math.hypot(...driven[place].offset);
  const ourLong = (joint: number) => Math.hypot(...OFFSETS[joint]);
  const rough =
    (long(at[0].knee) + long(at[0].ankle)) / (ourLong(jointIndex('left_knee')) + ourLong(jointIndex('left_ankle')));
  const soles = findSoles(rig, driven, at, rough);
  return at.map((leg, i) => ({
    sole: soles[i],
    at: leg,
    foot: i === 0 ? feet.left : feet.right,
    low: 0,
    ball: new Float64Array(3),
    target: new Float64Array(3),
    across: new Float64Array(3),
    aside: 0,
    hold: 0,
    hip: places[leg.hip],
    knee: places[leg.knee],
    ankle: places[leg.ankle],
    hipTurn: turns[leg.hip],
    kneeTurn: turns[leg.knee],
    thigh: long(leg.knee),
    shin: long(leg.ankle),
  }));
}

/**
 * Works out the lowest point and the ball of a foot, from its ankle.
 * @param scratch room for a point
 */
export function placeSole(
  leg: FootedLeg,
  places: readonly Float64Array[],
  turns: readonly Float64Array[],
  scratch: Float64Array,
): void {
  const { sole, at } = leg;
  const ankle = places[at.ankle];
  let low = lowest(sole.ankle, turns[at.ankle], scratch);
  if (at.toe < 0) {
    rotateVector(turns[at.ankle], sole.ball, leg.ball);
  } else {
    for (let k = 0; k < 3; k++) leg.ball[k] = places[at.toe][k] - ankle[k];
    low = Math.min(low, leg.ball[1] + lowest(sole.toe, turns[at.toe], scratch));
  }
  leg.low = low;
}

/** Height of the lowest of some points when they are turned; 0 without points. */
function lowest(points: Float64Array, turn: Float64Array, scratch: Float64Array): number {
  let low = points.length > 0 ? Infinity : 0;
  for (let i = 0; i < points.length; i += 3) {
    for (let k = 0; k < 3; k++) scratch[k] = points[i + k];
    low = Math.min(low, rotateVector(turn, scratch, scratch)[1]);
  }
  return low;
}
