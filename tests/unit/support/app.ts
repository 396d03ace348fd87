/** Rooms around the app that answer at once. */
import type { Player } from '../../../web/audio/player';
import type { Services } from '../../../web/app/context';
import type { DanceReport } from '../../../web/app/report';
import type { Reporter } from '../../../web/app/report-client';
import { emptyMotion } from '../../../web/core/motion';
import { spec } from '../../../web/core/spec';
import type { Features, SeedClip } from '../../../web/core/types';

export type { Services } from '../../../web/app/context';
export type { DanceResult } from '../../../web/app/ports';
export type { DanceRequest } from '../../../web/workers/protocol';

/** Length of every fake song, seconds. */
export const SONG_SECONDS = 10;

/** Lets all promises and timers of zero run. */
export async function settled(): Promise<void> {
  for (let i = 0; i < 20; i += 1) await new Promise((resolve) => setTimeout(resolve, 0));
}

const frames = SONG_SECONDS * spec.fps;
const features: Features = {
  fps: spec.fps,
  names: spec.features.names,
  frames,
  data: new Float32Array(frames * spec.features.names.length),
};
const beats = Array.from({ length: SONG_SECONDS * 2 }, (_, i) => i / 2);
const grid = { tempo: 120, beatsPerBar: 4 as const, beats, downbeats: beats.filter((_, i) => i % 4 === 0) };
const waveform = { rate: 10, min: new Float32Array(100), max: new Float32Array(100) };
const clip: SeedClip = {
  id: 'still',
  name: 'Still',
  description: 'Stands.',
  beats: 1,
  rate: 1,
  poses: [new Array<number>(72).fill(0)],
  root: [[0, 0.96, 0]],
};

/** A report of nothing in particular. */
export const fakeReport: DanceReport = {
  consistencyError: 0,
  consistencyPerKey: [],
  smoothness: 1,
  jerk: 1,
  beatHitRate: [1, 1, 1, 1, 1],
  beatConsistency: 1,
  longestFreeze: 0,
  footSkate: 0,
  speed: new Float32Array(0),
  meanSpeed: 0,
  motionBeats: [],
};

/** A report worker that answers at once: finishing gives an empty dance as long as the other. */
export function fakeReporter(): Reporter {
  return {
    measure: () => Promise.resolve(fakeReport),
    finish: ({ motion }) => Promise.resolve({ motion: emptyMotion(motion.frames), report: fakeReport }),
    plot: () => Promise.resolve(),
  };
}

/** Services without demo, storage or sound. */
export function fakeServices(player: Player): Services {
  return {
    player,
    listener: {
      decode: async () => ({ buffer: { duration: SONG_SECONDS } as AudioBuffer, duration: SONG_SECONDS }),
      analyse: async (_, hooks, signal) => {
        hooks.onHead?.(features, grid);
        await settled();
        signal.throwIfAborted();
        return { features, grid, waveform, milliseconds: 1 };
      },
    },
    engine: {
      load: async () => ({ backend: 'wasm', threads: 1, model: 'light', reason: 'It is a test.' }),
      generate: async (request, _, signal) => {
        await settled();
        signal.throwIfAborted();
        return { motion: emptyMotion(request.frames), backend: 'wasm', model: 'light', windows: 1, milliseconds: 5 };
      },
    },
    storage: {
      saveDocument: async () => undefined,
      saveDance: async () => undefined,
      saveSong: async () => undefined,
      loadSong: async () => null,
      load: async () => null,
    },
    assets: {
      poses: async () => [],
      seeds: async () => [clip],
      demo: () => Promise.reject(new Error('no demo')),
    },
  };
}
