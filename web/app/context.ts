/** What every action works on. */
import type { Player } from '../audio/player';
import type { ProjectDocument } from '../core/document';
import { withGrid } from '../core/features';
import type { History } from '../core/history';
import type { BeatGrid, Features } from '../core/types';
import type { Backend } from '../workers/protocol';
import type { Assets, Engine, Listener, Storage } from './ports';
import type { AvatarStore } from './avatar-store';
import type { MotionFileWriter } from './export-client';
import type { PoseStore } from './pose-store';
import type { Drawer } from './actions/stills';
import type { Filmer } from '../video/video-client';
import type { NoticeAction, State } from './state';
import type { Suggester } from './suggester';
import type { Tabs } from './tabs';

/** The rooms around the app. */
export interface Services {
  player: Player;
  listener: Listener;
  engine: Engine;
  /** Missing where no key poses can be suggested. */
  suggester?: Suggester;
  storage: Storage;
  assets: Assets;
  /** Missing: the browser's own. */
  poseStore?: PoseStore;
  /** Missing: the browser's own. */
  avatarStore?: AvatarStore;
  /** Missing: in a worker. */
  writeMotionFile?: MotionFileWriter;
  /** Missing: in a worker. */
  filmer?: Filmer;
  /** Missing: in a worker. */
  draw?: Drawer;
  /** Missing where there can be no other tab. */
  tabs?: Tabs;
  /** From `?backend=`. */
  forcedBackend?: Backend;
}

/** Shared by all groups of actions. */
export interface Context {
  state: State;
  services: Services;
  history: History<ProjectDocument>;
  /** Shows history's present in the state; to be called after every change of history. */
  sync(): void;
  /** One undoable change of the document. */
  change(label: string, edit: (document: ProjectDocument) => ProjectDocument): void;
  notify(kind: 'error' | 'info', text: string, action?: NoticeAction): void;
  /** For screen readers. */
  announce(text: string): void;
  /** Features and beats of the whole song, waiting for the analysis where it still runs. */
  analysed(): Promise<{ features: Features; grid: BeatGrid }>;
}

/** Music to dance to: what was heard, on the visitor's own beat grid where there is one. */
export function onGrid(heard: { features: Features; grid: BeatGrid }, own: BeatGrid | null) {
  return own ? { features: withGrid(heard.features, own), grid: own } : heard;
}

/** True for the error of a cancelled job. */
export function isAbort(error: unknown): boolean {
  return error instanceof Error && error.name === 'AbortError';
}

/** The message of whatever was thrown. */
export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** Lets the browser paint and handle input before the work goes on. */
export function breathe(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, 0));
}
