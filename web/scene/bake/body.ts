/**
 * The figure's shape in the rest T-pose, left side and middle; the right side is its mirror image.
 * Limbs hang on the joints of spec.json; the other numbers are sizes in metres chosen by eye.
 */
import { REST } from '../rest';
import { below, blend, both, common, ellipsoid, grow, limb, loft, type Shape, type Vector } from './sdf';
import { jointIndex } from '../../core/skeleton';

/** A closed part of the figure with the box and grid cell that its mesh is made with. */
export interface Part {
  name: 'body' | 'head' | 'visor' | 'glove' | 'shoe';
  shape: Shape;
  low: Vector;
  high: Vector;
  /** For each level of detail, finest first, metres. */
  cells: readonly number[];
  /** True for a part that the mirror plane cuts; else the part is a left one. */
  symmetric: boolean;
}

function joint(name: string): Vector {
  const at = jointIndex(name) * 3;
  return [REST[at], REST[at + 1], REST[at + 2]];
}

const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

const [hip, knee, ankle, toe] = ['left_hip', 'left_knee', 'left_ankle', 'left_foot'].map(joint);
const [shoulder, elbow, wrist, hand] = ['left_shoulder', 'left_elbow', 'left_wrist', 'left_hand'].map(joint);
const [pelvis, neck, head] = ['pelvis', 'neck', 'head'].map(joint);

function torso(): Shape {
  const bottom: Vector = [0, pelvis[1] - 0.1, -0.012];
  const top: Vector = [0, neck[1] - 0.02, -0.012];
  // Side axis x: u is the half-width, v points backwards (y cross x = -z), so a positive dv shifts a section to the back.
  const trunk = loft(
    bottom,
    top,
    [1, 0, 0],
    [
      { t: 0.0, u: 0.112, v: 0.086, dv: 0.004 },
      { t: 0.13, u: 0.138, v: 0.1, dv: 0.006 },
      { t: 0.26, u: 0.137, v: 0.095, dv: 0.003 },
      { t: 0.43, u: 0.115, v: 0.08, dv: -0.003 },
      { t: 0.6, u: 0.122, v: 0.088, dv: -0.004 },
      { t: 0.76, u: 0.138, v: 0.1, dv: 0.0 },
      { t: 0.88, u: 0.136, v: 0.092, dv: 0.01 },
      { t: 0.97, u: 0.112, v: 0.074, dv: 0.019 },
      { t: 1.04, u: 0.074, v: 0.056, dv: 0.025 },
    ],
    [0.06, 0.03],
    2.3,
  );
  const chest = both(ellipsoid([0.06, 1.345, 0.046], [0.08, 0.075, 0.034]), 0.07);
  const fold = both(limb([0.08, 1.335, 0.03], [0.203, 1.407, -0.014], 0.04, 0.039), 0.03);
  const seat = both(ellipsoid([0.064, hip[1] + 0.022, -0.056], [0.074, 0.084, 0.06]), 0.035);
  const trapezius = both(limb([0.014, 1.478, -0.048], [0.168, 1.436, -0.05], 0.027, 0.03), 0.04);
  const side = both(limb([0.088, 1.14, -0.02], [0.182, 1.392, -0.055], 0.024, 0.034), 0.02);
  const clavicle = both(limb([0.03, 1.432, -0.008], [0.17, 1.43, -0.035], 0.034, 0.033), 0.03);
  // The neck ends inside the head, so that the two meet in a clean line under the jaw.
  const throat = blend(
    0.03,
    limb([0, 1.43, -0.035], add(neck, [0, 0.03, 0.008]), 0.056, 0.048),
    limb(add(neck, [0, 0.03, 0.008]), add(head, [0, 0.03, -0.014]), 0.047, 0.046),
  );
  return blend(0.024, blend(0.045, trunk, chest, seat, blend(0.025, trapezius, clavicle, side, fold)), throat);
}

function arm(): Shape {
  const upper = loft(
    shoulder,
    elbow,
    [0, 1, 0],
    [
      { t: -0.06, u: 0.044, v: 0.046 },
      { t: 0.12, u: 0.0465, v: 0.05 },
      { t: 0.3, u: 0.0455, v: 0.048 },
      { t: 0.58, u: 0.04, v: 0.043 },
      { t: 0.85, u: 0.0345, v: 0.0365 },
      { t: 1.0, u: 0.033, v: 0.0355 },
    ],
    [0.05, 0.02],
  );
  const lower = loft(
    elbow,
    wrist,
    [0, 1, 0],
    [
      { t: 0.0, u: 0.033, v: 0.0355 },
      { t: 0.16, u: 0.0365, v: 0.04 },
      { t: 0.32, u: 0.0355, v: 0.0405 },
      { t: 0.6, u: 0.0285, v: 0.034 },
      { t: 0.85, u: 0.022, v: 0.0285 },
      { t: 1.0, u: 0.021, v: 0.028 },
    ],
    [0.02, 0.02],
  );
  return blend(0.008, upper, lower);
}

