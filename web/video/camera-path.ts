/** Where the camera is in every frame of a video, worked out beforehand from the whole dance. Pure: no DOM, no three. */
import type { CameraView } from '../core/document';
import { framePose, type MutableFramePose } from '../core/motion';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../core/skeleton';
import type { BeatGrid, Motion } from '../core/types';
import { CAPSULES, placePoint, type BodyPoint } from '../scene/body-points';
import { frameTime, type FramePlan, type VideoCamera } from './options';
import { shotsOf, type Shot } from './shots';

/** Vertical field of view of the stage's camera, degrees. */
export const FIELD_OF_VIEW = 30;

/** The camera of every frame: frames x 3 each, metres. */
export interface CameraPath {
  position: Float32Array;
  target: Float32Array;
  /** The dancer's smoothed place on the floor, frames x 2 (x, z): the middle of the light. */
  centre: Float32Array;
}

/** Share of the picture left free on each side. */
const MARGIN = 0.07;
/** How gently the camera goes with the dancer, seconds. */
const EASE = { place: 0.45, distance: 0.7 };
/** A camera that stands still starts to go along when the dancer travels further than this, metres. */
const TRAVEL = 3;
/** The camera stays above the floor, metres. */
const LOWEST = 0.15;
/** The view is never narrower than a figure standing at ease, metres from the lowest to the highest point. */
const LEAST_HEIGHT = { whole: 1.85, upper: 1.15 };

const LEGS = new Set(
  ['hip', 'knee', 'ankle', 'foot'].flatMap((name) => [jointIndex(`left_${name}`), jointIndex(`right_${name}`)]),
);
const BODY: readonly BodyPoint[] = CAPSULES.flatMap(({ from, to }) => [from, to]);
const UPPER: readonly number[] = BODY.flatMap(({ joint }, i) => (LEGS.has(joint) ? [] : [i]));
const WHOLE: readonly number[] = BODY.map((_, i) => i);

/**
 * Weights of the normal distribution, cut off at 2.5 sigma.
 * @param sigma in frames
 */
function bell(sigma: number): number[] {
  const reach = Math.ceil(sigma * 2.5);
  return Array.from({ length: 2 * reach + 1 }, (_, i) => Math.exp(-((i - reach) ** 2) / (2 * sigma * sigma)));
}

/** A smoothed copy of frames x `width` numbers; it neither lags nor leads. */
export function smooth(values: ArrayLike<number>, width: number, sigma: number): Float64Array {
  const frames = values.length / width;
  const weights = bell(Math.max(sigma, 0.01));
  const reach = (weights.length - 1) / 2;
  const out = new Float64Array(values.length);
  for (let frame = 0; frame < frames; frame++) {
    let sum = 0;
    for (let k = Math.max(-reach, -frame); k <= Math.min(reach, frames - 1 - frame); k++) {
      const weight = weights[k + reach];
      sum += weight;
      for (let i = 0; i < width; i++) out[frame * width + i] += weight * values[(frame + k) * width + i];
    }
    for (let i = 0; i < width; i++) out[frame * width + i] /= sum;
  }
  return out;
}

/** A smooth curve that is nowhere below the values: the largest nearby, smoothed over no more than that nearness. */
export function smoothAbove(values: ArrayLike<number>, sigma: number): Float64Array {
  const reach = (bell(sigma).length - 1) / 2;
  const highest = Array.from(values, (_, i) => {
    let most = -Infinity;
    for (let k = Math.max(0, i - reach); k <= Math.min(values.length - 1, i + reach); k++)
      most = Math.max(most, values[k]);
    return most;
  });
  return smooth(highest, 1, sigma);
}

