import { readFileSync } from 'node:fs';
import * as ort from 'onnxruntime-web';
import { describe, expect, it } from 'vitest';
import { FRAME_FEATURE_SIZE } from '../../web/core/beat-features';
import { emptyCurves } from '../../web/core/curves';
import { generateCurves, intervalInputs } from '../../web/core/curves-dance';
import { consistencyError } from '../../web/core/metrics';
import { TIMBRE_SIZE } from '../../web/core/mfcc';
import { specHash } from '../../web/core/spec';
import { CURVES_KIND, intervalFeeds, intervalOutputs } from '../../web/workers/curves-engine';
import { parseGoldenRun, type GoldenHeader, type ModelManifest } from '../../web/workers/model-store';
import { goldenRunError, openNetwork } from '../../web/workers/onnx-network';
import { danceRequest, key } from '../unit/dance';
import { fourPoses } from '../e2e/support/page';
import { agree, golden } from './golden';

ort.env.wasm.numThreads = 1;
const shipped = (name: string) => new Uint8Array(readFileSync(new URL(`../../public/models/${name}`, import.meta.url)));
const json = <T>(name: string) => JSON.parse(new TextDecoder().decode(shipped(name))) as T;
const manifest = json<ModelManifest>(CURVES_KIND.files.manifest);
const network = () => openNetwork(ort, 'wasm', shipped(manifest.file));

describe('the shipped curves model', () => {
  it('is made for this spec, and gives in onnxruntime-web what it gave in Python', async () => {
    expect(manifest.specHash).toBe(specHash);
    const run = parseGoldenRun(
      json<GoldenHeader>(`${CURVES_KIND.files.golden}.json`),
      shipped(`${CURVES_KIND.files.golden}.bin`).buffer,
      manifest,
    );
    const model = await network();
    expect(Object.keys(run.feeds).sort()).toEqual(Object.keys(intervalFeeds(inputs())).sort());
    expect(await goldenRunError(model, run)).toBeLessThan(CURVES_KIND.tolerance);
    await model.close();
  });

  it('makes a whole dance that runs through its key poses', async () => {
    const model = await network();
    const { features, ...rest } = danceRequest(8);
    const timbre = Float32Array.from({ length: features.frames * TIMBRE_SIZE }, (_, i) => Math.sin(i * 0.37));
    const keyPoses = fourPoses().map((pose, i) => key(1.3 + i, pose));
    const { motion, curves } = await generateCurves(
      { ...rest, keyPoses, features: { ...features, timbre } },
      async (each) => intervalOutputs(await model.run(intervalFeeds(each)), each.intervals),
    );
    expect(consistencyError(motion, keyPoses)).toBeLessThan(1e-9);
    expect(motion.quaternions.every(Number.isFinite)).toBe(true);
    expect(curves.shape.some((value) => value !== 0)).toBe(true);
    await model.close();
  });
});

describe('the music of an interval', () => {
  it('is what Python trains on', () => {
    const { interval, frameFeatures } = golden<{
      interval: { startSeconds: number; endSeconds: number; music: number[][] };
      frameFeatures: number[][];
    }>('beat-music');
    const rows = Float32Array.from(frameFeatures.flat());
    const curves = emptyCurves([interval.startSeconds, interval.endSeconds], 2);
    agree(intervalInputs(curves, rows, 0, 1).music, interval.music.flat(), 1e-4);
  });
});

function inputs() {
  return intervalInputs(emptyCurves([0, 1], 1), new Float32Array(60 * FRAME_FEATURE_SIZE), 0, 1);
}
