/** Data shapes that every room of the house shares. Units: seconds, metres, radians; quaternions are x y z w. */

/** A dance. */
export interface Motion {
  /** Frames per second. */
  fps: number;
  frames: number;
  /** Pelvis position, frames x 3, metres, Y up, floor at y = 0. */
  root: Float32Array;
  /** Local joint rotations, frames x 24 x 4 (x y z w); joint 0 is the world orientation. */
  quaternions: Float32Array;
}

/** One frame of a dance. */
export interface FramePose {
  /** Pelvis position, 3 numbers, metres. */
  root: ArrayLike<number>;
  /** 24 x 4 (x y z w). */
  quaternions: ArrayLike<number>;
}

/** Music features at spec.fps; columns in the order of spec.features.names. */
export interface Features {
  fps: number;
  names: readonly string[];
  frames: number;
  /** frames x 15, row-major. */
  data: Float32Array;
  /** frames x 14: 13 MFCC and the energy in decibels, as they are (mfcc.ts); what key poses are suggested from. */
  timbre?: Float32Array;
}

/** Beats of a song. */
export interface BeatGrid {
  /** Beats per minute. */
  tempo: number;
  beatsPerBar: 3 | 4;
  /** Seconds, ascending. */
  beats: number[];
  /** Seconds, a subset of beats. */
  downbeats: number[];
}

/** A pose that the dance must pass through. */
export interface KeyPose {
  id: string;
  /** Seconds from the start of the song. */
  time: number;
  /** 24 x 3 axis-angle, radians, SMPL joint order; joint 0 is the world orientation. */
  rotations: number[];
  name?: string;
  /** Moves and deletions of many at once pass it by. */
  locked?: true;
  /** 0..1, times the dial's key strength; missing = 1. */
  strength?: number;
  /** Suggested, and not touched by the visitor since: the next suggestion may put another in its place. */
  suggested?: true;
}

/** Lowest and highest sample of each bucket of a song, for drawing it. */
export interface Waveform {
  /** Buckets per second. */
  rate: number;
  min: Float32Array;
  max: Float32Array;
}

/** A named pose of the library (public/library/poses.json). */
export interface LibraryPose {
  id: string;
  name: string;
  group: string;
  /** 24 x 3 axis-angle, radians. */
  rotations: number[];
}

/**
 * A starting clip (public/library/seeds.json): poses on a beat grid, joined by a smooth curve, so that it can be played at any tempo.
 * It loops: the pose at beat `beats` equals the pose at beat 0.
 */
export interface SeedClip {
  id: string;
  name: string;
  description: string;
  /** Length in beats. */
  beats: number;
  /** Poses per beat. */
  rate: number;
  /** beats x rate poses, each 24 x 3 axis-angle, radians. */
  poses: number[][];
  /** beats x rate pelvis positions x y z, metres (x, z start at 0; feet on the floor). */
  root: [number, number, number][];
}

/** How the pose editor works on the figure. */
export interface PoseTools {
  /** `move` drags the joint and lets the body follow (inverse kinematics). */
  mode: 'rotate' | 'move';
  space: 'local' | 'world';
  /** Joints stay inside the human range of motion. */
  limits: boolean;
  /** What is done to one side is done to the other, mirrored. */
  mirror: boolean;
  /** Joints that stay where they are while others are moved. */
  pins: ReadonlySet<number>;
  /** Shows the centre of mass over the feet. */
  balance: boolean;
}

/** What key poses snap to when they are placed or dragged. */
export type Snap = 'beat' | 'half' | 'bar' | 'off';
