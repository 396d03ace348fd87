/** Where a dance's body is relative to its pelvis, and how high the pelvis must be for nothing to be below the floor. */
import { rotateVector } from './rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex } from './skeleton';
import { spec } from './spec';
import type { Motion } from './types';

const POSE = JOINT_COUNT * 4;
const { feet, toeHeight } = spec.skeleton;

/** The four points that carry weight: ball and heel of each foot. */
export const SOLES = [
  { foot: 0, heel: false },
  { foot: 0, heel: true },
  { foot: 1, heel: false },
  { foot: 1, heel: true },
] as const;
const FEET = [feet.left, feet.right];
/** From the ankle, in the foot's axes, metres: level with the toe joint in the rest pose. */
export const HEEL_OFFSET = [0, -0.06, -0.04];

/** Flesh around joints that may touch the floor in kneeling, lying and hand-stand poses, metres. */
export const RADIUS = new Map(
  Object.entries({
    pelvis: 0.1,
    spine2: 0.1,
    head: 0.1,
    left_knee: 0.05,
    right_knee: 0.05,
    left_elbow: 0.04,
    right_elbow: 0.04,
    left_shoulder: 0.05,
    right_shoulder: 0.05,
    left_hand: 0.02,
    right_hand: 0.02,
  }).map(([name, radius]) => [jointIndex(name), radius]),
);

/** Positions relative to the pelvis for a stretch of frames. */
export interface BodyTrack {
  frames: number;
  /** frames x 4 soles x 3, metres, order of SOLES. */
  soles: Float64Array;
  /** Lowest pelvis height that keeps every point on or above the floor, metres. */
  ground: Float64Array;
}

const joints = new Float32Array(JOINT_COUNT * 3);
const turns = new Float32Array(JOINT_COUNT * 4);
const ORIGIN = [0, 0, 0];

/** Soles and floor height of one frame, written into a track. */
function trackFrame(quaternions: Float32Array, track: BodyTrack, index: number): void {
  forwardKinematics(quaternions, ORIGIN, joints, turns);
  let ground = 0;
  SOLES.forEach(({ foot, heel }, sole) => {
    const { ankle, toe } = FEET[foot];
    const at = (index * SOLES.length + sole) * 3;
    const joint = (heel ? ankle : toe) * 3;
    const offset = heel ? rotateVector(turns.subarray(ankle * 4, ankle * 4 + 4), HEEL_OFFSET) : ORIGIN;
    for (let k = 0; k < 3; k++) track.soles[at + k] = joints[joint + k] + offset[k];
    ground = Math.max(ground, toeHeight - track.soles[at + 1]);
  });
  for (const [joint, radius] of RADIUS) ground = Math.max(ground, radius - joints[joint * 3 + 1]);
  track.ground[index] = ground;
}

/** Tracks frames [from, to) of a dance. */
export function bodyTrack(motion: Motion, from = 0, to = motion.frames): BodyTrack {
  const frames = to - from;
  const track = { frames, soles: new Float64Array(frames * SOLES.length * 3), ground: new Float64Array(frames) };
  for (let t = from; t < to; t++) trackFrame(motion.quaternions.subarray(t * POSE, t * POSE + POSE), track, t - from);
  return track;
}
