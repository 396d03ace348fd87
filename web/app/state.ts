/** Everything the page shows, as signals. Only the actions write them. */
import { computed, signal } from '@preact/signals';
import { createDocument } from '../core/document';
import spec from '../core/spec.json';
import type { CurveDance, CurveTrack } from '../core/curves';
import type { CurveEdit } from '../core/curves-edit';
import type { ProjectDocument, SongReference, TimeRange } from '../core/document';
import type { UncorrectedDance } from '../core/finish';
import type { TradeOffPoint } from '../core/report-curves';
import type { BeatGrid, Features, KeyPose, LibraryPose, Motion, SeedClip, Snap, Waveform } from '../core/types';
import type { LoopRange } from '../audio/player';
import type { DanceResult, LoadProgress, ModelInfo } from './ports';
import { madeFrom, type DanceInputs } from './recipe';
import type { OwnPose } from './pose-store';
import type { DanceReport } from './report';
import type { VideoJob, VideoTab } from './actions/video';
import { createAvatarState } from './avatar-state';
import { createPoseState } from './pose-state';
import { createSuggestState } from './suggester';

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

/** The dance on stage. */
export interface Dance {
  motion: Motion;
  /** `preview` is the starting clip on the song's beats, shown until the model has something. */
  kind: 'demo' | 'preview' | 'generated';
  inputs: DanceInputs | null;
  result: Omit<DanceResult, 'motion' | 'uncorrected'> | null;
  /** What another key strength is made from without the network; where it is missing, only Generate changes the strength. */
  uncorrected?: UncorrectedDance;
  /** The strength that it is finished with, where that is known. */
  keyStrength?: number;
  /** True when the document's own dials made it, so that it is what they stand for. */
  byDials?: boolean;
  /** Engine `curves`: the curves as they were made, and the visitor's changes that `motion` has. */
  curves?: CurveDance;
  curveEdits?: readonly CurveEdit[];
}

/** Consistency against smoothness of a dance, as far as it is worked out. */
export interface TradeOff {
  /** The dance that it is of, and the key poses with the strengths that it is for. */
  of: UncorrectedDance;
  keyPoses: readonly KeyPose[];
  /** Ascending in strength. */
  points: TradeOffPoint[];
  complete: boolean;
}

/** A dance held for comparison (A) while the visitor works on (B). */
export interface Comparison {
  /** As it was when A was held. */
  document: ProjectDocument;
  dance: Dance;
  /** Which of the two is on stage. */
  shown: 'a' | 'b';
  /** B is on stage, and A dances beside it. */
  beside?: boolean;
  /** What was measured of A. */
  report?: DanceReport | null;
}

/** What the generator is doing. */
export type Generation =
  | { status: 'idle' }
  | ({ status: 'loading' } & LoadProgress)
  /** `range` is what is being made anew; without it the whole dance is. */
  | { status: 'running'; fraction: number; windows: number; range?: TimeRange };

/** A file on its way out. */
export interface ExportJob {
  format: string;
  /** 0..1 */
  fraction: number;
}

/** A message to the visitor. */
export interface Notice {
  id: number;
  kind: 'error' | 'info';
  text: string;
  /** What the visitor can do about it. */
  action?: NoticeAction;
}

/** A button of a message; the message goes when it is pressed. */
export interface NoticeAction {
  label: string;
  run(): void;
}

/** Taps on the beat so far. */
export interface Tapping {
  /** Song times, seconds, in the order tapped. */
  times: number[];
  /** Beats per minute, as soon as the taps tell. */
  tempo: number | null;
}

/** What the timeline shows. */
export interface TimelineView {
  /** Seconds at the left edge. */
  start: number;
  pixelsPerSecond: number;
}

/** What the inspector shows. */
export type Panel = 'poses' | 'dance' | 'report';

