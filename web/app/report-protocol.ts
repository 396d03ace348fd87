/** Messages between the page and the report worker. Every job has an id; of finishing and of plotting only the newest job counts. */
import type { FrameRange } from '../core/excerpt';
import type { UncorrectedDance } from '../core/finish';
import type { TradeOffPoint } from '../core/report-curves';
import type { BeatGrid, KeyPose, Motion } from '../core/types';
import type { DanceReport } from './report';

/** Page -> report worker. */
export type ReportRequest =
  | {
      type: 'measure';
      job: number;
      motion: Motion;
      keyPoses: readonly KeyPose[];
      grid: BeatGrid | null;
      /** What is danced of a trimmed song. */
      part: FrameRange | null;
    }
  /** The dance that later `finish` and `plot` jobs are about. */
  | { type: 'hold'; dance: UncorrectedDance; motion: Motion; keyPoses: readonly KeyPose[] }
  /** The key poses of the held dance have other strengths. */
  | { type: 'keys'; keyPoses: readonly KeyPose[] }
  /**
   * Finishes the held dance at another key strength. With `near` (a frame) a draft comes first: the dance as it was, but around that
   * frame already as it will be.
   */
  | { type: 'finish'; job: number; strength: number; grid: BeatGrid | null; near?: number }
  /** Works out consistency against smoothness of the held dance, point by point. */
  | { type: 'plot'; job: number; strengths: readonly number[] }
  | { type: 'cancel'; job: number };

/** Report worker -> page. */
export type ReportReply =
  | { type: 'report'; job: number; report: DanceReport }
  | { type: 'draft'; job: number; motion: Motion }
  | { type: 'finished'; job: number; motion: Motion; report: DanceReport }
  | { type: 'point'; job: number; point: TradeOffPoint }
  | { type: 'plotted'; job: number }
  /** Another job took its place, or it was cancelled. */
  | { type: 'dropped'; job: number }
  | { type: 'error'; job: number; message: string };
