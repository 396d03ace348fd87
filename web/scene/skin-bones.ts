/**
 * The bones that move the skin. A joint that bends far, or a limb that twists, gets helper bones that share the rotation out, so that
 * linear blend skinning keeps its volume: no pinched elbows, no "candy wrapper" wrists.
 * A local rotation is split into swing and twist about the limb (q = swing * twist); each helper takes a part of one of them.
 */
import { forwardKinematics, JOINT_COUNT, jointIndex, OFFSETS, PARENTS, worldRotations } from '../core/skeleton';
import { multiply, rotateVector, slerp, type Numbers } from '../core/rotation';
import { REST } from './rest';

/** How a bone gets its rotation from the joint that it turns about. */
export type Recipe =
  /** The joint's own world rotation. */
  | { kind: 'joint' }
  /** A fraction of the joint's swing, without twist. */
  | { kind: 'bend'; fraction: number }
  /** All of the swing and a fraction of the limb's twist (its own and what the joint at its far end adds). */
  | { kind: 'twist'; fraction: number };

/** A bone of the skin. */
export interface SkinBone {
  name: string;
  joint: number;
  recipe: Recipe;
}

const JOINT: Recipe = { kind: 'joint' };
const bend = (fraction: number): Recipe => ({ kind: 'bend', fraction });
const twist = (fraction: number): Recipe => ({ kind: 'twist', fraction });

/** Bones of one side, in order from the trunk outwards: [name, joint, recipe]. */
const SIDE: readonly (readonly [string, string, Recipe])[] = [
  ['collar', 'collar', JOINT],
  ['shoulder1', 'shoulder', bend(1 / 3)],
  ['shoulder2', 'shoulder', bend(2 / 3)],
  ['upper1', 'shoulder', twist(0)],
  ['upper2', 'shoulder', twist(0.5)],
  ['upper3', 'shoulder', twist(1)],
  ['elbow1', 'elbow', bend(1 / 3)],
  ['elbow2', 'elbow', bend(2 / 3)],
  ['lower1', 'elbow', twist(0)],
  ['lower2', 'elbow', twist(0.5)],
  ['lower3', 'elbow', twist(1)],
  ['wrist', 'wrist', bend(0.5)],
  ['palm', 'wrist', JOINT],
  ['fingers', 'hand', JOINT],
  ['hip1', 'hip', bend(1 / 3)],
  ['hip2', 'hip', bend(2 / 3)],
  ['thigh1', 'hip', twist(0)],
  ['thigh2', 'hip', twist(1)],
  ['knee1', 'knee', bend(1 / 3)],
  ['knee2', 'knee', bend(2 / 3)],
  ['shin1', 'knee', twist(0)],
  ['shin2', 'knee', twist(1)],
  ['ankle', 'ankle', bend(0.5)],
  ['sole', 'ankle', JOINT],
  ['toes', 'foot', JOINT],
];

const TRUNK = ['pelvis', 'spine1', 'spine2', 'spine3', 'neck', 'head'];

/** Every bone of the skin: the trunk's, then the left side's, then the right side's in the same order. */
export const SKIN_BONES: readonly SkinBone[] = [
  ...TRUNK.map((name) => ({ name, joint: jointIndex(name), recipe: JOINT })),
  ...['left', 'right'].flatMap((side) =>
    SIDE.map(([name, joint, recipe]) => ({ name: `${side}_${name}`, joint: jointIndex(`${side}_${joint}`), recipe })),
  ),
];

/** Index of a skin bone by name. */
export function skinBone(name: string): number {
  const index = SKIN_BONES.findIndex((bone) => bone.name === name);
  if (index < 0) throw new Error(`The skin has no bone "${name}".`);
  return index;
}

/** For each bone the one on the other side. */
export const MIRRORED_BONES: readonly number[] = SKIN_BONES.map((_, i) => {
  if (i < TRUNK.length) return i;
  return i < TRUNK.length + SIDE.length ? i + SIDE.length : i - SIDE.length;
});

/** Joints whose limb twists: joint -> the child at the limb's far end, whose twist the limb's skin shares. */
const LIMBS = new Map<number, number>();
/** The far ends of those whose own twist is shared out over the limb before them. */
const ENDS = new Map<number, number>();
for (const side of ['left', 'right']) {
  LIMBS.set(jointIndex(`${side}_shoulder`), jointIndex(`${side}_elbow`));
  LIMBS.set(jointIndex(`${side}_elbow`), jointIndex(`${side}_wrist`));
  LIMBS.set(jointIndex(`${side}_hip`), jointIndex(`${side}_knee`));
  LIMBS.set(jointIndex(`${side}_knee`), jointIndex(`${side}_ankle`));
  ENDS.set(jointIndex(`${side}_wrist`), jointIndex(`${side}_elbow`));
  ENDS.set(jointIndex(`${side}_ankle`), jointIndex(`${side}_knee`));
}

