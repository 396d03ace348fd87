/**
 * Filler poses: poses of the starting clip on beats where no user key is near. A regression network freezes without keys; with these
 * the stretches between the user's keys dance too. In short gaps there are none, unless variation asks for another way from key to key.
 * They are input to the network only: no dance is ever corrected to them.
 */
import { beatPhase, type BeatPhase } from './beat-phase';
import type { FrameKey } from './correction';
import { smoothstep, wrapAngle } from './interpolate';
import { aboutY, headingOf } from './localframe';
import { chooseWeighted, seededRandom, type Random } from './random';
import {
  angleBetween,
  axisAngleToQuaternion,
  multiply,
  poseToQuaternions,
  quaternionsToPose,
  quaternionToAxisAngle,
  slerp,
} from './rotation';
import { seedSampler, type SeedSampler } from './seed';
import { JOINT_COUNT, mirrorPose } from './skeleton';
import { spec } from './spec';
import type { BeatGrid, SeedClip } from './types';

/** Gaps up to this long get no filler but for the sake of variation, seconds: the in-betweener was trained on gaps of up to 2.6 s. */
export const LONGEST_GAP = 2.5;
/** The dials of a first take: up to this variation it goes the network's own way from key to key; the other takes are there to differ. */
export const FIRST_TAKE = { seed: 1, variation: 0.3 };
/** A filler keeps at least this far from a user's key, seconds. */
export const KEY_DISTANCE = 0.4;
/** A body turns at most this fast between two keys' headings, radians a second. */
const TURN_SPEED = 2.5;

/** Steps at which a bar may begin in a clip, beats: phrases begin on ones and threes. */
const ENTRY = 2;
/** At full variation this share of the bars that leave the clip's own order comes from other clips. */
const BORROWED = 0.7;

/** A clip to take bars from. */
interface Source {
  sampler: SeedSampler;
  mean: Float32Array;
}

/** How to dance one bar. */
interface BarStyle {
  source: Source;
  /** Clip beat of the bar's first beat. */
  phase: number;
  mirrored: boolean;
  /** Scale of the movement around the clip's mean pose. */
  amplitude: number;
}

/** What fillers are chosen for. */
export interface FillerRequest {
  clip: SeedClip;
  /** Clips that bars are borrowed from as variation grows; without them all is made of `clip`. */
  others?: readonly SeedClip[];
  grid: BeatGrid;
  /** The user's keys on their frames, ascending. */
  keys: readonly FrameKey[];
  /** Frames [from, to) are filled. */
  from: number;
  to: number;
  /** 0 = the clip in its own order .. 1 = bars shuffled, mirrored, larger and smaller, and borrowed. */
  variation: number;
  seed: number;
  /** Gaps up to this long between two keys get none but for the sake of variation, seconds; by default LONGEST_GAP. */
  longestGap?: number;
}

/**
 * World heading over time: through the headings of the keys, turning smoothly in between.
 * @param start where the curve begins, radians; by default frame 0, facing +Z
 * @returns a function of the frame
 */
export function headingCurve(
  keys: readonly FrameKey[],
  start?: { frame: number; heading: number },
): (frame: number) => number {
  const headings = keys.map((key) => headingOf(key.quaternions));
  if (!keys.length) return () => start?.heading ?? 0;
  // A first key soon after the start sets the direction from the start: turning there at once would look like a mistake.
  const opening = keys[0].frame < 2 * spec.fps ? headings[0] : 0;
  const points = [start ?? { frame: 0, heading: opening }];
  keys.forEach((key, i) => {
    const before = points[points.length - 1].heading;
    points.push({ frame: key.frame, heading: before + wrapAngle(headings[i] - before) });
  });
  return (frame) => {
    const next = points.findIndex((point, i) => i > 0 && point.frame >= frame);
    if (next < 0) return points[points.length - 1].heading;
    const [a, b] = [points[next - 1], points[next]];
    if (frame <= a.frame || a.frame === b.frame) return frame <= a.frame ? a.heading : b.heading;
    // The turn happens around the middle of the gap, no slower than it must be: a body does not creep round for ten seconds.
    const gap = b.frame - a.frame;
    const turning = Math.min(gap, Math.max(spec.fps, (Math.abs(b.heading - a.heading) / TURN_SPEED) * spec.fps * 2));
    const begin = a.frame + (gap - turning) / 2;
    return a.heading + (b.heading - a.heading) * smoothstep((frame - begin) / turning);
  };
}

