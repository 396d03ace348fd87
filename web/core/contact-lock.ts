/** Planted feet: when each ball of a foot stands, and how far the leg must move it so that it does not slide. */
import { gaussianSmooth, hermite, smoothstep } from './interpolate';
import { spec } from './spec';

const { toeHeight } = spec.skeleton;
/** A foot is planted below `enter` and stays so below `leave` (metres above its rest height, m/s). */
const ENTER = { height: 0.03, speed: 0.3 };
const LEAVE = { height: 0.045, speed: 0.5 };
const SHORTEST = 3;
/** A foot that has strayed this far from where it was planted is moving after all, metres. */
const STRAY = 0.12;
/** Frames over which a leg goes back to the network's own motion. */
const FADE = 9;

type Point = [number, number, number];

/** A stretch of frames [from, to) in which a foot stands. */
export interface Plant {
  from: number;
  to: number;
}

/** What is fixed at the borders of a stretch of frames. */
export interface FootBorder {
  /** Where the foot is planted at the border, if it is. */
  planted?: Point;
  /** Offset of the leg at the border. */
  offset: Point;
}

/**
 * When a foot stands.
 * @param path positions of the ball of the foot, frames x 3, metres
 * @param planted whether it stood before the first frame
 */
export function findPlants(path: Float64Array, fps: number, planted: boolean): Plant[] {
  const frames = path.length / 3;
  const plants: Plant[] = [];
  let from = planted ? 0 : -1;
  const below = (t: number, limit: { height: number; speed: number }) => {
    const a = Math.max(0, t - 1) * 3;
    const b = Math.min(frames - 1, t + 1) * 3;
    const speed = (Math.hypot(path[b] - path[a], path[b + 2] - path[a + 2]) * fps * 3) / Math.max(1, b - a);
    return path[t * 3 + 1] - toeHeight < limit.height && speed < limit.speed;
  };
  const close = (to: number) => {
    if (from >= 0 && to > from && (to - from >= SHORTEST || from === 0 || to === frames)) plants.push({ from, to });
    from = -1;
  };
  for (let t = 0; t < frames; t++) {
    if (from < 0) {
      if (below(t, ENTER)) from = t;
    } else if (
      !below(t, LEAVE) ||
      Math.hypot(path[t * 3] - path[from * 3], path[t * 3 + 2] - path[from * 3 + 2]) > STRAY
    ) {
      close(t);
    }
  }
  close(frames);
  return plants;
}

/**
 * How far a leg must move its foot in each frame: to the planted point while it stands, back to the network's own motion in between.
 * @param keys frames where the pose is exact: a plant that has one stands where the key puts it
 * @returns frames x 3, metres
 */
export function footOffsets(
  path: Float64Array,
  plants: readonly Plant[],
  keys: readonly number[],
  start: FootBorder,
  end?: FootBorder,
): Float64Array {
  const frames = path.length / 3;
  const offsets = new Float64Array(path.length);
  let done = 0;
  let edge = { at: -1, offset: start.offset, slope: [0, 0, 0] as Point };
  for (const plant of plants) {
    const target = plantTarget(path, plant, keys, start, end);
    for (let t = plant.from; t < plant.to; t++) {
      offsets[t * 3] = target(t)[0] - path[t * 3];
      // Pressing down to the floor is for feet that nearly touch it; the rest is the heel-off of a real step.
      const height = path[t * 3 + 1] - toeHeight;
      offsets[t * 3 + 1] = -height * (1 - smoothstep((height - 0.015) / 0.03));
      offsets[t * 3 + 2] = target(t)[1] - path[t * 3 + 2];
    }
    bridge(offsets, edge, {
      at: plant.from,
      offset: pointAt(offsets, plant.from),
      slope: slopeAt(offsets, plant, plant.from),
    });
    edge = { at: plant.to - 1, offset: pointAt(offsets, plant.to - 1), slope: slopeAt(offsets, plant, plant.to - 1) };
    done = plant.to;
  }
  if (done < frames) {
    const border = end?.offset ?? ([0, 0, 0] as Point);
    const at = end ? frames : Math.max(frames, edge.at + FADE + 1);
    bridge(offsets, edge, { at, offset: border, slope: [0, 0, 0] });
  }
  return offsets;
}

/** A foot that travels is lifted clear of the floor: from `slow` on, fully from `fast` on (m/s), to `height` metres. */
const SWING = { slow: 0.25, fast: 0.6, height: 0.065 };

/**
 * Lifts a foot that would drag over the floor while the other one stands, adding to its offsets in place: a step instead of a slide.
 * @param path where the foot is, frames x 3, metres
 * @param offsets how far it is moved from there, frames x 3, metres
 * @param plants when it stands, frames
 * @param otherPlants when the other foot stands, frames
 */
