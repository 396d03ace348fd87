/**
 * Foot contact clean-up: the supporting foot stands still, the lowest point rests on the floor unless the dance really jumps, nothing is
 * below the floor, and on a key pose's frame every rotation is kept: the key strength alone says how near the pose comes. Works on
 * stretches, so that a dance can be cleaned while the rest of it is generated; frames before the stretch are fixed, and those after it too
 * when a range is made anew.
 */
import { bodyTrack, SOLES, type BodyTrack } from './contact-body';
import { liftEnvelope, pelvisHeights } from './contact-floor';
import { moveFoot } from './contact-leg';
import { findPlants, footOffsets, liftSwing, type FootBorder } from './contact-lock';
import { pelvisVelocities, type Velocity } from './contact-root';
import { bump, smoothstep } from './interpolate';
import { copyFrames } from './motion';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { Motion } from './types';

const POSE = JOINT_COUNT * 4;
const CONTEXT = 12;
/** Frames after a stretch that are looked at, so that the next stretch goes on smoothly. */
export const LOOKAHEAD = 20;
const KEY_REACH = 6;
/** Beyond this distance from the centre of the stage the figure is led back, metres; and how fast at most, m/s. */
const STAGE = { radius: 1.2, speed: 0.3 };

/** What one stretch hands to the next. */
export interface ContactState {
  /** The next frame to be cleaned. */
  frame: number;
  height: number;
  velocity: Velocity;
  drift: Velocity;
  feet: FootBorder[];
}

/** What is known about the keys and the borders. */
export interface ContactOptions {
  /** Frames of the key poses: their rotations are left alone. */
  keys: readonly number[];
  /** Result of the stretch before; none at the start of a dance. */
  state?: ContactState;
  /** Frames from the end of the stretch on are fixed in `output`. */
  fixedAfter?: boolean;
}

/**
 * Cleans frames [from, to) of `input` into `output`; rotations and root of other frames are only read.
 * @param input the dance before clean-up, at least up to `to` plus LOOKAHEAD where it is that long
 * @param output cleaned frames before `from`; after `to` too with `fixedAfter`
 */
export function cleanContacts(
  input: Motion,
  output: Motion,
  from: number,
  to: number,
  options: ContactOptions,
): ContactState {
  const state = options.state ?? (from > 0 ? stateFrom(output, from) : undefined);
  const end = options.fixedAfter && to < input.frames ? stateFrom(output, to, true) : undefined;
  const low = Math.max(0, from - CONTEXT);
  const high = end ? to : Math.min(input.frames, to + LOOKAHEAD);
  const seen = end ? Math.min(input.frames, to + CONTEXT) : high;
  const track = bodyTrack(input, low, seen);

  const heights = pelvisHeights(track.ground, rawHeights(input, low, seen));
  const way = wayOverFloor(input, output, track, heights, { low, from, to, high, state, end });
  const count = high - from;
  const at = from - low;
  const y = heights.slice(at, at + count);
  if (state) fade(y, state.height - y[0], (i) => i);
  if (end) fade(y, end.height - heights[to - low], (i) => count - i);
  raise(y, track.ground.subarray(at, at + count));

  const pelvis = new Float64Array(count * 3);
  const work: Motion = {
    ...input,
    frames: count,
    root: new Float32Array(count * 3),
    quaternions: new Float32Array(count * POSE),
  };
  copyFrames(input, from, high, work, 0);
  for (let i = 0; i < count; i++) pelvis.set([way.path[i * 2], y[i], way.path[i * 2 + 1]], i * 3);

  const keys = options.keys.filter((frame) => frame >= from && frame < high).map((frame) => frame - from);
  const feetAt = plantFeet({ work, track, at, pelvis, keys, state, end });
  raiseAfterLegs(work, pelvis);
  for (let i = 0; i < count * 3; i++) work.root[i] = pelvis[i];

  const done = Math.min(to, input.frames) - from;
  copyFrames(work, 0, done, output, from);
  return {
    frame: from + done,
    height: done < count ? pelvis[done * 3 + 1] : pelvis[(count - 1) * 3 + 1],
    velocity: way.velocityAt(done - 1),
    drift: way.drift,
    feet: feetAt(done),
  };
}

