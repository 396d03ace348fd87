/** Seed clips: loops of poses on beats, played at any tempo. */
import { beatPhase } from './beat-phase';
import { keepAboveFloor } from './contact-floor';
import { catmullRomWeights } from './interpolate';
import { emptyMotion } from './motion';
import { poseToQuaternions } from './rotation';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { BeatGrid, Motion, SeedClip } from './types';

const POSE = JOINT_COUNT * 4;

/** A seed clip ready to be sampled at any beat count. */
export interface SeedSampler {
  /** Length of the loop, beats. */
  beats: number;
  /** Writes the pose at a beat count (any real number; the clip loops): 24 x 4 and pelvis position. */
  sample(beat: number, quaternions: Float32Array, root: Float32Array): void;
}

/**
 * Prepares a clip. Between its poses runs a Catmull-Rom curve (continuous velocity) through sign-aligned quaternions.
 * @throws Error when the clip has not beats x rate poses and positions
 */
export function seedSampler(clip: SeedClip): SeedSampler {
  const count = Math.round(clip.beats * clip.rate);
  if (!(count > 0) || clip.poses.length !== count || clip.root.length !== count) {
    throw new Error(
      `The starting clip "${clip.name}" should have ${count} poses and positions but has ${clip.poses.length} and ${clip.root.length}.`,
    );
  }
  const poses = clip.poses.map((pose) => poseToQuaternions(pose));
  return {
    beats: clip.beats,
    sample(beat, quaternions, root) {
      const position = beat * clip.rate;
      const whole = Math.floor(position);
      const weights = catmullRomWeights(position - whole);
      const around = [-1, 0, 1, 2].map((step) => (((whole + step) % count) + count) % count);
      const [a, b, c, d] = around.map((i) => poses[i]);
      for (let i = 0; i < POSE; i += 4) {
        const near = (q: Float32Array) => (dot4(q, b, i) < 0 ? -1 : 1);
        const [wa, wb, wc, wd] = [weights[0] * near(a), weights[1], weights[2] * near(c), weights[3] * near(d)];
        let square = 0;
        for (let k = i; k < i + 4; k++) {
          quaternions[k] = wa * a[k] + wb * b[k] + wc * c[k] + wd * d[k];
          square += quaternions[k] * quaternions[k];
        }
        const scale = 1 / Math.sqrt(square);
        for (let k = i; k < i + 4; k++) quaternions[k] *= scale;
      }
      for (let k = 0; k < 3; k++) {
        root[k] = around.reduce((sum, index, n) => sum + weights[n] * clip.root[index][k], 0);
      }
    },
  };
}

function dot4(a: Float32Array, b: Float32Array, i: number): number {
  return a[i] * b[i] + a[i + 1] * b[i + 1] + a[i + 2] * b[i + 2] + a[i + 3] * b[i + 3];
}

/** Where a seed clip starts playing. */
export interface SeedOptions {
  /** Song time of the first frame, seconds; may be negative. Default 0. */
  startTime?: number;
}

/**
 * A seed clip danced to a song: its beat 0 falls on the song's first downbeat, its beats on the song's beats.
 * @param frames length, at the spec's rate
 * @returns a dance that stays on or above the floor
 * @throws Error when the clip is malformed
 */
export function seedMotion(clip: SeedClip, grid: BeatGrid, frames: number, options: SeedOptions = {}): Motion {
  const sampler = seedSampler(clip);
  const phase = beatPhase(grid);
  const motion = emptyMotion(frames);
  for (let t = 0; t < frames; t++) {
    const beat = phase.at((options.startTime ?? 0) + t / spec.fps);
    sampler.sample(
      beat,
      motion.quaternions.subarray(t * POSE, t * POSE + POSE),
      motion.root.subarray(t * 3, t * 3 + 3),
    );
  }
  keepAboveFloor(motion);
  return motion;
}
