/** The figure's body as capsules on the joints: what a pointer hits and what stands on the floor. Pure numbers, no three. */
import { forwardKinematics, JOINT_COUNT, jointIndex, worldRotations } from '../core/skeleton';
import { rotateVector, type Numbers } from '../core/rotation';
import { REST } from './rest';

/** A ball that moves with a joint. */
export interface BodyPoint {
  joint: number;
  /** From the joint, in its own frame, metres. */
  offset: readonly [number, number, number];
  /** Metres. */
  radius: number;
}

/** A stretch of the body between two balls. */
export interface Capsule {
  /** Joint that turns this stretch: what a click on it selects. */
  joint: number;
  from: BodyPoint;
  to: BodyPoint;
}

function point(joint: string, radius: number, offset: [number, number, number] = [0, 0, 0]): BodyPoint {
  return { joint: jointIndex(joint), offset, radius };
}

function capsule(from: BodyPoint, to: BodyPoint, joint = from.joint): Capsule {
  return { joint, from, to };
}

const sideCapsules = (side: 'left' | 'right'): Capsule[] => {
  const out = side === 'left' ? 1 : -1;
  const j = (name: string) => `${side}_${name}`;
  return [
    capsule(point(j('collar'), 0.055), point(j('shoulder'), 0.06)),
    capsule(point(j('shoulder'), 0.056), point(j('elbow'), 0.037)),
    capsule(point(j('elbow'), 0.04), point(j('wrist'), 0.028)),
    capsule(point(j('wrist'), 0.032), point(j('hand'), 0.034)),
    capsule(point(j('hand'), 0.03), point(j('hand'), 0.016, [out * 0.08, -0.025, 0])),
    capsule(point(j('hip'), 0.085), point(j('knee'), 0.052)),
    capsule(point(j('knee'), 0.055), point(j('ankle'), 0.036)),
    capsule(point(j('ankle'), 0.04), point(j('foot'), 0.04)),
    capsule(point(j('foot'), 0.036), point(j('foot'), 0.026, [out * 0.015, 0, 0.055])),
  ];
};

/** The body's stretches. */
export const CAPSULES: readonly Capsule[] = [
  capsule(point('left_hip', 0.1), point('right_hip', 0.1), jointIndex('pelvis')),
  capsule(point('spine1', 0.1), point('spine2', 0.1)),
  capsule(point('spine2', 0.11), point('spine3', 0.12)),
  capsule(point('spine3', 0.12), point('spine3', 0.09, [0, 0.13, 0])),
  capsule(point('neck', 0.055), point('head', 0.055)),
  capsule(point('head', 0.07, [0, 0.03, 0.03]), point('head', 0.09, [0, 0.1, 0])),
  ...sideCapsules('left'),
  ...sideCapsules('right'),
];

/** A point of the sole, given where it lies in the rest pose, moving with a joint. */
function sole(joint: string, x: number, z: number): BodyPoint {
  const at = jointIndex(joint) * 3;
  return { joint: jointIndex(joint), offset: [x - REST[at], -REST[at + 1], z - REST[at + 2]], radius: 0 };
}

/** Rest x and z of the soles' corners, left foot: heel, heel's outer side, ball inside and outside, tip of the toes. */
const SOLE: readonly (readonly ['ankle' | 'foot', number, number])[] = [
  ['ankle', 0.08, -0.11],
  ['ankle', 0.06, -0.05],
  ['ankle', 0.12, -0.06],
  ['foot', 0.078, 0.085],
  ['foot', 0.162, 0.068],
  ['foot', 0.14, 0.155],
];

/** Points that decide how low the body reaches. */
export const SUPPORTS: readonly BodyPoint[] = [
  ...SOLE.flatMap(([joint, x, z]) => [sole(`left_${joint}`, x, z), sole(`right_${joint}`, -x, z)]),
  // Whatever else may touch the floor: knees, hands, elbows, seat, head; the feet are the soles above.
  ...CAPSULES.filter(
    ({ joint }) => !['left_ankle', 'right_ankle', 'left_foot', 'right_foot'].map(jointIndex).includes(joint),
  )
    .flatMap(({ from, to }) => [from, to])
    .filter(({ joint }) => !['left_ankle', 'right_ankle'].map(jointIndex).includes(joint)),
];

/** World position of a body point. */
export function placePoint(body: BodyPoint, joints: Numbers, rotations: Numbers, out: number[] = [0, 0, 0]): number[] {
  const at = body.joint;
  rotateVector(
    [0, 1, 2, 3].map((i) => rotations[at * 4 + i]),
    body.offset,
    out,
  );
  for (let i = 0; i < 3; i++) out[i] += joints[at * 3 + i];
  return out;
}

const joints = new Float32Array(JOINT_COUNT * 3);
const rotations = new Float32Array(JOINT_COUNT * 4);

/**
 * Pelvis position that puts a pose on the floor at the centre of the stage.
 * @param quaternions 24 x 4 local rotations
 * @returns x, y, z in metres; the body's lowest point is at y = 0
 */
export function standingRoot(quaternions: Numbers): [number, number, number] {
  forwardKinematics(quaternions, [0, 0, 0], joints);
  worldRotations(quaternions, rotations);
  let lowest = Infinity;
  const p = [0, 0, 0];
  for (const support of SUPPORTS)
    lowest = Math.min(lowest, placePoint(support, joints, rotations, p)[1] - support.radius);
  return [0, -lowest, 0];
}

/**
 * Distance along a ray to a capsule, or undefined when it passes by.
 * @param direction unit vector
 */
export function rayCapsule(
  origin: Numbers,
  direction: Numbers,
  a: Numbers,
  b: Numbers,
  radius: number,
): number | undefined {
  // The closest approach of ray and axis decides; stepping back from it by the missing half chord gives the near side.
  const ab = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const ao = [origin[0] - a[0], origin[1] - a[1], origin[2] - a[2]];
  const dot = (u: number[], v: Numbers) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const [abab, abd, abo, od] = [dot(ab, ab), dot(ab, direction), dot(ab, ao), dot(ao, direction)];
  const determinant = abab - abd * abd;
  let along = determinant > 1e-9 ? (abo - abd * od) / determinant : 0;
  along = Math.min(Math.max(along, 0), 1);
  const t = abd * along - od;
  const gap = [0, 1, 2].map((i) => ao[i] + t * direction[i] - along * ab[i]);
  const distance2 = dot(gap, gap);
  if (t < 0 || distance2 > radius * radius) return undefined;
  return Math.max(0, t - Math.sqrt(radius * radius - distance2));
}

/** Joint whose stretch of the body a ray meets first, or null. */
export function pickBody(
  origin: Numbers,
  direction: Numbers,
  jointPositions: Numbers,
  jointRotations: Numbers,
): number | null {
  let best: { joint: number; distance: number } | null = null;
  for (const { joint, from, to } of CAPSULES) {
    const a = placePoint(from, jointPositions, jointRotations);
    const b = placePoint(to, jointPositions, jointRotations);
    const distance = rayCapsule(origin, direction, a, b, (from.radius + to.radius) / 2 + 0.006);
    if (distance !== undefined && (!best || distance < best.distance)) best = { joint, distance };
  }
  return best?.joint ?? null;
}
