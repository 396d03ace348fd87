/** Measures dances off the main thread. */
import type { BeatGrid, KeyPose, Motion } from '../core/types';
import { measureDance } from './report';

self.onmessage = (event: MessageEvent<{ job: number; motion: Motion; keyPoses: KeyPose[]; grid: BeatGrid | null }>) => {
  const { job, motion, keyPoses, grid } = event.data;
  postMessage({ job, report: measureDance(motion, keyPoses, grid) });
};