function rawHeights(motion: Motion, low: number, high: number): Float64Array {
  return Float64Array.from({ length: high - low }, (_, i) => motion.root[(low + i) * 3 + 1]);
}

interface Borders {
  low: number;
  from: number;
  to: number;
  high: number;
  state?: ContactState;
  end?: ContactState;
}

/** Pelvis x, z of frames [from, high), continuous with what is fixed, led back to the stage where it strays. */
function wayOverFloor(input: Motion, output: Motion, track: BodyTrack, heights: Float64Array, borders: Borders) {
  const { low, from, to, high, state, end } = borders;
  // One frame before the stretch belongs to the system: its velocity entry leads into the first frame.
  const first = Math.max(low, from - 1);
  const cut = high - first;
  const part: BodyTrack = {
    frames: cut,
    soles: track.soles.subarray((first - low) * SOLES.length * 3, (high - low) * SOLES.length * 3),
    ground: track.ground.subarray(first - low, high - low),
  };
  const raw = Float64Array.from(input.root.subarray(first * 3, high * 3));
  const u = pelvisVelocities(part, heights.subarray(first - low, high - low), raw, state?.velocity, end?.velocity);
  const count = high - from;
  const path = new Float64Array(count * 2);
  let [x, z] = state ? [output.root[(from - 1) * 3], output.root[(from - 1) * 3 + 2]] : [input.root[0], input.root[2]];
  let drift: Velocity = state?.drift ?? [0, 0];
  const drifts: Velocity[] = [];
  for (let i = 0; i < count; i++) {
    const row = (from + i - first) * 2;
    if (from + i > 0) {
      if (!end) drift = leadBack(drift, x, z, input.fps);
      x += u[row] + drift[0];
      z += u[row + 1] + drift[1];
    }
    drifts.push(drift);
    path[i * 2] = x;
    path[i * 2 + 1] = z;
  }
  if (end) {
    const goal = [output.root[high * 3] - end.velocity[0], output.root[high * 3 + 2] - end.velocity[1]];
    const missing = [goal[0] - x, goal[1] - z];
    for (let i = 0; i < count; i++) {
      const share = smoothstep((i + 1) / count);
      path[i * 2] += share * missing[0];
      path[i * 2 + 1] += share * missing[1];
    }
  }
  const velocityAt = (i: number): Velocity => {
    const row = Math.max(1, from + Math.max(0, i) - first) * 2;
    return cut > 1 ? [u[row], u[row + 1]] : [0, 0];
  };
  return { path, velocityAt, drift: drifts[Math.min(to, high) - from - 1] ?? drift };
}

/** Slow pull back to the centre, metres a frame; it changes over about a second, so that nobody sees it begin. */
function leadBack(drift: Velocity, x: number, z: number, fps: number): Velocity {
  const distance = Math.hypot(x, z);
  const speed = Math.min(STAGE.speed, 0.15 * Math.max(0, distance - STAGE.radius)) / fps;
  const wanted = distance > 0 ? [(-x / distance) * speed, (-z / distance) * speed] : [0, 0];
  return [drift[0] + (wanted[0] - drift[0]) / fps, drift[1] + (wanted[1] - drift[1]) / fps];
}

/** Adds `amount` at distance 0, fading to nothing over ten frames. */
function fade(series: Float64Array, amount: number, distance: (i: number) => number): void {
  for (let i = 0; i < series.length; i++) series[i] += amount * (1 - smoothstep(distance(i) / 10));
}

function raise(heights: Float64Array, ground: Float64Array): void {
  const lift = liftEnvelope(ground.map((y, i) => y - heights[i]));
  for (let i = 0; i < heights.length; i++) heights[i] += lift[i];
}

/** What the planting of feet needs to know about a stretch. */
interface Stretch {
  work: Motion;
  track: BodyTrack;
  /** Where the stretch begins in the track. */
  at: number;
  /** Pelvis positions, frames x 3. */
  pelvis: Float64Array;
  /** Keys inside the stretch that are hit at all, counted from its start. */
  keys: readonly number[];
  state?: ContactState;
  end?: ContactState;
}

