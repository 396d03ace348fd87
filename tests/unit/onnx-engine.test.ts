import { afterEach, describe, expect, it, vi } from 'vitest';
import { specHash } from '../../web/core/spec';
import type { AdapterCheck } from '../../web/workers/onnx-runtime';

const sessions: { backend: string; run: ReturnType<typeof vi.fn>; close: ReturnType<typeof vi.fn> }[] = [];
let adapter: AdapterCheck = { usable: false, software: false, reason: 'This browser has no WebGPU' };
let wrongOnGpu = false;

vi.mock('../../web/workers/onnx-runtime', () => ({
  checkAdapter: async () => adapter,
  threadsAvailable: (wanted?: number) => wanted ?? 2,
  openRuntime: async () => ({}),
}));
vi.mock('../../web/workers/onnx-session', () => ({
  GOLDEN_TOLERANCE: 0.01,
  openSession: async (_: unknown, backend: string) => {
    const session = { backend, run: vi.fn(async () => new Float32Array([1])), close: vi.fn() };
    sessions.push(session);
    return session;
  },
  goldenError: async ({ backend }: { backend: string }) => (backend === 'webgpu' && wrongOnGpu ? 0.1 : 1e-6),
}));
vi.mock('../../web/workers/model-store', () => ({
  DANCE_MODEL: {},
  parseGoldenRun: () => ({}),
  loadModel: async () => ({
    manifest: { name: 'light', precision: 'q8', specHash },
    weights: new Uint8Array(1),
    golden: {},
    cached: true,
  }),
}));

const { DanceEngine } = await import('../../web/workers/onnx-engine');
const open = (options: object = {}, onChange = vi.fn()) =>
  DanceEngine.open({ folder: 'https://example.test/models/', onProgress: () => undefined, ...options }, onChange);
const gpu: AdapterCheck = { usable: true, software: false, name: 'some gpu' };
const inputs = {} as never;

afterEach(() => {
  sessions.length = 0;
  wrongOnGpu = false;
  adapter = { usable: false, software: false, reason: 'This browser has no WebGPU' };
});

describe('the choice of a backend', () => {
  it('is WASM without an adapter, and says why', async () => {
    expect((await open()).state).toEqual({
      backend: 'wasm',
      threads: 2,
      model: 'light (q8)',
      reason: 'This browser has no WebGPU; WASM with 2 threads.',
    });
    expect((await open({ backend: 'webgpu', threads: 1 })).state.reason).toBe(
      'WebGPU was asked for, but: This browser has no WebGPU; WASM with 1 thread.',
    );
  });

  it('is WebGPU on a graphics processor, WASM when that is forced', async () => {
    adapter = gpu;
    expect((await open()).state).toMatchObject({ backend: 'webgpu', reason: 'WebGPU: some gpu.' });
    expect((await open({ backend: 'wasm' })).state.backend).toBe('wasm');
  });

  it('takes a software adapter only when it is asked for', async () => {
    adapter = { usable: true, software: true, name: 'google swiftshader' };
    expect((await open()).state.reason).toContain('software (google swiftshader)');
    expect((await open({ backend: 'webgpu' })).state.backend).toBe('webgpu');
  });

  it('falls back when the check window comes out wrong', async () => {
    adapter = gpu;
    wrongOnGpu = true;
    const { state } = await open();
    expect(state.backend).toBe('wasm');
    expect(state.reason).toContain('off by 0.10');
    expect(sessions[0].close).toHaveBeenCalled();
  });

  it('goes on with WASM when the device is lost in the middle of a dance', async () => {
    adapter = gpu;
    const onChange = vi.fn();
    const engine = await open({}, onChange);
    await engine.run(inputs);
    sessions[0].run.mockRejectedValueOnce(new Error('device lost'));
    expect(await engine.run(inputs)).toEqual(new Float32Array([1]));
    expect(engine.state).toMatchObject({
      backend: 'wasm',
      reason: 'WebGPU failed while dancing (device lost); WASM with 2 threads.',
    });
    expect(onChange).toHaveBeenCalledTimes(1);
    sessions[1].run.mockRejectedValueOnce(new Error('out of memory'));
    await expect(engine.run(inputs)).rejects.toThrow('out of memory');
  });
});
