/** Skin weights of a point of the rest pose: smooth functions of where it lies along the trunk, an arm or a leg. */
import { jointIndex } from '../../core/skeleton';
import { REST } from '../rest';
import { MIRRORED_BONES, skinBone } from '../skin-bones';

/** Weight per skin bone; at most four, adding up to 1. */
export type Weights = [bone: number, weight: number][];

const at = (name: string, axis: 0 | 1 | 2) => REST[jointIndex(name) * 3 + axis];
const shoulderX = at('left_shoulder', 0);
const elbowX = at('left_elbow', 0);
const wristX = at('left_wrist', 0);
const handX = at('left_hand', 0);
const hip = [at('left_hip', 0), at('left_hip', 1)];
const kneeDown = hip[1] - at('left_knee', 1);
const ankleDown = hip[1] - at('left_ankle', 1);
const ankle = [at('left_ankle', 0), at('left_ankle', 1), at('left_ankle', 2)];
const toe = [at('left_foot', 0), 0, at('left_foot', 2)];

type Chain = readonly (readonly [bone: number, position: number])[];

/** Bone -1 stands for "the trunk, whichever of its bones is here". */
const ARM: Chain = [
  [-1, 0.045],
  [skinBone('left_collar'), shoulderX - 0.04],
  [skinBone('left_shoulder1'), shoulderX + 0.004],
  [skinBone('left_shoulder2'), shoulderX + 0.038],
  [skinBone('left_upper1'), shoulderX + 0.076],
  [skinBone('left_upper2'), shoulderX + 0.135],
  [skinBone('left_upper3'), elbowX - 0.05],
  [skinBone('left_elbow1'), elbowX - 0.014],
  [skinBone('left_elbow2'), elbowX + 0.014],
  [skinBone('left_lower1'), elbowX + 0.05],
  [skinBone('left_lower2'), elbowX + 0.13],
  [skinBone('left_lower3'), wristX - 0.05],
  [skinBone('left_wrist'), wristX - 0.004],
  [skinBone('left_palm'), wristX + 0.03],
  [skinBone('left_palm'), handX - 0.012],
  [skinBone('left_fingers'), handX + 0.022],
];

/** Positions are metres below the hip joint. */
const LEG: Chain = [
  [-1, -0.07],
  [skinBone('left_hip1'), -0.022],
  [skinBone('left_hip2'), 0.028],
  [skinBone('left_thigh1'), 0.085],
  [skinBone('left_thigh2'), kneeDown - 0.075],
  [skinBone('left_knee1'), kneeDown - 0.02],
  [skinBone('left_knee2'), kneeDown + 0.02],
  [skinBone('left_shin1'), kneeDown + 0.075],
  [skinBone('left_shin2'), ankleDown - 0.075],
  [skinBone('left_ankle'), ankleDown - 0.012],
  [skinBone('left_sole'), ankleDown + 0.024],
];

const SPINE: Chain = [
  [skinBone('pelvis'), at('spine1', 1) - 0.07],
  [skinBone('spine1'), (at('spine1', 1) + at('spine2', 1)) / 2],
  [skinBone('spine2'), (at('spine2', 1) + at('spine3', 1)) / 2],
  [skinBone('spine3'), at('spine3', 1) + 0.05],
  [skinBone('spine3'), at('neck', 1) - 0.045],
  [skinBone('neck'), at('neck', 1) + 0.03],
  [skinBone('head'), at('head', 1) + 0.03],
];

/**
 * Weights of a rest-pose point of the middle or the left side (x >= 0).
 * @param part a head moves as one with the head bone above the neck, whatever lies beside it
 */
export function weightsAt(part: string, x: number, y: number, z: number): Weights {
  const sums = new Map<number, number>();
  const add = (bone: number, weight: number) => {
    if (weight > 0) sums.set(bone, (sums.get(bone) ?? 0) + weight);
  };
  // The chin is lower than the nape: heights on the neck are measured along a plane that falls to the front.
  const neckward = part === 'body' ? 0.25 : 0.62;
  const spine = part === 'visor' ? at('head', 1) + 0.1 : y + neckward * smooth(1.46, 1.54, y) * (z - at('neck', 2));
  const trunk = (share: number) => along(SPINE, spine).forEach(([bone, w]) => add(bone, w * share));

  const leg = part === 'shoe' ? 1 : y < 1.06 && x < 0.3 && part === 'body' ? 1 : 0;
  const arm = part === 'glove' || (part === 'body' && y > 1.06) ? 1 : 0;
  if (leg) {
    for (const [bone, weight] of along(LEG, legPosition(part, x, y, z))) {
      if (bone < 0) trunk(weight);
      else {
        // Between the legs the skin belongs to both.
        const left = smooth(-0.04, 0.04, x);
        const toes = bone === skinBone('left_sole') && part === 'shoe' ? toeShare(x, z) : 0;
        add(bone, weight * left * (1 - toes));
        add(skinBone('left_toes'), weight * left * toes);
        add(MIRRORED_BONES[bone], weight * (1 - left));
      }
    }
  } else if (arm) {
    // Below the armpit the flank belongs to the trunk.
    const flank = Math.max(0, 1.385 - y);
    const position = part === 'glove' ? x : x - 0.95 * flank;
    for (const [bone, weight] of along(ARM, position)) {
      if (bone < 0) trunk(weight);
      else add(bone, weight);
    }
  } else trunk(1);

  const largest = [...sums].sort((a, b) => b[1] - a[1]).slice(0, 4);
  const total = largest.reduce((sum, [, weight]) => sum + weight, 0);
  return largest.map(([bone, weight]) => [bone, weight / total]);
}

function legPosition(part: string, x: number, y: number, z: number): number {
  const down = hip[1] - y;
  if (part === 'shoe') {
    const forward = footward(x, z);
    // The instep turns with the foot, the cuff at the same height behind it with the shin.
    return down + 0.55 * Math.max(0, forward - 0.02) + 0.3 * Math.max(0, -0.03 - forward);
  }
  // The bend of a hip runs along the groin: from the crotch upwards to the outside; the seat stays with the pelvis a little longer.
  const groin = 0.5 * (x - hip[0]) * smooth(0.22, 0.0, down);
  const seat = 0.35 * Math.min(0, z + 0.02) * smooth(0.2, 0.0, down);
  return down + groin + seat;
}

/** Metres in front of the ankle along the foot. */
function footward(x: number, z: number): number {
  const d = [toe[0] - ankle[0], toe[2] - ankle[2]];
  return ((x - ankle[0]) * d[0] + (z - ankle[2]) * d[1]) / Math.hypot(d[0], d[1]);
}

function toeShare(x: number, z: number): number {
  const ball = Math.hypot(toe[0] - ankle[0], toe[2] - ankle[2]);
  return smooth(ball - 0.024, ball + 0.028, footward(x, z));
}

/** Partition of unity along a chain: each bone is full at its position and fades to nothing at its neighbours'. */
function along(chain: Chain, position: number): Weights {
  if (position <= chain[0][1]) return [[chain[0][0], 1]];
  for (let i = 1; i < chain.length; i++) {
    const [from, to] = [chain[i - 1][1], chain[i][1]];
    if (position > to) continue;
    const t = (position - from) / (to - from);
    const share = 0.5 * t + 0.5 * t * t * (3 - 2 * t);
    return [
      [chain[i - 1][0], 1 - share],
      [chain[i][0], share],
    ];
  }
  return [[chain[chain.length - 1][0], 1]];
}

function smooth(from: number, to: number, value: number): number {
  const t = Math.min(Math.max((value - from) / (to - from), 0), 1);
  return t * t * (3 - 2 * t);
}