/** The body in every frame: frames x points x 3, metres in the world. */
function bodyOf(motion: Motion, plan: FramePlan): Float32Array {
  const out = new Float32Array(plan.frames * BODY.length * 3);
  const pose: MutableFramePose = { root: new Float32Array(3), quaternions: new Float32Array(JOINT_COUNT * 4) };
  const joints = new Float32Array(JOINT_COUNT * 3);
  const turns = new Float32Array(JOINT_COUNT * 4);
  const place = [0, 0, 0];
  for (let frame = 0; frame < plan.frames; frame++) {
    framePose(motion, frameTime(plan, frame), pose);
    forwardKinematics(pose.quaternions, pose.root, joints, turns);
    BODY.forEach((point, i) => out.set(placePoint(point, joints, turns, place), (frame * BODY.length + i) * 3));
  }
  return out;
}

/** The dancer's place on the floor in every frame, frames x 2. */
function places(motion: Motion, plan: FramePlan): Float64Array {
  const out = new Float64Array(plan.frames * 2);
  const pose: MutableFramePose = { root: new Float32Array(3), quaternions: new Float32Array(JOINT_COUNT * 4) };
  for (let frame = 0; frame < plan.frames; frame++) {
    framePose(motion, frameTime(plan, frame), pose);
    out[frame * 2] = pose.root[0];
    out[frame * 2 + 1] = pose.root[2];
  }
  return out;
}

/** A place that does not move: the middle of where the dancer is in a shot; or smoothed over seconds where that is too wide. */
function standing(path: Float64Array, { from, to }: Shot, fps: number): Float64Array {
  const part = path.slice(from * 2, to * 2);
  const ends = [0, 1].map((axis) => {
    let [low, high] = [Infinity, -Infinity];
    for (let i = axis; i < part.length; i += 2) [low, high] = [Math.min(low, part[i]), Math.max(high, part[i])];
    return { low, high };
  });
  if (ends.some(({ low, high }) => high - low > TRAVEL)) return smooth(part, 2, 2 * fps);
  return part.map((_, i) => (ends[i % 2].low + ends[i % 2].high) / 2);
}

/**
 * Distance at which a point is inside the view, for a camera that looks at `target` from direction `back`.
 * @param offset from the target, metres
 * @param radius of the body there, metres
 * @param tangent of half the field of view, across and up
 */
export function neededDistance(
  offset: readonly [number, number, number],
  radius: number,
  azimuth: number,
  elevation: number,
  tangent: { across: number; up: number },
): number {
  const [sin, cos] = [Math.sin(azimuth), Math.cos(azimuth)];
  const [lift, flat] = [Math.sin(elevation), Math.cos(elevation)];
  const [x, y, z] = offset;
  const near = x * sin * flat + y * lift + z * cos * flat;
  const across = Math.abs(x * cos - z * sin) + radius;
  const up = Math.abs(-x * sin * lift + y * flat - z * cos * lift) + radius;
  return near + Math.max(across / tangent.across, up / tangent.up);
}

/**
 * The camera of every frame. What a shot has to show is whole in all of its frames.
 * @param aspect width over height
 * @param view the visitor's, for the camera `stage`; null = the opening view
 */
export function cameraPath(
  motion: Motion,
  plan: FramePlan,
  aspect: number,
  camera: VideoCamera,
  grid: BeatGrid | null,
  view: CameraView | null = null,
): CameraPath {
  const { frames, fps } = plan;
  const up = Math.tan((FIELD_OF_VIEW * Math.PI) / 360) * (1 - MARGIN);
  const tangent = { across: up * aspect, up };
  const body = bodyOf(motion, plan);
  const place = places(motion, plan);
  const eased = smooth(place, 2, EASE.place * fps);
  const path: CameraPath = {
    position: new Float32Array(frames * 3),
    target: new Float32Array(frames * 3),
    centre: Float32Array.from(eased),
  };
  if (camera === 'stage' && view) return asOnStage(view, aspect, eased, path);
  for (const shot of shotsOf(camera, plan, grid)) {
    const centre = shot.follows ? eased.slice(shot.from * 2, shot.to * 2) : standing(place, shot, fps);
    film(shot, body, centre, fps, tangent, path);
  }
  return path;
}

