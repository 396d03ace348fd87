/**
 * The ranges of motion of the skeleton's joints.
 *
 * Normal ranges: AAOS (1965) "Joint Motion: Method of Measuring and Recording"; Boone & Azen (1979), J Bone Joint Surg 61-A:756;
 * Soucie et al. (2011), Haemophilia 17:500 (the CDC's reference values); Youdas et al. (1992), Mayo Clin Proc 67:339 (neck);
 * Ludewig et al. (2009), J Bone Joint Surg 91-A:378 (collarbone); Bennell et al. (1998), Aust J Physiother 44:175 (ankle under load).
 * Where dancers go beyond the clinic's adult the limit is wider than the norm, and the joint's note says so.
 */
import { JOINTS, MIRROR } from './skeleton';

/** 0 = X, 1 = Y, 2 = Z. */
export type Axis = 0 | 1 | 2;
/** Two numbers, degrees. */
export type Point = readonly [number, number];

/** The range of motion of one joint, degrees, in the joint's own rest axes (T-pose, Y up, facing +Z, left = +X). */
export interface JointLimit {
  /** Axis of the bone, about which it twists: 0 = X, 1 = Y, 2 = Z. */
  readonly axis: Axis;
  /** Corners of the convex region of the swing, counter-clockwise, over the two other axes in ascending order. */
  readonly swing: readonly Point[];
  /** Least and greatest twist. */
  readonly twist: Point;
  /** Normal range and where it is published. */
  readonly source: string;
}

export const [X, Y, Z] = [0, 1, 2] as const;

/** A region that reaches so far to either side of its two axes, without using one to the full together with the other. */
function oval(a: Point, b: Point, corners = 16): Point[] {
  return Array.from({ length: corners }, (_, i) => {
    const [c, s] = [Math.cos((2 * Math.PI * i) / corners), Math.sin((2 * Math.PI * i) / corners)];
    return [c * (c < 0 ? -a[0] : a[1]), s * (s < 0 ? -b[0] : b[1])] as const;
  });
}

/** A region for a hinge: what happens across it does not depend on how far it is bent. */
function hinge(a: Point, b: Point): Point[] {
  return [
    [a[0], b[0]],
    [a[1], b[0]],
    [a[1], b[1]],
    [a[0], b[1]],
  ];
}

