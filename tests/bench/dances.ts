/** Whole dances by the shipped models in Node, from sound to curves, as the page makes them: for measures and for other people's readers. */
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import * as ort from 'onnxruntime-web';
import { generateCurves } from '../../web/core/curves-dance';
import type { CurveDance } from '../../web/core/curves';
import { analyse } from '../../web/core/features';
import { suggestPoses, type Density } from '../../web/core/suggest';
import type { KeyPose, Motion, SeedClip } from '../../web/core/types';
import { generateMotion } from '../../web/core/windows';
import { intervalFeeds, intervalOutputs } from '../../web/workers/curves-engine';
import { openNetwork } from '../../web/workers/onnx-network';
import { openSession } from '../../web/workers/onnx-session';

const RATE = 44100;
const file = (name: string) => readFileSync(new URL(`../../public/${name}`, import.meta.url));

/** Mono sound. */
export interface Sound {
  samples: Float32Array;
  rate: number;
}

/** Reads a song with ffmpeg. */
export function decode(path: string): Sound {
  const bytes = execFileSync(
    'ffmpeg',
    ['-v', 'error', '-i', path, '-f', 'f32le', '-ac', '1', '-ar', String(RATE), '-'],
    { maxBuffer: 2 ** 31 - 1 },
  );
  return {
    samples: new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)),
    rate: RATE,
  };
}

/** The same key poses, suggested for the song, danced by both engines. */
export interface Dances {
  keyPoses: KeyPose[];
  curves: CurveDance;
  /** The curves at the spec's rate. */
  curved: Motion;
  /** Engine light; missing unless wished. */
  light?: Motion;
}

/**
 * Suggests key poses for a song and dances through them.
 * @param options how many key poses, the seed of everything, and whether engine light dances too
 */
export async function danceTo(
  { samples, rate }: Sound,
  { density = 'half', seed = 1, light = false }: { density?: Density; seed?: number; light?: boolean } = {},
): Promise<Dances> {
  ort.env.wasm.numThreads = 1;
  const { features, grid } = analyse(samples, rate);
  const duration = samples.length / rate;
  const suggest = await openNetwork(ort, 'wasm', file('models/suggest.onnx'));
  const range = { start: 0, end: duration - 0.1 };
  const found = await suggestPoses(
    { features, grid, keyPoses: [], density, range, variation: 0.5, seed },
    async (inputs) => {
      const { pose, code } = await suggest.run(inputs);
      return { poses: pose, codes: code };
    },
  );
  await suggest.close();
  const keyPoses = found.map((pose, i): KeyPose => ({ id: `k${i + 1}`, ...pose, suggested: true }));
  const { clips } = JSON.parse(file('library/seeds.json').toString()) as { clips: SeedClip[] };
  const request = {
    features,
    grid,
    frames: features.frames,
    keyPoses,
    seedClip: clips[0],
    otherClips: clips,
    options: { keyStrength: 1, variation: 0.3, seed, cleanFeet: true },
  };
  const network = await openNetwork(ort, 'wasm', file('models/curves.onnx'));
  const { curves, motion: curved } = await generateCurves(request, async (inputs) =>
    intervalOutputs(await network.run(intervalFeeds(inputs)), inputs.intervals),
  );
  await network.close();
  if (!light) return { keyPoses, curves, curved };
  const session = await openSession(ort, 'wasm', file('models/light.onnx'));
  const made = await generateMotion(request, (inputs) => session.run(inputs));
  await session.close();
  return { keyPoses, curves, curved, light: made };
}