/**
 * Filler poses for frames [from, to): on beats, in gaps longer than LONGEST_GAP, at least KEY_DISTANCE from every key.
 * @param heading world heading at a frame, radians
 * @returns ascending; the same request gives the same fillers
 */
export function fillerPoses(request: FillerRequest, heading: (frame: number) => number): FrameKey[] {
  const { keys, from, to } = request;
  const { fps } = spec;
  const phase = beatPhase(request.grid);
  const dancer = barDancer(request, phase);
  const borders = [from - 1, ...keys.map((key) => key.frame).filter((frame) => frame >= from && frame < to), to];
  const fillers: FrameKey[] = [];
  for (let i = 0; i + 1 < borders.length; i++) {
    const [left, right] = [borders[i], borders[i + 1]];
    if (right - left <= (request.longestGap ?? LONGEST_GAP) * fps && i + 2 < borders.length) {
      const detour = i > 0 && detourPose(request, phase, dancer, heading, left, right);
      if (detour) fillers.push(detour);
      continue;
    }
    // The start of the dance and its end are no keys: a filler may be right beside them.
    const clearLeft = i === 0 ? left + Math.round(KEY_DISTANCE * fps) : left + KEY_DISTANCE * fps;
    const clearRight = i + 2 === borders.length ? right : right - KEY_DISTANCE * fps;
    for (let beat = Math.ceil(phase.at(clearLeft / fps)); ; beat++) {
      const frame = Math.round(phase.time(beat) * fps);
      if (frame > clearRight || frame >= to) break;
      if (frame < clearLeft || frame === fillers[fillers.length - 1]?.frame) continue;
      fillers.push({ frame, quaternions: dancer(beat, heading(frame)) });
    }
  }
  return fillers;
}

/** How likely a short gap of a take is danced another way than the network's own. */
function detourChance(variation: number, seed: number): number {
  if (variation <= 0) return 0;
  if (seed !== FIRST_TAKE.seed) return Math.min(1, 0.4 + variation);
  return Math.max(0, (variation - FIRST_TAKE.variation) / (1 - FIRST_TAKE.variation));
}

/** How far a detour leans from the straight way towards the clip's pose: at least, and at most at full variation. */
const LEAN = { least: 0.35, most: 0.8 };

/**
 * A pose for a short gap: on a beat (else in the middle), part of the way from the straight line between the two keys to the clip's pose.
 * Whether a gap gets one, where and how far is drawn by the seed, so each seed takes another way through the same keys.
 */
function detourPose(
  { keys, variation, seed }: FillerRequest,
  phase: BeatPhase,
  dancer: (beat: number, heading: number) => Float32Array,
  heading: (frame: number) => number,
  left: number,
  right: number,
): FrameKey | undefined {
  const margin = KEY_DISTANCE * spec.fps;
  if (right - left < 2 * margin) return undefined;
  const random = seededRandom(seed * 7919 + 104_729 * (left + 1));
  if (random() >= detourChance(variation, seed)) return undefined;
  const beats: number[] = [];
  for (let beat = Math.ceil(phase.at((left + margin) / spec.fps)); ; beat++) {
    const frame = Math.round(phase.time(beat) * spec.fps);
    if (frame > right - margin) break;
    if (frame >= left + margin) beats.push(beat);
  }
  const middle = phase.at((left + right) / 2 / spec.fps);
  const beat = beats.length ? beats[Math.floor(random() * beats.length)] : middle;
  const frame = Math.round(phase.time(beat) * spec.fps);
  const [before, after] = [left, right].map((at) => keys.find((key) => key.frame === at)?.quaternions);
  if (!before || !after) return undefined;
  // Any beat of the clip will do: which one is part of the draw.
  const pose = dancer(Math.round(beat) + Math.floor(random() * 8), heading(frame));
  const lean = LEAN.least + (LEAN.most - LEAN.least) * variation * random();
  for (let j = 0; j < pose.length; j += 4) {
    const straight = slerp(before.subarray(j, j + 4), after.subarray(j, j + 4), (frame - left) / (right - left));
    slerp(straight, pose.subarray(j, j + 4), lean, pose.subarray(j, j + 4));
  }
  return { frame, quaternions: pose };
}

