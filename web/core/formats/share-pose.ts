/** Poses in a link: 8 bits a number. */
import { axisAngleToQuaternion, quaternionToAxisAngle } from '../rotation';

/** Half a turn in as many steps as a signed byte has. */
const STEPS = 127;
/** Radians between neighbouring numbers of a rounded rotation: 1.42 degrees, so that none is off by more than 0.71. */
export const POSE_STEP = Math.PI / STEPS;
/** A little more than half a turn: what a link gave is never turned the other way round when it is shared again. */
const HALF_TURN = Math.PI + 1e-3;
/** Rounded rotations are written with so many decimals, as those of the library are. */
const DECIMALS = 1e4;

/** A pose (24 x 3 axis-angle, radians) in whole steps; turns that a signed byte cannot hold are taken the other way round first. */
export function rounded(rotations: readonly number[]): number[] {
  const steps: number[] = [];
  for (let i = 0; i < rotations.length; i += 3) {
    let turn = [rotations[i], rotations[i + 1], rotations[i + 2]];
    if (turn.some((value) => Math.abs(value) > HALF_TURN)) turn = quaternionToAxisAngle(axisAngleToQuaternion(turn));
    for (const value of turn) steps.push(Math.round(value / POSE_STEP) + 0);
  }
  return steps;
}

/** Steps in radians. */
export const radians = (step: number): number => Math.round(step * POSE_STEP * DECIMALS) / DECIMALS;
