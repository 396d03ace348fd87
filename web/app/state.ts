/** Everything the page shows, as signals. Only the actions write them. */
import { computed, signal } from '@preact/signals';
import { createDocument } from '../core/document';
import spec from '../core/spec.json';
import type { Dials, ProjectDocument, SongReference } from '../core/document';
import type { BeatGrid, Features, KeyPose, LibraryPose, Motion, SeedClip, Waveform } from '../core/types';
import type { LoopRange } from '../audio/player';
import type { DanceResult, LoadProgress, ModelInfo } from './ports';
import type { DanceReport } from './report';

/** The song at hand. Its parts arrive one after another: sound, waveform, first beats, everything. */
export interface Song {
  reference: SongReference;
  buffer: AudioBuffer | null;
  waveform: Waveform | null;
  features: Features | null;
  /** As analysed; the document may correct it. */
  grid: BeatGrid | null;
  /** True when the whole song is analysed. */
  complete: boolean;
  demo: boolean;
}

/** A song on its way in. */
export interface SongJob {
  name: string;
  stage: 'reading' | 'decoding' | 'analysing';
  fraction: number;
}

/** What a dance was made from, to tell whether it is still up to date. */
export interface DanceInputs {
  keyPoses: readonly KeyPose[];
  grid: BeatGrid | null;
  dials: Dials;
}

/** The dance on stage. */
export interface Dance {
  motion: Motion;
  /** `preview` is the starting clip on the song's beats, shown until the model has something. */
  kind: 'demo' | 'preview' | 'generated';
  inputs: DanceInputs | null;
  result: Omit<DanceResult, 'motion'> | null;
}

/** What the generator is doing. */
export type Generation =
  | { status: 'idle' }
  | ({ status: 'loading' } & LoadProgress)
  | { status: 'running'; fraction: number; windows: number };

/** A message to the visitor. */
export interface Notice {
  id: number;
  kind: 'error' | 'info';
  text: string;
}

/** The pose in the editor. */
export interface PoseDraft {
  rotations: number[];
  /** The key pose being edited, or null for a new one. */
  keyId: string | null;
  name: string;
  joint: number | null;
  canUndo: boolean;
  canRedo: boolean;
}

/** What the timeline shows. */
export interface TimelineView {
  /** Seconds at the left edge. */
  start: number;
  pixelsPerSecond: number;
}

/** Makes the signals of one page. */
export function createState() {
  const document = signal<ProjectDocument>(createDocument());
  const song = signal<Song | null>(null);
  const dance = signal<Dance | null>(null);
  const seeds = signal<SeedClip[]>([]);
  const grid = computed(() => document.value.grid ?? song.value?.grid ?? null);
  const duration = computed(() => song.value?.reference.duration ?? 0);
  return {
    document,
    undoLabel: signal<string | null>(null),
    redoLabel: signal<string | null>(null),
    song,
    songJob: signal<SongJob | null>(null),
    poses: signal<LibraryPose[]>([]),
    seeds,
    model: signal<ModelInfo | null>(null),
    dance,
    /** Frames [0, partial.frames) of the dance being made; they are shown before the rest of the former one. */
    partial: signal<Motion | null>(null),
    generation: signal<Generation>({ status: 'idle' }),
    report: signal<DanceReport | null>(null),
    /** The beats in force: the visitor's corrections, else the analysis. */
    grid,
    duration,
    frames: computed(() => Math.ceil(duration.value * spec.fps)),
    seedClip: computed(
      () => seeds.value.find((clip) => clip.id === document.value.dials.seedClip) ?? seeds.value[0] ?? null,
    ),
    /** True when poses, beats or settings changed since the dance was made. */
    stale: computed(() => {
      const inputs = dance.value?.inputs;
      if (!inputs) return true;
      const now = document.value;
      return inputs.keyPoses !== now.keyPoses || inputs.dials !== now.dials || inputs.grid !== now.grid;
    }),
    playing: signal(false),
    time: signal(0),
    speed: signal(1),
    loop: signal<LoopRange | null>(null),
    volume: signal(0.9),
    muted: signal(false),
    selection: signal<ReadonlySet<string>>(new Set()),
    draft: signal<PoseDraft | null>(null),
    view: signal<TimelineView>({ start: 0, pixelsPerSecond: 40 }),
    viewWidth: signal(0),
    followPlayhead: signal(true),
    cameraFollows: signal(true),
    /** Counts the wishes to see the figure whole again. */
    frameRequests: signal(0),
    panel: signal<'poses' | 'dance'>('poses'),
    help: signal(false),
    notices: signal<Notice[]>([]),
    /** Read out by screen readers; not shown. */
    announcement: signal(''),
    ready: signal(false),
  };
}

/** The signals of one page. */
export type State = ReturnType<typeof createState>;