/** Poses by song beat, bar by bar in a style drawn for each bar. */
function barDancer(request: FillerRequest, phase: BeatPhase): (beat: number, heading: number) => Float32Array {
  const { clip, others = [] } = request;
  const own = sourceOf(clip);
  const borrowed = others.filter((other) => other.id !== clip.id).map(sourceOf);
  const variation = Math.min(1, Math.max(0, request.variation));
  const styles: BarStyle[] = [];
  const firstBar = Math.floor(phase.at(0) / phase.perBar);
  // Bars are drawn in order from the song's start, so that a range made anew gets the bars that the whole dance would have there.
  const style = (bar: number): BarStyle => {
    for (let next = firstBar + styles.length; next <= bar; next++) {
      const random = seededRandom(request.seed * 7919 + next);
      const before = styles[styles.length - 1] as BarStyle | undefined;
      const straight: BarStyle = {
        source: before?.source ?? own,
        phase: before ? before.phase + phase.perBar : next * phase.perBar,
        mirrored: before?.mirrored ?? false,
        amplitude: 1,
      };
      styles.push(drawStyle({ straight, own, borrowed, variation, random }));
    }
    return styles[Math.max(0, bar - firstBar)];
  };
  return (beat, heading) => {
    const bar = Math.floor(beat / phase.perBar);
    const chosen = style(bar);
    return styledPose(chosen, beat - bar * phase.perBar, heading - headingOf(chosen.source.mean));
  };
}

function sourceOf(clip: SeedClip): Source {
  return { sampler: seedSampler(clip), mean: meanPose(clip) };
}

/** The style of a bar: straight on with probability 1 - variation, else one whose first pose is near where the bar before leads. */
function drawStyle(draw: {
  /** The bar before, going on. */
  straight: BarStyle;
  own: Source;
  borrowed: readonly Source[];
  variation: number;
  random: Random;
}): BarStyle {
  const { straight, own, borrowed, variation, random } = draw;
  const amplitude = 1 + variation * (random() - 0.4) * 0.5;
  if (random() >= variation) return { ...straight, amplitude };
  const sources = borrowed.length && random() < BORROWED * variation ? borrowed : [own];
  const options = sources.flatMap((source) =>
    Array.from({ length: Math.ceil(source.sampler.beats / ENTRY) }, (_, i) => i * ENTRY).flatMap((phase) =>
      [false, true].map((mirrored): BarStyle => ({ source, phase, mirrored, amplitude })),
    ),
  );
  const leads = rawPose(straight, 0);
  const weights = options.map((option) => Math.exp(-poseDistance(leads, rawPose(option, 0)) / 0.35));
  return options[chooseWeighted(weights, random)];
}

function rawPose({ source, phase, mirrored }: BarStyle, beat: number): Float32Array {
  const pose = new Float32Array(JOINT_COUNT * 4);
  source.sampler.sample(phase + beat, pose, new Float32Array(3));
  return mirrored ? poseToQuaternions(mirrorPose(quaternionsToPose(pose))) : pose;
}

/** Mean angle between two poses' joints, radians. */
function poseDistance(a: Float32Array, b: Float32Array): number {
  let sum = 0;
  for (let i = 0; i < a.length; i += 4) sum += angleBetween(a.subarray(i, i + 4), b.subarray(i, i + 4));
  return sum / JOINT_COUNT;
}

function styledPose(style: BarStyle, beat: number, turn: number): Float32Array {
  const { mean } = style.source;
  const pose = rawPose(style, beat);
  const middle = style.mirrored ? poseToQuaternions(mirrorPose(quaternionsToPose(mean))) : mean;
  for (let i = 4; i < pose.length; i += 4) {
    const from = middle.subarray(i, i + 4);
    const away = quaternionToAxisAngle(multiply([-from[0], -from[1], -from[2], from[3]], pose.subarray(i, i + 4)));
    const scaled = axisAngleToQuaternion(Array.from(away, (v) => v * style.amplitude));
    multiply(from, scaled, pose.subarray(i, i + 4));
  }
  multiply(aboutY(turn), pose.subarray(0, 4), pose.subarray(0, 4));
  return pose;
}

/** Mean of a clip's poses: quaternion sums with aligned signs, normalised. */
function meanPose(clip: SeedClip): Float32Array {
  const poses = clip.poses.map((pose) => poseToQuaternions(pose));
  const mean = new Float32Array(JOINT_COUNT * 4);
  for (const pose of poses) {
    for (let i = 0; i < mean.length; i += 4) {
      let dot = 0;
      for (let k = i; k < i + 4; k++) dot += pose[k] * poses[0][k];
      for (let k = i; k < i + 4; k++) mean[k] += dot < 0 ? -pose[k] : pose[k];
    }
  }
  for (let i = 0; i < mean.length; i += 4) {
    const length = Math.hypot(mean[i], mean[i + 1], mean[i + 2], mean[i + 3]) || 1;
    for (let k = i; k < i + 4; k++) mean[k] /= length;
  }
  return mean;
}
