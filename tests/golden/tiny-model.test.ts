import * as ort from 'onnxruntime-web';
import { describe, expect, it } from 'vitest';
import { parseGolden, type GoldenHeader } from '../../web/workers/model-store';
import { goldenError, openSession } from '../../web/workers/onnx-session';
import { generateMotion } from '../../web/core/windows';
import { consistencyError } from '../../web/core/metrics';
import { danceRequest, key, poseWith } from '../unit/dance';
import { golden, goldenBytes } from './golden';

ort.env.wasm.numThreads = 1;
const header = golden<GoldenHeader & { tolerance: number }>('tiny');
const window = parseGolden(header, goldenBytes('tiny.bin').buffer);

describe('the exported model in onnxruntime-web', () => {
  it('gives what Python gave', async () => {
    const session = await openSession(ort, 'wasm', goldenBytes('tiny.onnx'));
    expect(await goldenError(session, window)).toBeLessThan(header.tolerance);
    await session.close();
  });

  it('is told from a wrong one', async () => {
    const session = await openSession(ort, 'wasm', goldenBytes('tiny.onnx'));
    const wrong = { ...window, motion: window.motion.map((v, i) => (i === 500 ? v + 0.07 : v)) };
    expect(await goldenError(session, wrong)).toBeGreaterThan(0.06);
    expect(await goldenError(session, { ...window, motion: window.motion.slice(1) })).toBe(Infinity);
    await session.close();
  });

  it('makes a whole dance', async () => {
    const session = await openSession(ort, 'wasm', goldenBytes('tiny.onnx'));
    const keyPoses = [key(4, poseWith({ left_shoulder: [0, 0, 1] }))];
    const motion = await generateMotion(danceRequest(10, { keyPoses }), (inputs) => session.run(inputs));
    expect(motion.frames).toBe(300);
    expect(consistencyError(motion, keyPoses)).toBeLessThan(1e-6);
    await session.close();
  });
});