function leg(): Shape {
  // Side axis x: u is the half-width; v points forwards for a downward tube.
  const thigh = loft(
    hip,
    knee,
    [1, 0, 0],
    [
      { t: -0.06, u: 0.08, v: 0.086 },
      { t: 0.1, u: 0.079, v: 0.085, dv: 0.003 },
      { t: 0.35, u: 0.07, v: 0.078, dv: 0.008 },
      { t: 0.65, u: 0.056, v: 0.064, dv: 0.006 },
      { t: 0.88, u: 0.0465, v: 0.053, dv: 0.003 },
      { t: 1.0, u: 0.0435, v: 0.049, dv: 0.001 },
    ],
    [0.13, 0.03],
  );
  const shin = loft(
    knee,
    ankle,
    [1, 0, 0],
    [
      { t: 0.0, u: 0.043, v: 0.0485, dv: 0.001 },
      { t: 0.12, u: 0.043, v: 0.049, dv: -0.006 },
      { t: 0.28, u: 0.0475, v: 0.054, dv: -0.014 },
      { t: 0.48, u: 0.042, v: 0.0475, dv: -0.012 },
      { t: 0.72, u: 0.0305, v: 0.035, dv: -0.006 },
      { t: 0.9, u: 0.0265, v: 0.0315, dv: -0.001 },
      { t: 1.0, u: 0.027, v: 0.0325 },
    ],
    [0.03, 0.03],
  );
  const cap = ellipsoid(add(knee, [0, 0.004, 0.031]), [0.024, 0.034, 0.017]);
  return blend(0.03, blend(0.006, thigh, shin), cap);
}

function glove(): Shape {
  const along = (t: number): Vector => [
    wrist[0] + t * (hand[0] - wrist[0]),
    wrist[1] + t * (hand[1] - wrist[1]),
    wrist[2] + t * (hand[2] - wrist[2]),
  ];
  const palm = loft(
    wrist,
    hand,
    [0, 1, 0],
    [
      { t: -0.5, u: 0.019, v: 0.0255 },
      { t: -0.15, u: 0.0205, v: 0.028 },
      { t: 0.05, u: 0.021, v: 0.0305 },
      { t: 0.45, u: 0.019, v: 0.037 },
      { t: 0.85, u: 0.016, v: 0.041 },
      { t: 1.05, u: 0.013, v: 0.039 },
    ],
    [0.02, 0.012],
  );
  const knuckles = along(1.0);
  // Forward offset of the knuckle, spread at the tip, length: index, middle, ring, little finger; slightly bent, as in a relaxed hand.
  const fingers = [
    [0.0285, 0.034, 0.08],
    [0.0095, 0.0115, 0.088],
    [-0.0095, -0.0105, 0.082],
    [-0.0275, -0.032, 0.065],
  ].map(([z, tip, length]) => {
    const a = add(knuckles, [-0.004 - Math.abs(z) * 0.12, 0.001, z]);
    const b = add(knuckles, [length * 0.48, -0.008, (z + tip) / 2]);
    const c = add(knuckles, [length * 0.92, -0.03, tip]);
    return blend(0.008, limb(a, b, 0.0112, 0.0098), limb(b, c, 0.0098, 0.0082));
  });
  const thumb = blend(
    0.012,
    limb(add(along(0.15), [0, -0.004, 0.016]), add(along(0.62), [0, -0.016, 0.052]), 0.0165, 0.0128),
    limb(add(along(0.62), [0, -0.016, 0.052]), add(along(0.98), [0.004, -0.026, 0.064]), 0.0122, 0.0095),
  );
  const whole = blend(0.016, palm, blend(0.0045, fingers[0], fingers[1], fingers[2], fingers[3]), thumb);
  return whole;
}

