/** The pelvis's way over the floor: whatever carries the weight stands still. */
import { SOLES, type BodyTrack } from './contact-body';
import { gaussianSmooth } from './interpolate';
import { spec } from './spec';

/** A sole this far above the lowest point carries little weight, metres. */
const NEAR = 0.02;
/** A sole that would slide faster than this is hardly planted, m/s. */
const SLIDE = 0.25;
/** Rounds of weighing the soles by how still the last solution keeps them. */
const ROUNDS = 4;
/** Resistance to change of velocity, and pull to the network's own velocity, against a full support of 1. */
const INERTIA = 1;
const TRUST = 0.02;

/** Pelvis velocity at a border of a stretch, metres a frame. */
export type Velocity = readonly [number, number];

/**
 * Horizontal pelvis velocity of each frame of a stretch, by least squares: supporting soles stand still, velocity changes smoothly, and
 * in the air the network's own velocity leads. Which soles support is found by weighing them anew with each solution.
 * @param track soles relative to the pelvis
 * @param heights pelvis heights, metres
 * @param rawRoot the network's pelvis positions, frames x 3
 * @param start velocity before the first frame, if it is fixed
 * @param end velocity after the last frame, if it is fixed
 * @returns frames x 2 (x, z), metres a frame: entry t is the way from frame t - 1 to t; entry 0 equals entry 1
 */
export function pelvisVelocities(
  track: BodyTrack,
  heights: Float64Array,
  rawRoot: Float64Array,
  start?: Velocity,
  end?: Velocity,
): Float64Array {
  const { frames, soles } = track;
  const count = SOLES.length;
  let velocity: Float64Array = new Float64Array(frames * 2);
  if (frames < 2) return velocity;
  const low = lowness(track, heights);
  const raw = differences(rawRoot, 3, 2);
  for (let round = 0; round < ROUNDS; round++) {
    const weights = new Float64Array(frames * count);
    for (let t = 1; t < frames; t++) {
      for (let sole = 0; sole < count; sole++) {
        const i = (t * count + sole) * 3;
        const before = i - count * 3;
        let speed = 0;
        if (round > 0) {
          const dx = soles[i] - soles[before] + velocity[t * 2];
          const dz = soles[i + 2] - soles[before + 2] + velocity[t * 2 + 1];
          speed = Math.hypot(dx, dz) * spec.fps;
        }
        weights[t * count + sole] = low[t * count + sole] / (1 + (speed / SLIDE) ** 2);
      }
    }
    const smooth = gaussianSmooth(weights, count, 1.5);
    velocity = solve(track, smooth, raw, start, end);
  }
  return velocity;
}

/** How near to the floor each sole is between a frame and the one before: 1 = on it .. 0. */
function lowness(track: BodyTrack, heights: Float64Array): Float64Array {
  const count = SOLES.length;
  const low = new Float64Array(track.frames * count);
  const at = (t: number, sole: number) => {
    const height = track.soles[(t * count + sole) * 3 + 1] + heights[t] - spec.skeleton.toeHeight;
    return Math.exp(-((Math.max(0, height) / NEAR) ** 2));
  };
  for (let t = 1; t < track.frames; t++) {
    for (let sole = 0; sole < count; sole++) low[t * count + sole] = Math.sqrt(at(t, sole) * at(t - 1, sole));
  }
  return low;
}

/** Frame-to-frame differences of the x and z columns: frames x 2. */
function differences(series: Float64Array, stride: number, zColumn: number): Float64Array {
  const frames = series.length / stride;
  const out = new Float64Array(frames * 2);
  for (let t = 1; t < frames; t++) {
    out[t * 2] = series[t * stride] - series[(t - 1) * stride];
    out[t * 2 + 1] = series[t * stride + zColumn] - series[(t - 1) * stride + zColumn];
  }
  return out;
}

/** Minimises sum w (u + d)^2 + trust (u - raw)^2 + inertia (u_t - u_t-1)^2: a tridiagonal system for each axis. */
function solve(
  track: BodyTrack,
  weights: Float64Array,
  raw: Float64Array,
  start?: Velocity,
  end?: Velocity,
): Float64Array {
  const { frames, soles } = track;
  const count = SOLES.length;
  const velocity = new Float64Array(frames * 2);
  const n = frames - 1;
  for (let axis = 0; axis < 2; axis++) {
    const diagonal = new Float64Array(n);
    const right = new Float64Array(n);
    for (let row = 0; row < n; row++) {
      const t = row + 1;
      diagonal[row] = TRUST;
      right[row] = TRUST * raw[t * 2 + axis];
      for (let sole = 0; sole < count; sole++) {
        const i = (t * count + sole) * 3 + axis * 2;
        const weight = weights[t * count + sole];
        diagonal[row] += weight;
        right[row] -= weight * (soles[i] - soles[i - count * 3]);
      }
      diagonal[row] += INERTIA * ((row > 0 || start ? 1 : 0) + (row + 1 < n || end ? 1 : 0));
    }
    if (start) right[0] += INERTIA * start[axis];
    if (end) right[n - 1] += INERTIA * end[axis];
    for (let row = 1; row < n; row++) {
      const factor = -INERTIA / diagonal[row - 1];
      diagonal[row] += factor * INERTIA;
      right[row] -= factor * right[row - 1];
    }
    for (let row = n - 1; row >= 0; row--) {
      const next = row + 1 < n ? INERTIA * velocity[(row + 2) * 2 + axis] : 0;
      velocity[(row + 1) * 2 + axis] = (right[row] + next) / diagonal[row];
    }
  }
  velocity[0] = velocity[2];
  velocity[1] = velocity[3];
  return velocity;
}