/** Plants both feet by moving the legs; returns what the next stretch must know at a frame. */
function plantFeet({ work, track, at, pelvis, keys, state, end }: Stretch): (frame: number) => FootBorder[] {
  const paths = [0, 1].map((foot) => {
    const sole = SOLES.findIndex((point) => point.foot === foot && !point.heel);
    const path = new Float64Array(work.frames * 3);
    for (let i = 0; i < work.frames; i++) {
      const s = ((at + i) * SOLES.length + sole) * 3;
      for (let k = 0; k < 3; k++) path[i * 3 + k] = pelvis[i * 3 + k] + track.soles[s + k];
    }
    return path;
  });
  const borders = [0, 1].map((foot): FootBorder => state?.feet[foot] ?? { offset: [0, 0, 0] });
  const plants = paths.map((path, foot) => findPlants(path, work.fps, borders[foot].planted !== undefined));
  const offsets = paths.map((path, foot) => {
    const moved = footOffsets(path, plants[foot], keys, borders[foot], end?.feet[foot]);
    liftSwing(path, moved, plants[foot], plants[1 - foot], work.fps);
    for (const key of keys) keepKey(moved, key);
    return moved;
  });
  for (const foot of [0, 1] as const) {
    for (let i = 0; i < work.frames; i++) {
      const offset = offsets[foot].subarray(i * 3, i * 3 + 3);
      if (Math.hypot(offset[0], offset[1], offset[2]) < 1e-5) continue;
      moveFoot(work.quaternions.subarray(i * POSE, i * POSE + POSE), foot, offset);
    }
  }
  return (frame) =>
    [0, 1].map((foot) => {
      const last = Math.min(frame, work.frames) - 1;
      const standing = plants[foot].some((plant) => plant.from <= last && plant.to > last + 1);
      const offset = Array.from(offsets[foot].subarray(last * 3, last * 3 + 3)) as FootBorder['offset'];
      const point = offset.map((value, k) => value + paths[foot][last * 3 + k]) as FootBorder['offset'];
      return standing ? { planted: point, offset } : { offset };
    });
}

/** Fades the legs' offsets out around a key, so that its pose is left alone. */
function keepKey(offsets: Float64Array, key: number): void {
  for (let i = Math.max(0, key - KEY_REACH); i < Math.min(offsets.length / 3, key + KEY_REACH); i++) {
    const keep = 1 - bump((i - key) / KEY_REACH);
    for (let k = 0; k < 3; k++) offsets[i * 3 + k] *= keep;
  }
}

/** The last word on the floor: legs that were moved may have changed what is lowest. */
function raiseAfterLegs(work: Motion, pelvis: Float64Array): void {
  const { ground } = bodyTrack(work);
  // 1e-6 m keeps a float32 root from rounding to just below.
  const lift = liftEnvelope(ground.map((y, i) => y + 1e-6 - pelvis[i * 3 + 1]));
  for (let i = 0; i < lift.length; i++) pelvis[i * 3 + 1] += lift[i];
}

/** What a finished dance says about a border at `frame`: before it, or after it with `ahead`. */
function stateFrom(output: Motion, frame: number, ahead = false): ContactState {
  const a = ahead ? frame : Math.max(0, frame - 2);
  const b = ahead ? Math.min(output.frames - 1, frame + 1) : frame - 1;
  const nearest = ahead ? a : b;
  const { root } = output;
  const steps = Math.max(1, b - a);
  const step = [0, 1, 2].map((k) => (root[b * 3 + k] - root[a * 3 + k]) / steps);
  const track = bodyTrack(output, a, b + 1);
  const feet = [0, 1].map((foot): FootBorder => {
    const sole = SOLES.findIndex((point) => point.foot === foot && !point.heel);
    const at = (t: number, k: number) => root[t * 3 + k] + track.soles[((t - a) * SOLES.length + sole) * 3 + k];
    const speed = (Math.hypot(at(b, 0) - at(a, 0), at(b, 2) - at(a, 2)) * output.fps) / steps;
    const planted = speed < 0.3 && at(nearest, 1) < spec.skeleton.toeHeight + 0.03;
    const point: FootBorder['offset'] = [at(nearest, 0), at(nearest, 1), at(nearest, 2)];
    return planted ? { planted: point, offset: [0, 0, 0] } : { offset: [0, 0, 0] };
  });
  const height = ahead ? root[nearest * 3 + 1] : root[nearest * 3 + 1] + step[1];
  return { frame, height, velocity: [step[0], step[2]], drift: [0, 0], feet };
}
