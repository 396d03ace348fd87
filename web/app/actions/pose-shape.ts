/** What the editor does to the pose itself: typed values, resets, mirroring, levelling, turning, variation. */
import {
  headingOfPose,
  levelFeet,
  LIMBS,
  mirrorJointEdit,
  mirrorLimb,
  randomPose,
  resetJoints,
  standUpright,
  turnPose,
  withTurn,
  withWorldTurn,
  type ClampJoint,
  type Limb,
} from '../../core/pose-tools';
import { axisAngleToQuaternion } from '../../core/rotation';
import { JOINTS, MIRROR, mirrorPose } from '../../core/skeleton';
import type { Context } from '../context';
import { eulerToAxisAngle, type Degrees } from '../euler';
import type { PoseDesk } from './pose-draft';
import { limitWord, withinTools, type PoseMath } from './pose-limits';
import { samePose } from './pose-draft';

const TURN = 'Turn figure';

/** Actions that shape the pose. */
export function poseShapeActions(context: Context, desk: PoseDesk, math: PoseMath) {
  const { state } = context;
  const free: ClampJoint = (_, q) => q;
  const clamp = (): ClampJoint => (state.poseTools.value.limits ? math.clampRotation : free);
  /** What the last variation came from: pressing again goes elsewhere from there instead of ever further away. */
  let variation: { base: readonly number[]; result: readonly number[]; seed: number } | null = null;

  const reset = (members: readonly number[], label: string) => {
    const sides = state.poseTools.value.mirror ? [...members, ...members.map((joint) => MIRROR[joint])] : members;
    desk.push(resetJoints(desk.present, new Set(sides)), label);
  };

  return {
    /** Sets one joint by x, y, z degrees, in the space of the tools; the other side follows where both move. */
    setJointDegrees(joint: number, degrees: Readonly<Degrees>): void {
      const { space, mirror } = state.poseTools.value;
      const turn = axisAngleToQuaternion(eulerToAxisAngle(degrees));
      const typed = (space === 'world' ? withWorldTurn : withTurn)(desk.present, joint, turn);
      const { rotations, limited } = withinTools(context, math, typed, [joint]);
      desk.push(mirror ? mirrorJointEdit(rotations, joint) : rotations, 'Rotate joint');
      if (limited.length > 0) desk.say(limitWord(limited));
    },

    /** Takes one joint to a place, metres; the body follows, pins stay. */
    async moveJointTo(joint: number, target: readonly [number, number, number]): Promise<void> {
      const before = desk.present;
      const moved = await math.reach(before, joint, target, state.poseTools.value);
      // Whatever was done while the solver was fetched stands.
      if (desk.present !== before) return;
      desk.push(moved, 'Move joint');
    },

    resetJoint: (joint: number) => reset([joint], 'Reset joint'),
    resetLimb: (limb: Limb) => reset(LIMBS[limb], 'Reset limb'),
    /** Arms out, feet together: the pose that everything starts from. The heading stays. */
    resetPose: () => reset([...JOINTS.keys()], 'Reset pose'),

    mirrorDraft: () => desk.push(mirrorPose(desk.present), 'Mirror pose'),

    /** Gives the other side what this limb does; torso and head are mirrored in place. */
    mirrorLimb: (limb: Limb) => desk.push(mirrorLimb(desk.present, limb), 'Mirror limb'),

    /** Takes the tilt out of the hips. */
    standUpright: () => desk.push(standUpright(desk.present), 'Stand upright'),

    /** Puts the soles of the standing feet flat. */
    levelFeet: () => desk.push(levelFeet(desk.present, clamp()), 'Level feet'),

    /** Shows the whole figure facing a way, degrees about the vertical, 0 = to the front; `settlePose` keeps it as one step. */
    previewHeading(degrees: number): void {
      const base = desk.base(TURN);
      desk.attempt(turnPose(base, (degrees * Math.PI) / 180 - headingOfPose(base)), TURN);
    },
    settlePose: desk.settle,

    setVariationAmount: (amount: number) => (state.variationAmount.value = amount),

    /** A random variation, as wild as chosen; each call is another one. */
    varyPose(): void {
      desk.settle();
      const again = variation !== null && samePose(variation.result, desk.present);
      const base = again ? variation!.base : desk.present;
      const seed = (variation?.seed ?? 0) + 1;
      const result = randomPose(base, state.variationAmount.value, seed, clamp());
      desk.push(result, 'Random variation');
      variation = { base, result, seed };
    },
  };
}