/** Makes the signals of one page. */
export function createState() {
  const document = signal<ProjectDocument>(createDocument());
  const song = signal<Song | null>(null);
  const dance = signal<Dance | null>(null);
  const compare = signal<Comparison | null>(null);
  const seeds = signal<SeedClip[]>([]);
  const grid = computed(() => document.value.grid ?? song.value?.grid ?? null);
  const duration = computed(() => song.value?.reference.duration ?? 0);
  const frames = computed(() => Math.ceil(duration.value * spec.fps));
  return {
    ...createSuggestState(),
    ...createPoseState(),
    ...createAvatarState(),
    document,
    undoLabel: signal<string | null>(null),
    redoLabel: signal<string | null>(null),
    song,
    songJob: signal<SongJob | null>(null),
    poses: signal<LibraryPose[]>([]),
    /** The visitor's own poses, newest first. */
    ownPoses: signal<OwnPose[]>([]),
    seeds,
    model: signal<ModelInfo | null>(null),
    dance,
    /** Frames [0, partial.frames) of the dance being made; they are shown before the rest of the former one. */
    partial: signal<Motion | null>(null),
    generation: signal<Generation>({ status: 'idle' }),
    compare,
    /** The dance on stage: that of now, or the held one while it is compared. */
    onStage: computed(() => (compare.value?.shown === 'a' ? compare.value.dance : dance.value)),
    report: signal<DanceReport | null>(null),
    /** The key strength under the visitor's finger, before it is let go. */
    strengthDraft: signal<number | null>(null),
    tradeOff: signal<TradeOff | null>(null),
    /** The curves of a joint under the timeline, to be edited. */
    curvesOpen: signal(false),
    curveTrack: signal<CurveTrack>(16),
    /** Kinetic velocity against the music (paper A, figure 9) on the timeline. */
    curvesShown: signal(false),
    /** The beats in force: the visitor's corrections, else the analysis. */
    grid,
    duration,
    frames,
    seedClip: computed(
      () => seeds.value.find((clip) => clip.id === document.value.dials.seedClip) ?? seeds.value[0] ?? null,
    ),
    /** True when poses, beats or settings changed since the dance was made. */
    stale: computed(() => {
      const shown = dance.value;
      return !shown?.inputs || !madeFrom(shown.inputs, document.value, shown.uncorrected !== undefined, frames.value);
    }),
    playing: signal(false),
    time: signal(0),
    speed: signal(1),
    loop: signal<LoopRange | null>(null),
    volume: signal(0.9),
    muted: signal(false),
    selection: signal<ReadonlySet<string>>(new Set()),
    /** Key poses and ranges go along when the beats are changed. */
    ripple: signal(true),
    /** Tap tempo under way, or null. */
    tapping: signal<Tapping | null>(null),
    /** A click on every beat. */
    metronome: signal(false),
    /** How many key poses are copied, ready to be pasted. */
    keysCopied: signal(0),
    /** What key poses snap to. */
    snap: signal<Snap>('beat'),
    /** The neighbouring key poses as ghosts beside the figure. */
    onionShown: signal(false),
    /** The joint whose path through time is drawn, or null. */
    pathJoint: signal<number | null>(null),
    view: signal<TimelineView>({ start: 0, pixelsPerSecond: 40 }),
    viewWidth: signal(0),
    followPlayhead: signal(true),
    cameraFollows: signal(true),
    /** Counts the wishes to see the figure whole again. */
    frameRequests: signal(0),
    panel: signal<Panel>('poses'),
    /** Small screens: whether the inspector is open; a large one shows it always. */
    sheetOpen: signal(true),
    help: signal(false),
    /** The export panel. */
    exportOpen: signal(false),
    /** The motion file that is being written, or null. */
    exportJob: signal<ExportJob | null>(null),
    /** The video panel. */
    videoOpen: signal(false),
    /** What the video panel makes. */
    videoTab: signal<VideoTab>('video'),
    /** The video that is being made, or null. */
    videoJob: signal<VideoJob | null>(null),
    /** The walk-through: which step is shown, from 0; null = none. */
    tour: signal<number | null>(null),
    notices: signal<Notice[]>([]),
    /** Another tab has this project: what is changed here is not kept. */
    elsewhere: signal(false),
    /** The project of a link, as it was opened; null = none was. */
    guest: signal<ProjectDocument | null>(null),
    /** The song that the dance of a link is to, while another stands in for it. */
    wanted: signal<SongReference | null>(null),
    /** How many projects were put aside in this browser when a link was opened. */
    aside: signal(0),
    /** Lets a newer page in; null = there is none. */
    update: signal<(() => Promise<void>) | null>(null),
    /** The visitor was told that letting it in now would lose work. */
    updateRisk: signal(false),
    /** The last save into this browser failed. */
    unkept: signal(false),
    /** The panel with the link. */
    shareOpen: signal(false),
    /** Read out by screen readers; not shown. */
    announcement: signal(''),
    ready: signal(false),
  };
}

/** The signals of one page. */
export type State = ReturnType<typeof createState>;
