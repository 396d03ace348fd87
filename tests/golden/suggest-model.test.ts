import { readFileSync } from 'node:fs';
import * as ort from 'onnxruntime-web';
import { describe, expect, it } from 'vitest';
import { specHash } from '../../web/core/spec';
import { suggestPoses, type StepRunner } from '../../web/core/suggest';
import { poseDistance } from '../../web/core/suggest-pose';
import { analyse } from '../../web/core/features';
import { parseGoldenRun, type GoldenHeader, type ModelManifest } from '../../web/workers/model-store';
import { goldenRunError, openNetwork } from '../../web/workers/onnx-network';
import { synthesise } from '../e2e/support/songs';

ort.env.wasm.numThreads = 1;
const file = (name: string) => readFileSync(new URL(`../../public/models/${name}`, import.meta.url));
const bytes = (name: string) => new Uint8Array(file(name));
const manifest = JSON.parse(file('suggest.json').toString()) as ModelManifest;
const header = JSON.parse(file('suggest.golden.json').toString()) as GoldenHeader;
const run = parseGoldenRun(header, bytes('suggest.golden.bin').buffer, manifest);

/** Opening a session is slow on a busy machine. */
const PATIENCE = 120_000;

describe('the shipped key pose model', () => {
  it(
    'is of this spec, gives what Python gave, and is told from a wrong one',
    async () => {
      expect(manifest.specHash).toBe(specHash);
      const network = await openNetwork(ort, 'wasm', bytes('suggest.onnx'));
      expect(await goldenRunError(network, run)).toBeLessThan(1e-3);
      const pose = run.outputs.pose.map((v, i) => (i === 100 ? v + 0.05 : v));
      expect(await goldenRunError(network, { ...run, outputs: { ...run.outputs, pose } })).toBeGreaterThan(0.04);

      // A song of ten seconds: poses that move, whatever the seed.
      const step: StepRunner = async (inputs) => {
        const { pose: poses, code: codes } = await network.run(inputs);
        return { poses, codes };
      };
      const { features, grid } = analyse(synthesise({ seconds: 10 }), 44100);
      const request = {
        features,
        grid,
        keyPoses: [],
        density: 'beat',
        range: { start: 0, end: 10 },
        variation: 0.5,
      } as const;
      const found = await suggestPoses({ ...request, seed: 1 }, step);
      expect(found.length).toBeGreaterThan(15);
      const ways = found.slice(1).map(({ rotations }, i) => poseDistance(rotations, found[i].rotations));
      expect(ways.reduce((a, b) => a + b, 0) / ways.length).toBeGreaterThan(0.03);
      expect(Math.max(...ways)).toBeLessThan(0.8);
      await network.close();
    },
    PATIENCE,
  );
});
