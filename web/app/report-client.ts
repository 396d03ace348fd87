/** Asks the report worker. */
import type { BeatGrid, KeyPose, Motion } from '../core/types';
import type { DanceReport } from './report';
import ReportWorker from './report.worker?worker';

/** Measures a dance off the main thread; the motion is copied. */
export type Measure = (motion: Motion, keyPoses: readonly KeyPose[], grid: BeatGrid | null) => Promise<DanceReport>;

/** Makes a measuring function with a worker of its own, started at the first call. */
export function createMeasure(): Measure {
  let worker: Worker | null = null;
  let jobs = 0;
  const waiting = new Map<number, (report: DanceReport) => void>();
  return (motion, keyPoses, grid) => {
    if (!worker) {
      worker = new ReportWorker();
      worker.onmessage = (event: MessageEvent<{ job: number; report: DanceReport }>) => {
        waiting.get(event.data.job)?.(event.data.report);
        waiting.delete(event.data.job);
      };
    }
    const job = (jobs += 1);
    return new Promise((resolve) => {
      waiting.set(job, resolve);
      worker!.postMessage({ job, motion, keyPoses, grid });
    });
  };
}
