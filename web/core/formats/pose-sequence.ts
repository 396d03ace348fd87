/** Poses through time from an animation file, already on our skeleton; a key pose is one frame of them. */
import { multiply, quaternionsToPose, type Numbers } from '../rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../skeleton';

/** Numbers of one frame. */
const STRIDE = JOINT_COUNT * 4;
const UP = jointIndex('head');
const ANKLES = [jointIndex('left_ankle'), jointIndex('right_ankle')];

/** One animation of a file. */
export interface PoseSequence {
  /** The animation's name; empty where the file gives none. */
  name: string;
  /** Frames per second; 0 for a single pose. */
  fps: number;
  frames: number;
  /** Local rotations, frames x 24 x 4 (x y z w); joint 0 is the world orientation, Y up. */
  quaternions: Float32Array;
  /** Frames that the file points out, its key poses. */
  marks?: readonly number[];
}

/** What an animation file held. */
export interface PoseClips {
  kind: 'BVH' | 'SMPL' | 'glTF' | 'VRM' | 'Posebeat';
  /** At least one. */
  clips: PoseSequence[];
}

/** Longest animation that is read whole; of a longer one every second, third... frame is kept. */
export const MAX_FRAMES = 20_000;

/** Every how many frames one is kept, so that at most MAX_FRAMES remain. */
export function frameStep(frames: number): number {
  return Math.max(1, Math.ceil(frames / MAX_FRAMES));
}

/** A frame as 24 x 3 axis-angle. */
export function poseOfFrame({ quaternions }: PoseSequence, frame: number): number[] {
  return quaternionsToPose(quaternions.subarray(frame * STRIDE, (frame + 1) * STRIDE));
}

/** The mean direction from the ankles to the head over (at most 200) frames; shorter than 1 where it varies. */
export function meanUp({ frames, quaternions }: PoseSequence): [number, number, number] {
  const up: [number, number, number] = [0, 0, 0];
  const step = Math.max(1, Math.floor(frames / 200));
  let count = 0;
  for (let frame = 0; frame < frames; frame += step, count++) {
    const points = forwardKinematics(quaternions.subarray(frame * STRIDE, (frame + 1) * STRIDE), [0, 0, 0]);
    const d = [0, 1, 2].map((k) => points[UP * 3 + k] - (points[ANKLES[0] * 3 + k] + points[ANKLES[1] * 3 + k]) / 2);
    const length = Math.hypot(...d) || 1;
    for (let k = 0; k < 3; k++) up[k] += d[k] / length;
  }
  return [up[0] / count, up[1] / count, up[2] / count];
}

/** The coordinate axis that a direction lies on within `cosine`, signed; null where it lies between axes. */
export function axisOf(direction: Numbers, cosine: number): [number, number, number] | null {
  const length = Math.hypot(direction[0], direction[1], direction[2]);
  for (let k = 0; k < 3; k++) {
    if (!(Math.abs(direction[k]) > cosine * length)) continue;
    const axis: [number, number, number] = [0, 0, 0];
    axis[k] = Math.sign(direction[k]);
    return axis;
  }
  return null;
}

/** The smallest rotation that brings a unit direction onto another; about `spare` where they are opposite. */
export function arc(from: Numbers, to: Numbers, spare: Numbers = [1, 0, 0]): number[] {
  const dot = from[0] * to[0] + from[1] * to[1] + from[2] * to[2];
  if (dot < -0.9999) return [spare[0], spare[1], spare[2], 0];
  const q = [
    from[1] * to[2] - from[2] * to[1],
    from[2] * to[0] - from[0] * to[2],
    from[0] * to[1] - from[1] * to[0],
    1 + dot,
  ];
  const length = Math.hypot(...q);
  return q.map((value) => value / length);
}

/** Turns a whole animation so that `up` becomes +Y; where it faces stays as near as that allows. In place. */
export function turnUpright(sequence: PoseSequence, up: Numbers): void {
  const turn = arc(up, [0, 1, 0]);
  if (turn[3] > 1 - 1e-9) return;
  const { frames, quaternions } = sequence;
  for (let frame = 0; frame < frames; frame++) {
    const at = frame * STRIDE;
    quaternions.set(multiply(turn, quaternions.subarray(at, at + 4)), at);
  }
}

/** Mean speed of the joints against the pelvis at each frame, metres per second. */
function speeds({ frames, fps, quaternions }: PoseSequence): Float32Array {
  const out = new Float32Array(frames);
  let before = new Float32Array(JOINT_COUNT * 3);
  let now = new Float32Array(JOINT_COUNT * 3);
  for (let frame = 0; frame < frames; frame++) {
    forwardKinematics(quaternions.subarray(frame * STRIDE, (frame + 1) * STRIDE), [0, 0, 0], now);
    if (frame > 0) {
      let sum = 0;
      for (let i = 0; i < now.length; i += 3) {
        sum += Math.hypot(now[i] - before[i], now[i + 1] - before[i + 1], now[i + 2] - before[i + 2]);
      }
      out[frame] = (sum / JOINT_COUNT) * fps;
    }
    [before, now] = [now, before];
  }
  out[0] = out[1] ?? 0;
  return out;
}

/**
 * Frames worth a look: those that the file points out, else where the body is held, that is the lowest minima of its speed, well apart
 * in time.
 * @returns at most `count` frame numbers, ascending
 */
export function suggestFrames(sequence: PoseSequence, count: number): number[] {
  const { frames, fps, marks } = sequence;
  if (marks)
    return evenly(
      [...new Set(marks)].sort((a, b) => a - b),
      count,
    );
  if (frames <= count) return Array.from({ length: frames }, (_, frame) => frame);
  const raw = speeds(sequence);
  // A tenth of a second to either side, so that the noise of the recording makes no minima.
  const reach = Math.max(1, Math.round(fps / 10));
  const smooth = raw.map((_, frame) => {
    const part = raw.subarray(Math.max(0, frame - reach), frame + reach + 1);
    return part.reduce((sum, value) => sum + value, 0) / part.length;
  });
  const minima = [...smooth.keys()].filter(
    (frame) => smooth[frame] <= (smooth[frame - 1] ?? Infinity) && smooth[frame] < (smooth[frame + 1] ?? Infinity),
  );
  const apart = Math.max(fps * 0.4, frames / (count * 3));
  const chosen: number[] = [];
  const take = (candidates: number[]) => {
    for (const frame of candidates) {
      if (chosen.length === count) return;
      if (chosen.every((other) => Math.abs(other - frame) >= apart)) chosen.push(frame);
    }
  };
  take(minima.sort((a, b) => smooth[a] - smooth[b]));
  // Too few holds: evenly spread frames fill up.
  take(Array.from({ length: count }, (_, i) => Math.round((i * (frames - 1)) / (count - 1))));
  return chosen.sort((a, b) => a - b);
}

/** As many of a list, spread evenly over it. */
function evenly(list: readonly number[], count: number): number[] {
  if (list.length <= count) return [...list];
  return Array.from({ length: count }, (_, i) => list[Math.round((i * (list.length - 1)) / (count - 1))]);
}

/** Checks that every number is finite. */
export function requireFinite(values: Numbers, what: string): void {
  for (let i = 0; i < values.length; i++) {
    if (!Number.isFinite(values[i])) throw new Error(`${what} is no finite number: the file is damaged.`);
  }
}