/** The visitor's own view. An upright picture steps back until it shows what a square one would. */
function asOnStage(view: CameraView, aspect: number, eased: Float64Array, path: CameraPath): CameraPath {
  const back = Math.max(1, 1 / aspect);
  for (let frame = 0; frame < eased.length / 2; frame++)
    for (let axis = 0; axis < 3; axis++) {
      const dancer = view.follows && axis !== 1 ? eased[frame * 2 + axis / 2] : 0;
      const target = view.target[axis] + dancer;
      path.target[frame * 3 + axis] = target;
      path.position[frame * 3 + axis] = target + (view.position[axis] - view.target[axis]) * back;
    }
  return path;
}

/** A distance that is enough for most of a shot. */
function usualOf(needed: readonly number[]): number {
  return [...needed].sort((a, b) => a - b)[Math.floor((needed.length - 1) * 0.85)];
}

/** What a shot has to show: points of the body, and between which heights they are in all of its frames, metres. */
interface Subject {
  points: readonly number[];
  low: number;
  high: number;
}

function subjectOf({ from, to }: Shot, body: Float32Array, what: Shot['body']): Subject {
  const points = what === 'whole' ? WHOLE : UPPER;
  // All of a figure has its feet on the floor.
  let [low, high] = [what === 'whole' ? 0 : Infinity, -Infinity];
  for (let frame = from; frame < to; frame++)
    for (const point of points) {
      const y = body[(frame * BODY.length + point) * 3 + 1];
      low = Math.min(low, y - BODY[point].radius);
      high = Math.max(high, y + BODY[point].radius);
    }
  return { points, low, high: Math.max(high, low + LEAST_HEIGHT[what]) };
}

function film(
  shot: Shot,
  body: Float32Array,
  centre: Float64Array,
  fps: number,
  tangent: { across: number; up: number },
  path: CameraPath,
): void {
  const { points, low, high } = subjectOf(shot, body, shot.body);
  const length = shot.to - shot.from;
  const azimuthAt = (i: number) => shot.azimuth + (shot.turn * i) / Math.max(1, length - 1);
  /** The distance that every frame needs, looking at this height. */
  const neededAt = (height: number) =>
    Array.from({ length }, (_, i) => {
      let distance = LEAST_HEIGHT[shot.body] / 2 / tangent.up;
      for (const point of points) {
        const at = ((shot.from + i) * BODY.length + point) * 3;
        const offset: [number, number, number] = [
          body[at] - centre[i * 2],
          body[at + 1] - height,
          body[at + 2] - centre[i * 2 + 1],
        ];
        const { radius } = BODY[point];
        distance = Math.max(distance, neededDistance(offset, radius, azimuthAt(i), shot.elevation, tangent));
      }
      return distance;
    });
  let height = Math.max((low + high) / 2, 0.5);
  let needed = neededAt(height);
  if (shot.body === 'upper') {
    // An upright picture as wide as the arms is higher than the upper body: the room goes to the legs, not above the head.
    const whole = subjectOf(shot, body, 'whole');
    const half = usualOf(needed) * tangent.up;
    height = Math.max((whole.low + whole.high) / 2, Math.min(height, high - half));
    needed = neededAt(height);
  }
  // Mostly one distance; only what is wider than usual moves the camera back.
  const usual = usualOf(needed);
  const distances = smoothAbove(
    needed.map((distance) => Math.max(distance, usual)),
    EASE.distance * fps,
  );
  for (let i = 0; i < length; i++) {
    const distance = distances[i] * (1 + shot.push * (1 - i / Math.max(1, length - 1)));
    const azimuth = azimuthAt(i);
    const flat = Math.cos(shot.elevation) * distance;
    const frame = (shot.from + i) * 3;
    path.target.set([centre[i * 2], height, centre[i * 2 + 1]], frame);
    path.position.set(
      [
        centre[i * 2] + Math.sin(azimuth) * flat,
        Math.max(LOWEST, height + Math.sin(shot.elevation) * distance),
        centre[i * 2 + 1] + Math.cos(azimuth) * flat,
      ],
      frame,
    );
  }
}
