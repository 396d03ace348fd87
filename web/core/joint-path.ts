/**
 * The way of one joint through time: what an animator sees of a dance before it is played. Everything is worked out when it is asked for,
 * and once only, so that scrubbing through a long song costs a frame's worth of work per frame.
 */
import { correctToKeys, keysOnFrames } from './correction';
import { emptyMotion, sliceMotion } from './motion';
import { slerp } from './rotation';
import { JOINT_COUNT, OFFSETS, PARENTS } from './skeleton';
import type { KeyPose, Motion } from './types';

const POSE = JOINT_COUNT * 4;

/** The joints from the pelvis down to `joint`, both included. */
export function jointChain(joint: number): number[] {
  const chain: number[] = [];
  for (let each = joint; each >= 0; each = PARENTS[each]) chain.unshift(each);
  return chain;
}

/**
 * World position of the last joint of a chain in one frame, metres: `forwardKinematics` for that chain alone, without garbage.
 * @param chain from {@link jointChain}
 * @param out receives x, y, z from `at` on
 */
export function chainPosition(
  motion: Motion,
  frame: number,
  chain: readonly number[],
  out: Float32Array,
  at = 0,
): void {
  const { quaternions, root } = motion;
  let [x, y, z, w] = [0, 0, 0, 1];
  let px = root[frame * 3];
  let py = root[frame * 3 + 1];
  let pz = root[frame * 3 + 2];
  for (let link = 0; link < chain.length; link++) {
    const joint = chain[link];
    if (link > 0) {
      const offset = OFFSETS[joint];
      const tx = 2 * (y * offset[2] - z * offset[1]);
      const ty = 2 * (z * offset[0] - x * offset[2]);
      const tz = 2 * (x * offset[1] - y * offset[0]);
      px += offset[0] + w * tx + y * tz - z * ty;
      py += offset[1] + w * ty + z * tx - x * tz;
      pz += offset[2] + w * tz + x * ty - y * tx;
    }
    const i = frame * POSE + joint * 4;
    const bx = quaternions[i];
    const by = quaternions[i + 1];
    const bz = quaternions[i + 2];
    const bw = quaternions[i + 3];
    const nx = w * bx + x * bw + y * bz - z * by;
    const ny = w * by - x * bz + y * bw + z * bx;
    const nz = w * bz + x * by - y * bx + z * bw;
    w = w * bw - x * bx - y * by - z * bz;
    x = nx;
    y = ny;
    z = nz;
  }
  out[at] = px;
  out[at + 1] = py;
  out[at + 2] = pz;
}

/** Positions of one joint over a dance, each frame computed when it is first asked for. */
export class JointPath {
  /** Frames x 3, metres; only what `ensure` was called for holds something. */
  readonly points: Float32Array;
  private readonly known: Uint8Array;
  private readonly chain: readonly number[];

  /** @param joint index of the joint */
  constructor(
    readonly motion: Motion,
    readonly joint: number,
  ) {
    this.chain = jointChain(joint);
    this.points = new Float32Array(motion.frames * 3);
    this.known = new Uint8Array(motion.frames);
  }

  /**
   * Makes sure that frames [from, to) are there; both are clamped to the dance.
   * @returns how many had to be computed
   */
  ensure(from: number, to: number): number {
    let fresh = 0;
    const end = Math.min(to, this.motion.frames);
    for (let frame = Math.max(0, from); frame < end; frame++) {
      if (this.known[frame]) continue;
      chainPosition(this.motion, frame, this.chain, this.points, frame * 3);
      this.known[frame] = 1;
      fresh++;
    }
    return fresh;
  }
}

/** A stretch of a dance: frame 0 of `motion` is frame `first` of the song. */
export interface Stretch {
  motion: Motion;
  first: number;
}

/**
 * What a dance will do once it passes through other key poses: the stretch around a time, corrected like a finished dance.
 * @param keyPoses as they will be; only those inside the stretch count
 * @param seconds middle of the stretch
 * @param reach seconds on either side
 */
export function danceThrough(motion: Motion, keyPoses: readonly KeyPose[], seconds: number, reach: number): Stretch {
  const first = Math.max(0, Math.round((seconds - reach) * motion.fps));
  const stretch = sliceMotion(motion, first, Math.round((seconds + reach) * motion.fps) + 1);
  const moved = keyPoses.map((key) => ({ ...key, time: key.time - first / motion.fps }));
  correctToKeys(stretch, keysOnFrames(moved, motion.fps, stretch.frames), 1);
  return { motion: stretch, first };
}

/**
 * The plainest way through key poses, SLERP from each to the next, where there is no dance yet. Nothing before the first and after the last.
 * @param keyPoses in any order
 * @param rootOf pelvis position of a pose (24 x 4), metres
 * @param seconds middle of the stretch
 * @param reach seconds on either side
 * @returns null with fewer than two key poses in reach
 */
export function slerpThrough(
  keyPoses: readonly KeyPose[],
  fps: number,
  rootOf: (quaternions: Float32Array) => ArrayLike<number>,
  seconds: number,
  reach: number,
): Stretch | null {
  const keys = keysOnFrames(keyPoses, fps, Infinity);
  if (keys.length < 2) return null;
  const roots = keys.map((key) => rootOf(key.quaternions));
  const first = Math.max(keys[0].frame, Math.round((seconds - reach) * fps));
  const last = Math.min(keys[keys.length - 1].frame, Math.round((seconds + reach) * fps));
  if (last <= first) return null;
  const motion = emptyMotion(last - first + 1);
  motion.fps = fps;
  let next = 1;
  for (let frame = first; frame <= last; frame++) {
    while (next < keys.length - 1 && keys[next].frame < frame) next++;
    const [a, b] = [keys[next - 1], keys[next]];
    const t = (frame - a.frame) / (b.frame - a.frame);
    const at = frame - first;
    for (let i = 0; i < POSE; i += 4) {
      const target = motion.quaternions.subarray(at * POSE + i, at * POSE + i + 4);
      slerp(a.quaternions.subarray(i, i + 4), b.quaternions.subarray(i, i + 4), t, target);
    }
    for (let k = 0; k < 3; k++) motion.root[at * 3 + k] = (1 - t) * roots[next - 1][k] + t * roots[next][k];
  }
  return { motion, first };
}

/** The key poses just before and just after a time; one on the time itself (to half a frame) is neither. */
export function neighbouringKeys(
  keyPoses: readonly KeyPose[],
  seconds: number,
  fps: number,
): { before: KeyPose | null; after: KeyPose | null } {
  const margin = 0.5 / fps;
  let before: KeyPose | null = null;
  let after: KeyPose | null = null;
  for (const key of keyPoses) {
    if (key.time < seconds - margin && (!before || key.time > before.time)) before = key;
    else if (key.time > seconds + margin && (!after || key.time < after.time)) after = key;
  }
  return { before, after };
}
