/** Messages between the page and its workers: one typed union a direction. Every message carries the id of its job. */
import type { CurveDance } from '../core/curves';
import type { CurveTake } from '../core/curves-dance';
import type { EngineName } from '../core/document';
import type { UncorrectedDance } from '../core/finish';
import type { BeatGrid, Features, KeyPose, Motion, SeedClip, Waveform } from '../core/types';

export type Backend = 'webgpu' | 'wasm';

/** Page -> analyse worker. A song arrives in chunks so that no copy blocks the page. */
export type AnalyseRequest =
  | { type: 'begin'; job: number; sampleRate: number; samples: number }
  /** Mono samples that follow those sent before; the array is transferred. */
  | { type: 'chunk'; job: number; pcm: Float32Array }
  | { type: 'cancel'; job: number };

/** Everything found in a song, and how long it took in the worker. */
export interface Analysis {
  features: Features;
  grid: BeatGrid;
  waveform: Waveform;
  milliseconds: number;
}

/** Analyse worker -> page. */
export type AnalyseReply =
  | { type: 'progress'; job: number; fraction: number; waveform?: Waveform }
  /** Features of the first seconds, while the rest is worked on. */
  | { type: 'head'; job: number; features: Features; grid: BeatGrid }
  | ({ type: 'result'; job: number } & Analysis)
  | { type: 'cancelled'; job: number }
  | { type: 'error'; job: number; message: string };

/** The dials of a generation. */
export interface GenerateOptions {
  /** 0 = the network alone, 1 = key poses are hit exactly. */
  keyStrength: number;
  /** 0..1: how far the dance may stray from the plain one. */
  variation: number;
  /** Integer; the same seed always gives the same dance. */
  seed: number;
  /** Foot contact clean-up. */
  cleanFeet: boolean;
}

/** A dance to be made. */
export interface DanceRequest {
  features: Features;
  grid: BeatGrid;
  /** ceil(duration x fps). */
  frames: number;
  keyPoses: KeyPose[];
  seedClip: SeedClip;
  /** Clips that poses are borrowed from as variation grows. */
  otherClips?: SeedClip[];
  options: GenerateOptions;
  /** The part of the song to dance to; all other frames count in the whole song. */
  trim?: { from: number; to: number };
  /** Frames [from, to) are made anew; the rest stays as in the dance so far. */
  range?: { from: number; to: number };
  /** The dance so far as it is shown; without it the uncorrected form is finished anew. */
  previous?: Motion;
  /** The uncorrected form of the dance so far. */
  previousUncorrected?: UncorrectedDance;
  /** Missing = light. */
  engine?: EngineName;
  /** Engine `curves` only: ranges with takes of their own, all in one go. */
  takes?: CurveTake[];
}

/** Page -> generate worker. */
export type GenerateRequest =
  /** Loads onnxruntime and the model, and checks the backend with one golden window. `backend` forces one. */
  | { type: 'load'; job: number; baseUrl: string; backend?: Backend; threads?: number; engine?: EngineName }
  | ({ type: 'generate'; job: number } & DanceRequest)
  | { type: 'cancel'; job: number };

/** How far the download of the model is. */
export interface LoadProgress {
  fraction: number;
  bytes: number;
  totalBytes: number;
  cached: boolean;
}

/** How the loaded model runs. */
export interface ModelInfo {
  backend: Backend;
  threads: number;
  model: string;
  /** Why this backend, in a sentence. */
  reason: string;
}

/** A finished dance and how it was made. */
export interface DanceResult {
  motion: Motion;
  /** What another key strength is made from without the network; a range has one only where the rest has. */
  uncorrected?: UncorrectedDance;
  /** Engine `curves`: the curves that the motion is sampled from. */
  curves?: CurveDance;
  backend: Backend;
  model: string;
  windows: number;
  milliseconds: number;
}

/** Generate worker -> page. */
export type GenerateReply =
  | ({ type: 'loading'; job: number } & LoadProgress)
  | ({ type: 'loaded'; job: number } & ModelInfo)
  /** The dance so far: frames [0, motion.frames) can be played; a range comes only as a whole, so until then there is none. */
  | { type: 'partial'; job: number; motion: Motion | null; fraction: number; windows: number }
  | ({ type: 'result'; job: number } & DanceResult)
  | { type: 'cancelled'; job: number }
  | { type: 'error'; job: number; message: string };
