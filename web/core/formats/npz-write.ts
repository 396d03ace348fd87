/**
 * SMPL motions as npz, for both houses at once, each under its own names:
 * - AIST++ (Li et al. 2021): `smpl_poses` [N, 72], `smpl_trans` [N, 3], `smpl_scaling` [1]; Y up.
 * - AMASS (Mahmood et al. 2019): `poses` [N, 156] (22 joints of the body, then 30 of the hands, which are zero), `trans` [N, 3], `betas`
 *   [16], `gender`, `mocap_framerate`; Z up.
 *
 * `posebeat` is a text of JSON: where the dance comes from (`motion-origin.ts`), if that is known.
 *
 * Both translations are the pelvis's place, metres. A SMPL body whose pelvis is not at its own origin stands off by that offset.
 */
import { zipSync } from 'fflate';
import { motionToAxisAngle } from '../motion';
import { multiply, quaternionToAxisAngle } from '../rotation';
import { JOINT_COUNT } from '../skeleton';
import type { Motion } from '../types';
import type { MotionOrigin } from './motion-origin';
import { writeNpy, type NpyValue } from './npy-write';

/** Joints that SMPL and SMPL-H share. */
const BODY = 22;
/** Numbers of SMPL-H: 52 joints. */
const SMPLH = 156;
/** A quarter turn about X: +Y becomes +Z, and +Z (where the figure faces) becomes -Y. */
const UPRIGHT = [Math.SQRT1_2, 0, 0, Math.SQRT1_2];
/** The same dance is the same file: zip's first day instead of today. */
const DAY = new Date(1980, 0, 1);

/** The arrays of the file by name. */
export function smplArrays(motion: Motion, origin?: MotionOrigin): Record<string, NpyValue> {
  const { frames, fps, root, quaternions } = motion;
  if (frames < 1) throw new Error('The dance has no frames yet: generate it first.');
  const flat = motionToAxisAngle(motion);
  const poses = new Float32Array(frames * SMPLH);
  const trans = new Float32Array(frames * 3);
  for (let frame = 0; frame < frames; frame++) {
    const from = frame * JOINT_COUNT * 3;
    poses.set(flat.subarray(from, from + BODY * 3), frame * SMPLH);
    const world = quaternions.subarray(frame * JOINT_COUNT * 4, frame * JOINT_COUNT * 4 + 4);
    poses.set(quaternionToAxisAngle(multiply(UPRIGHT, world)), frame * SMPLH);
    trans.set([root[frame * 3], -root[frame * 3 + 2], root[frame * 3 + 1]], frame * 3);
  }
  return {
    smpl_poses: { shape: [frames, JOINT_COUNT * 3], data: flat },
    smpl_trans: { shape: [frames, 3], data: root },
    smpl_scaling: { shape: [1], data: Float32Array.of(1) },
    poses: { shape: [frames, SMPLH], data: poses },
    trans: { shape: [frames, 3], data: trans },
    betas: { shape: [16], data: new Float64Array(16) },
    gender: 'neutral',
    mocap_framerate: { shape: [], data: Float64Array.of(fps) },
    ...(origin ? { posebeat: JSON.stringify(origin) } : {}),
  };
}

/**
 * Writes an npz file at the dance's own frame rate. AIST++'s own tools take 60 frames per second for granted.
 * @throws Error when the dance has no frames
 */
export function writeNpz(motion: Motion, origin?: MotionOrigin): Uint8Array<ArrayBuffer> {
  const files = Object.entries(smplArrays(motion, origin)).map(([name, value]) => [`${name}.npy`, writeNpy(value)]);
  return zipSync(Object.fromEntries(files), { level: 6, mtime: DAY }) as Uint8Array<ArrayBuffer>;
}
