/** What one step of the key pose model is given: the poses before a beat, the music around it, the key pose that lies ahead. */
import { beatMusic, BEAT_MUSIC_SIZE } from './beat-features';
import { joinRow, poseOfRow, ROW_SIZE, rowOfPose } from './suggest-pose';
import { spec } from './spec';
import type { BeatGrid, Features } from './types';

const { pastPoses, pastBeats, futureBeats, codes, farthestFixedBeats } = spec.danceformer.suggest;
const MUSIC_BEATS = pastBeats + 1 + futureBeats;
const STYLES = spec.danceformer.styles;
const ROTATION_SIZE = spec.model.rotationSize;

/**
 * The network's temperature at the ends of the variation dial: calm, and bold. Half way, at 1, poses move from beat to beat and differ
 * as they do in real dance.
 */
export const TEMPERATURES = [0.7, 1.3] as const;

/** Temperature of a variation, 0..1. */
export function temperatureOf(variation: number): number {
  return TEMPERATURES[0] + (TEMPERATURES[1] - TEMPERATURES[0]) * Math.min(Math.max(variation, 0), 1);
}

/** A key pose that stays. */
export interface Fixed {
  /** Beats since the first one, with fractions. */
  at: number;
  /** As `rowOfPose` has it. */
  row: Float32Array;
}

/** Inputs of the network by their names; the first dimension is the number of samples. */
export type StepInputs = Record<string, { data: Float32Array; dims: number[] }>;

/** Remembers the poses so far and makes the inputs of each step. */
export class StepContext {
  private readonly music: Float32Array;
  private readonly style: Float32Array;
  /** Pose with root of each beat that is done. */
  private readonly done = new Map<number, Float32Array>();
  /** Key poses that stay, ascending. */
  private readonly ahead: Fixed[];

  /**
   * @param fixed key poses that stay, by their nearest beat
   * @throws Error for features without MFCC or a style that is none
   */
  constructor(
    features: Features,
    private readonly grid: BeatGrid,
    private readonly fixed: ReadonlyMap<number, Fixed>,
    style?: string,
  ) {
    this.music = beatMusic(features, grid);
    this.style = new Float32Array(STYLES.length);
    if (style !== undefined) {
      const index = STYLES.indexOf(style);
      if (index < 0) throw new Error(`There is no style "${style}": use one of ${STYLES.join(', ')}, or none.`);
      this.style[index] = 1;
    }
    this.ahead = [...fixed.values()].sort((a, b) => a.at - b.at);
  }

  /**
   * Inputs for the pose on a beat; the beats before it must have been taken, or none of them.
   * @param noise one row of 512 for each sample
   */
  inputs(beat: number, temperature: number, noise: readonly Float32Array[]): StepInputs {
    const poses = new Float32Array(pastPoses * ROW_SIZE);
    const poseMask = new Float32Array(pastPoses);
    for (let back = 1; back <= pastPoses; back++) {
      const row = this.done.get(beat - back);
      if (!row) break;
      poses.set(row, (pastPoses - back) * ROW_SIZE);
      poseMask[pastPoses - back] = 1;
    }
    const music = new Float32Array(MUSIC_BEATS * BEAT_MUSIC_SIZE);
    const musicMask = new Float32Array(MUSIC_BEATS);
    for (let i = 0; i < MUSIC_BEATS; i++) {
      const k = beat - pastBeats + i;
      if (k < 0 || k >= this.grid.beats.length) continue;
      music.set(this.music.subarray(k * BEAT_MUSIC_SIZE, (k + 1) * BEAT_MUSIC_SIZE), i * BEAT_MUSIC_SIZE);
      musicMask[i] = 1;
    }
    const next = this.ahead.find(({ at }) => at > beat + 1e-6);
    const near = next !== undefined && next.at - beat <= farthestFixedBeats;
    const batch = noise.length;
    const every = (data: Float32Array, ...dims: number[]) => {
      const all = new Float32Array(batch * data.length);
      for (let i = 0; i < batch; i++) all.set(data, i * data.length);
      return { data: all, dims: [batch, ...dims] };
    };
    const scattered = new Float32Array(batch * codes);
    noise.forEach((row, i) => scattered.set(row, i * codes));
    return {
      poses: every(poses, pastPoses, ROW_SIZE),
      pose_mask: every(poseMask, pastPoses),
      music: every(music, MUSIC_BEATS, BEAT_MUSIC_SIZE),
      music_mask: every(musicMask, MUSIC_BEATS),
      next_pose: every(near ? next.row.subarray(0, ROTATION_SIZE) : new Float32Array(ROTATION_SIZE), ROTATION_SIZE),
      next_beats: every(Float32Array.of(near ? next.at - beat : -1)),
      style: every(this.style, STYLES.length),
      temperature: every(Float32Array.of(temperature)),
      noise: { data: scattered, dims: [batch, codes] },
    };
  }

  /**
   * Goes on with a pose of the network, brought inside the joints' limits; on the beat of a key pose that stays, with that pose and the
   * network's root.
   * @returns the pose as a key pose has it, 24 x 3 axis-angle, radians
   */
  take(beat: number, output: ArrayLike<number>): number[] {
    const rotations = poseOfRow(output);
    const row = new Float32Array(ROW_SIZE);
    joinRow(this.fixed.get(beat)?.row ?? rowOfPose(rotations), output, this.done.get(beat - 1), row);
    this.done.set(beat, row);
    return rotations;
  }
}