function shoe(): Shape {
  const length = Math.hypot(toe[0] - ankle[0], toe[2] - ankle[2]);
  const d = [(toe[0] - ankle[0]) / length, (toe[2] - ankle[2]) / length];
  const point = (l: number, y: number): Vector => [ankle[0] + l * d[0], y, ankle[2] + l * d[1]];
  // Sections along the foot, [distance from the ankle, half-width, top height]; the sole plane cuts off their lower third.
  const sections = [
    [-0.048, 0.031, 0.07],
    [-0.01, 0.034, 0.085],
    [0.045, 0.037, 0.078],
    [0.09, 0.043, 0.06],
    [0.13, 0.0465, 0.049],
    [0.165, 0.041, 0.042],
    [0.185, 0.034, 0.037],
  ];
  const [low, high] = [-0.048, 0.185];
  const upper = loft(
    point(low, 0),
    point(high, 0),
    [0, 1, 0],
    sections.map(([l, width, top]) => ({ t: (l - low) / (high - low), u: top * 0.66, v: width, du: top * 0.34 })),
    [0.03, 0.026],
    2.3,
  );
  const cuff = loft(
    add(ankle, [0, 0.07, 0.004]),
    add(ankle, [0, -0.03, -0.002]),
    [1, 0, 0],
    [
      { t: 0, u: 0.0245, v: 0.029 },
      { t: 0.5, u: 0.0268, v: 0.0325 },
      { t: 1, u: 0.033, v: 0.04 },
    ],
    [0.02, 0.02],
  );
  return common(0.012, blend(0.035, upper, cuff), below([0, 0, 0], [0, -1, 0]));
}

function skull(): Shape {
  const at = (y: number, z: number): Vector => [0, head[1] + y, head[2] + z];
  const cranium = ellipsoid(at(0.1, -0.008), [0.0745, 0.089, 0.093]);
  const face = ellipsoid(at(0.055, 0.026), [0.059, 0.083, 0.067]);
  const chin = ellipsoid(at(-0.008, 0.062), [0.027, 0.021, 0.022]);
  return blend(0.04, cranium, face, chin);
}

function headShape(): Shape {
  // Round pods on the ears.
  const ears = both(ellipsoid([0.0715, head[1] + 0.074, head[2] - 0.012], [0.0125, 0.03, 0.03]), 0.01);
  return blend(0.005, skull(), ears);
}

/** A face shield: broad over the eyes, narrow at the chin, with a ridge down the middle that gives the face its profile. */
function visor(): Shape {
  const middle = head[1] + 0.06;
  const ridge = limb([0, head[1] + 0.098, head[2] + 0.07], [0, head[1] + 0.04, head[2] + 0.088], 0.01, 0.012);
  const plate = blend(0.03, grow(skull(), 0.003), ridge);
  const outline: Shape = (x, y) => {
    const v = (y - middle) / 0.066;
    const half = 0.0665 - 0.0155 * Math.max(0, 0.5 - 0.5 * v) ** 1.5 - 0.004 * v;
    return ((Math.abs(x / half) ** 2.6 + Math.abs(v) ** 3.2) ** (1 / 2.8) - 1) * 0.05;
  };
  const front: Shape = (_x, _y, z) => head[2] + 0.0 - z;
  return common(0.005, plate, outline, front);
}

const suit = (): Shape => {
  const half = arm();
  const arms: Shape = both(half, 0.02);
  const legs = both(leg(), 0.022);
  const cutWrist: Shape = (x) => Math.abs(x) - (wrist[0] - 0.02);
  const cutAnkle: Shape = (_x, y) => ankle[1] + 0.005 - y;
  return common(0.005, blend(0.035, torso(), arms, legs), cutWrist, cutAnkle);
};

/** Every part of the figure. */
export function figureParts(): Part[] {
  return [
    {
      name: 'body',
      shape: suit(),
      low: [0, 0.05, -0.2],
      high: [0.73, 1.67, 0.16],
      cells: [0.0125, 0.026],
      symmetric: true,
    },
    {
      name: 'head',
      shape: headShape(),
      low: [0, 1.4, -0.14],
      high: [0.12, 1.8, 0.17],
      cells: [0.0085, 0.015],
      symmetric: true,
    },
    {
      name: 'visor',
      shape: visor(),
      low: [0, 1.53, 0],
      high: [0.12, 1.74, 0.17],
      cells: [0.0052, 0.0095],
      symmetric: true,
    },
    {
      name: 'glove',
      shape: glove(),
      low: [0.64, 1.33, -0.16],
      high: [0.93, 1.48, 0.03],
      cells: [0.0056, 0.0105],
      symmetric: false,
    },
    {
      name: 'shoe',
      shape: shoe(),
      low: [0.02, -0.02, -0.15],
      high: [0.22, 0.17, 0.2],
      cells: [0.0078, 0.015],
      symmetric: false,
    },
  ];
}