/** Joints of the middle and of the left side; the right side is their mirror image. */
const TABLE: Readonly<Record<string, JointLimit>> = {
  left_hip: {
    axis: Y,
    // X: flexion is negative; Z: abduction is positive.
    swing: [
      [-150, -20],
      [-110, -40],
      [15, -45],
      [66, -25],
      [66, 20],
      [40, 75],
      [-15, 115],
      [-90, 110],
      [-140, 60],
      [-150, 30],
    ],
    twist: [-55, 90],
    source:
      'Flexion 120, extension 30, abduction 45, adduction 30, rotation 45 in and out (AAOS; Boone & Azen 122/10/46/27/47/47). High kicks, side extensions, splits and turn-out of dancers go further, with the pelvis helping.',
  },
  left_knee: {
    axis: Y,
    swing: hinge([-10, 158], [-10, 10]),
    twist: [-30, 40],
    source:
      'Flexion 135 (AAOS), 142 (Boone & Azen; Soucie 138-142), more when sitting on the heels; a few degrees beyond straight; the shin turns by some 30 when bent.',
  },
  left_ankle: {
    axis: Y,
    // X: toes up is negative; Z: sole inwards is negative.
    swing: oval([-40, 88], [-40, 28]),
    twist: [-32, 30],
    source:
      'Toes up 20, pointed 50, sole in 35, out 15 (AAOS); about 40 of toes up under load (Bennell et al.); pointed feet of dancers reach 85 and more.',
  },
  left_foot: {
    axis: Z,
    swing: oval([-85, 45], [-25, 20]),
    twist: [-20, 20],
    source: 'Ball of the foot: up 70, down 45 (AAOS); demi-pointe needs 80 and more.',
  },
  spine1: {
    axis: Y,
    // X: bending forwards is positive.
    swing: oval([-28, 45], [-22, 22]),
    twist: [-15, 15],
    source:
      'Trunk together: forwards 80, back 25, sideways 35, rotation 45 (AAOS). Lower back: most of the bending, little of the turning. Back bends of dancers are wider.',
  },
  spine2: { axis: Y, swing: oval([-26, 32], [-20, 20]), twist: [-20, 20], source: 'Trunk (AAOS), shared out: waist.' },
  spine3: { axis: Y, swing: oval([-30, 30], [-18, 18]), twist: [-20, 20], source: 'Trunk (AAOS), shared out: chest.' },
  neck: {
    axis: Y,
    swing: oval([-38, 32], [-26, 26]),
    twist: [-42, 42],
    source:
      'Forwards, back and sideways 45, rotation 60 (AAOS); 72 back and 72 rotation in young adults (Youdas et al.); about half below the head.',
  },
  head: {
    axis: Y,
    swing: oval([-36, 32], [-24, 24]),
    twist: [-42, 42],
    source: 'The other half of the neck (AAOS; Youdas et al.).',
  },
  left_collar: {
    axis: X,
    // Y: forwards is negative; Z: up is positive.
    swing: oval([-35, 32], [-18, 45]),
    twist: [-32, 32],
    source: 'Up 40, down 10, forwards and back 25-30, and about 30 about its own length (Ludewig et al.).',
  },
  left_shoulder: {
    axis: X,
    // Y: forwards is negative; Z: up is positive. Hanging down is Z = -90.
    swing: [
      [62, 0],
      [45, 45],
      [20, 100],
      [-40, 120],
      [-105, 105],
      [-140, 45],
      [-142, -40],
      [-100, -108],
      [-20, -122],
      [50, -98],
      [80, -50],
    ],
    twist: [-112, 98],
    source:
      'Raised 180 to the front and side, back 60, across the chest 135, out at the back 45, rotation 70 in and 90 out (AAOS; Boone & Azen 167/62/184/69/104), from arms held out to the side.',
  },
  left_elbow: {
    axis: X,
    swing: hinge([-158, 10], [-15, 20]),
    // The rest pose has the palm down, which is the forearm turned in: nearly all of its turn is outwards.
    twist: [-145, 38],
    source:
      'Flexion 150 (AAOS; Soucie 145-150), straight 0-10; forearm 80 in and 80 out (AAOS; Soucie 77-82 and 85-90).',
  },
  left_wrist: {
    axis: X,
    swing: oval([-30, 38], [-82, 80]),
    twist: [-40, 40],
    source:
      'Down 80, up 70, to the thumb 20, to the little finger 30 (AAOS); the twist is the forearm’s, seen at the wrist.',
  },
  left_hand: {
    axis: X,
    swing: oval([-28, 25], [-95, 45]),
    twist: [-30, 30],
    source: 'Knuckles: bent 90, stretched 45 (AAOS).',
  },
};

/** The other two axes, ascending. */
export const ACROSS: readonly (readonly [Axis, Axis])[] = [
  [Y, Z],
  [X, Z],
  [X, Y],
];

/** The same limit on the other side of the body: turns about Y and Z change their sign. */
function mirrored({ axis, swing, twist, source }: JointLimit): JointLimit {
  const [a, b] = ACROSS[axis].map((across) => (across === X ? 1 : -1));
  const corners = swing.map(([u, v]) => [a * u, b * v] as const);
  return {
    axis,
    // One reversed axis turns the corners' order round.
    swing: a * b < 0 ? corners.reverse() : corners,
    twist: axis === X ? twist : [-twist[1], -twist[0]],
    source,
  };
}

/** Range of motion of each joint, in the skeleton's order; null for the pelvis, which turns the whole body. */
export const JOINT_LIMITS: readonly (JointLimit | null)[] = JOINTS.map((name, joint) =>
  name in TABLE ? TABLE[name] : name.startsWith('right_') ? mirrored(TABLE[JOINTS[MIRROR[joint]]]) : null,
);