export function liftSwing(
  path: Float64Array,
  offsets: Float64Array,
  plants: readonly Plant[],
  otherPlants: readonly Plant[],
  fps: number,
): void {
  const frames = path.length / 3;
  const wanted = new Float64Array(frames);
  const stands = (list: readonly Plant[], t: number) => list.some((plant) => t >= plant.from && t < plant.to);
  for (let t = 0; t < frames; t++) {
    if (stands(plants, t) || !stands(otherPlants, t)) continue;
    const a = Math.max(0, t - 1) * 3;
    const b = Math.min(frames - 1, t + 1) * 3;
    const dx = path[b] + offsets[b] - path[a] - offsets[a];
    const dz = path[b + 2] + offsets[b + 2] - path[a + 2] - offsets[a + 2];
    const speed = (Math.hypot(dx, dz) * fps * 3) / Math.max(1, b - a);
    const height = path[t * 3 + 1] + offsets[t * 3 + 1] - toeHeight;
    const goal = SWING.height * smoothstep((speed - SWING.slow) / (SWING.fast - SWING.slow));
    wanted[t] = Math.max(0, goal - height);
  }
  const lift = gaussianSmooth(wanted, 1, 1.2);
  for (let t = 0; t < frames; t++) offsets[t * 3 + 1] += lift[t];
}

/** The point a foot stands on at a frame of its plant: x, z. It moves only between several keys of one plant. */
function plantTarget(
  path: Float64Array,
  plant: Plant,
  keys: readonly number[],
  start: FootBorder,
  end?: FootBorder,
): (t: number) => [number, number] {
  const fixed: { t: number; at: [number, number] }[] = [];
  if (plant.from === 0 && start.planted) fixed.push({ t: -1, at: [start.planted[0], start.planted[2]] });
  for (const t of keys) if (t >= plant.from && t < plant.to) fixed.push({ t, at: [path[t * 3], path[t * 3 + 2]] });
  if (plant.to === path.length / 3 && end?.planted) fixed.push({ t: plant.to, at: [end.planted[0], end.planted[2]] });
  if (!fixed.length) {
    let [x, z] = [0, 0];
    for (let t = plant.from; t < plant.to; t++) {
      x += path[t * 3] / (plant.to - plant.from);
      z += path[t * 3 + 2] / (plant.to - plant.from);
    }
    return () => [x, z];
  }
  return (t) => {
    const next = fixed.findIndex((point) => point.t >= t);
    if (next < 0) return fixed[fixed.length - 1].at;
    if (next === 0) return fixed[0].at;
    const [a, b] = [fixed[next - 1], fixed[next]];
    const share = smoothstep((t - a.t) / (b.t - a.t));
    return [a.at[0] + share * (b.at[0] - a.at[0]), a.at[1] + share * (b.at[1] - a.at[1])];
  };
}

interface Edge {
  at: number;
  offset: Point;
  slope: Point;
}

function pointAt(offsets: Float64Array, t: number): Point {
  return [offsets[t * 3], offsets[t * 3 + 1], offsets[t * 3 + 2]];
}

/** Change of the offset a frame at one end of a plant. */
function slopeAt(offsets: Float64Array, plant: Plant, t: number): Point {
  const a = Math.max(plant.from, t - 1);
  const b = Math.min(plant.to - 1, t + 1);
  const [from, to] = [pointAt(offsets, a), pointAt(offsets, b)];
  return [0, 1, 2].map((k) => (b > a ? (to[k] - from[k]) / (b - a) : 0)) as Point;
}

/** Fills the frames between two edges: straight over when they are near, by way of zero when they are far apart. */
function bridge(offsets: Float64Array, a: Edge, b: Edge): void {
  const gap = b.at - a.at;
  const frames = offsets.length / 3;
  for (let t = a.at + 1; t < Math.min(b.at, frames); t++) {
    for (let k = 0; k < 3; k++) {
      if (gap <= 2 * FADE) {
        offsets[t * 3 + k] = hermite(a.offset[k], a.slope[k] * gap, b.offset[k], b.slope[k] * gap, (t - a.at) / gap);
      } else {
        const out = Math.min(1, (t - a.at) / FADE);
        const into = Math.min(1, (b.at - t) / FADE);
        offsets[t * 3 + k] =
          hermite(a.offset[k], a.slope[k] * FADE, 0, 0, out) + hermite(b.offset[k], -b.slope[k] * FADE, 0, 0, into);
      }
    }
  }
}