/** Unit vector along the limb that a joint moves, in its rest frame. */
const AXES = OFFSETS.map((_, joint) => {
  const child = LIMBS.get(joint);
  const offset = child === undefined ? [0, 1, 0] : OFFSETS[child];
  const length = Math.hypot(...offset);
  return offset.map((c) => c / length);
});

const IDENTITY = [0, 0, 0, 1];

/** Angle of the twist of a unit quaternion about a unit axis, -pi..pi radians. */
export function twistAngle(q: Numbers, axis: Numbers): number {
  const along = q[0] * axis[0] + q[1] * axis[1] + q[2] * axis[2];
  // Both near zero: a half turn of swing, whose twist is not defined; none is the calmest choice.
  if (Math.hypot(along, q[3]) < 1e-6) return 0;
  const angle = 2 * Math.atan2(along, q[3]);
  return angle > Math.PI ? angle - 2 * Math.PI : angle < -Math.PI ? angle + 2 * Math.PI : angle;
}

function about(axis: Numbers, angle: number): number[] {
  const s = Math.sin(angle / 2);
  return [axis[0] * s, axis[1] * s, axis[2] * s, Math.cos(angle / 2)];
}

/**
 * Rotation of a skin bone against the parent of its joint.
 * @param local a joint's local rotation
 */
export function boneTurn({ joint, recipe }: SkinBone, local: (joint: number) => number[]): number[] {
  const q = local(joint);
  if (recipe.kind === 'joint') return q;
  const limbBefore = ENDS.get(joint);
  if (limbBefore !== undefined) {
    // q = twist * swing: the twist belongs to the limb before the joint, so only the swing is bent here.
    const axis = AXES[limbBefore];
    const angle = twistAngle(q, axis);
    const swing = multiply(about(axis, -angle), q);
    const fraction = recipe.kind === 'bend' ? recipe.fraction : 1;
    return multiply(about(axis, angle), slerp(IDENTITY, swing, fraction)) as number[];
  }
  const axis = AXES[joint];
  const own = twistAngle(q, axis);
  const swing = multiply(q, about(axis, -own));
  if (recipe.kind === 'bend') return slerp(IDENTITY, swing, recipe.fraction) as number[];
  const end = LIMBS.get(joint)!;
  const added = ENDS.has(end) ? twistAngle(local(end), axis) : 0;
  return multiply(swing, about(axis, recipe.fraction * (own + added))) as number[];
}

/** World state of the skeleton and of the skin bones for one pose. */
export class SkinPose {
  /** World joint positions, 24 x 3, metres. */
  readonly joints = new Float32Array(JOINT_COUNT * 3);
  /** World joint rotations, 24 x 4. */
  readonly rotations = new Float32Array(JOINT_COUNT * 4);
  /** Matrices from the rest pose to this pose, column-major, one per skin bone. */
  readonly matrices = new Float32Array(SKIN_BONES.length * 16);

  /**
   * Computes all three.
   * @param quaternions 24 x 4 local rotations
   * @param root pelvis position, metres
   */
  set(quaternions: Numbers, root: Numbers): void {
    forwardKinematics(quaternions, root, this.joints);
    worldRotations(quaternions, this.rotations);
    const local = (joint: number) => [0, 1, 2, 3].map((i) => quaternions[joint * 4 + i]);
    SKIN_BONES.forEach((bone, index) => this.write(index, bone.joint, this.rotationOf(bone, local)));
  }

  private rotationOf(bone: SkinBone, local: (joint: number) => number[]): number[] {
    if (bone.recipe.kind === 'joint') return this.worldOf(bone.joint);
    return multiply(this.worldOf(PARENTS[bone.joint]), boneTurn(bone, local)) as number[];
  }

  private worldOf(joint: number): number[] {
    return [0, 1, 2, 3].map((i) => this.rotations[joint * 4 + i]);
  }

  private write(bone: number, joint: number, q: number[]): void {
    const [x, y, z, w] = q;
    const m = this.matrices;
    const at = bone * 16;
    m[at] = 1 - 2 * (y * y + z * z);
    m[at + 1] = 2 * (x * y + w * z);
    m[at + 2] = 2 * (x * z - w * y);
    m[at + 4] = 2 * (x * y - w * z);
    m[at + 5] = 1 - 2 * (x * x + z * z);
    m[at + 6] = 2 * (y * z + w * x);
    m[at + 8] = 2 * (x * z + w * y);
    m[at + 9] = 2 * (y * z - w * x);
    m[at + 10] = 1 - 2 * (x * x + y * y);
    const rest = rotateVector(q, [REST[joint * 3], REST[joint * 3 + 1], REST[joint * 3 + 2]]);
    for (let i = 0; i < 3; i++) m[at + 12 + i] = this.joints[joint * 3 + i] - rest[i];
    m[at + 15] = 1;
  }
}
