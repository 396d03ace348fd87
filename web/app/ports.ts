/** What the app needs from the rooms around it; `main.ts` plugs the real ones in, tests plug in their own. */
import type { UncorrectedDance } from '../core/finish';
import type { BeatGrid, Features, LibraryPose, Motion, SeedClip, Waveform } from '../core/types';
import type { Analysis, Backend, DanceRequest, DanceResult, LoadProgress, ModelInfo } from '../workers/protocol';
import type { CurveDance } from '../core/curves';
import type { CurveEdit } from '../core/curves-edit';
import type { EngineName, ProjectDocument } from '../core/document';
import type { DanceInputs } from './recipe';

export type { DanceResult, LoadProgress, ModelInfo } from '../workers/protocol';

/** A song as the browser decoded it. */
export interface DecodedSong {
  buffer: AudioBuffer;
  /** Seconds. */
  duration: number;
}

/** What the analyse worker tells on its way. */
export interface AnalyseHooks {
  onProgress?: (fraction: number, waveform?: Waveform) => void;
  /** Features and beats of the first seconds. */
  onHead?: (features: Features, grid: BeatGrid) => void;
}

/** The generate worker, seen from the app. */
export interface Engine {
  /** Loads a model once; asking again for the same backend is free. */
  load(
    backend: Backend | undefined,
    onProgress: (progress: LoadProgress) => void,
    engine?: EngineName,
  ): Promise<ModelInfo>;
  /** Rejects with an AbortError when `signal` fires. */
  generate(
    request: DanceRequest,
    onPartial: (motion: Motion | null, fraction: number, windows: number) => void,
    signal: AbortSignal,
  ): Promise<DanceResult>;
}

/** Songs to sound and features. */
export interface Listener {
  /** The bytes are taken over. */
  decode(bytes: ArrayBuffer, signal: AbortSignal): Promise<DecodedSong>;
  /** Rejects with an AbortError when `signal` fires. */
  analyse(buffer: AudioBuffer, hooks: AnalyseHooks, signal: AbortSignal): Promise<Analysis>;
}

/** A dance as it is kept for the next visit. */
export interface SavedDance {
  /** Of its song. */
  hash: string;
  motion: Motion;
  uncorrected?: UncorrectedDance;
  keyStrength?: number;
  /** True when the document's own dials made it. */
  byDials?: boolean;
  /** What it was made from; where this is missing, what the document holds now. */
  inputs?: DanceInputs;
  curves?: CurveDance;
  curveEdits?: readonly CurveEdit[];
}

/** The browser's own storage; every method tolerates its absence by rejecting. */
export interface Storage {
  saveDocument(document: ProjectDocument): Promise<void>;
  /** Writes a document down before it returns, for a page that may not live to see it saved; saving it takes the note away. */
  noteDocument?(document: ProjectDocument): void;
  saveDance(dance: SavedDance): Promise<void>;
  saveSong(hash: string, song: Blob): Promise<void>;
  loadSong(hash: string): Promise<Blob | null>;
  load(): Promise<{ document: unknown; dance: SavedDance | null } | null>;
  /** Keeps a project apart from the one that is saved; the oldest go. Resolves with how many there are. */
  setAside?(document: ProjectDocument): Promise<number>;
  /** Takes the project that was put aside last; null where there is none. */
  takeAside?(): Promise<{ document: unknown; left: number } | null>;
  countAside?(): Promise<number>;
  /** Asks the browser not to clear this away by itself. Resolves with its answer. */
  persist?(): Promise<boolean>;
}

/** The opening demo. */
export interface Demo {
  document: ProjectDocument;
  motion: Motion;
  songUrl: string;
}

/** Files that come with the page. */
export interface Assets {
  poses(): Promise<LibraryPose[]>;
  seeds(): Promise<SeedClip[]>;
  demo(): Promise<Demo>;
}
