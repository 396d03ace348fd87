import { describe, expect, it, vi } from 'vitest';
import type { DanceRequest, GenerateReply, GenerateRequest } from '../../web/workers/protocol';
import { GenerateClient } from '../../web/workers/generate-client';
import { emptyMotion } from '../../web/core/motion';
import { FakeWorker } from './support/worker';

class GenerateWorker extends FakeWorker<GenerateRequest, GenerateReply> {
  last(type: GenerateRequest['type']): number {
    return this.sent.findLast((request) => request.type === type)!.job;
  }
}

const loaded = { backend: 'wasm', threads: 2, model: 'light (q8)', reason: 'test' } as const;
const result = { motion: emptyMotion(2), backend: 'wasm', model: 'light', windows: 1, milliseconds: 3 } as const;
const job = { frames: 2 } as unknown as DanceRequest;
const options = { baseUrl: 'https://example.test/app/' };

function started() {
  const worker = new GenerateWorker();
  const client = new GenerateClient(() => worker as unknown as Worker);
  const loading = client.load(options);
  worker.reply({ type: 'loaded', job: worker.last('load'), ...loaded });
  return { worker, client, loading };
}
const tick = () => new Promise((resolve) => setTimeout(resolve));

describe('the client of the generate worker', () => {
  it('loads once, with progress', async () => {
    const worker = new GenerateWorker();
    const client = new GenerateClient(() => worker as unknown as Worker);
    const onProgress = vi.fn();
    const loading = client.load({ ...options, onProgress });
    expect(client.load(options)).toBe(loading);
    const load = worker.last('load');
    worker.reply({ type: 'loading', job: load, fraction: 0.5, bytes: 1, totalBytes: 2, cached: false });
    worker.reply({ type: 'loaded', job: load, ...loaded });
    expect(await loading).toEqual(loaded);
    expect(onProgress).toHaveBeenCalledWith({ fraction: 0.5, bytes: 1, totalBytes: 2, cached: false });
    expect(worker.sent).toEqual([
      { type: 'load', job: load, baseUrl: options.baseUrl, backend: undefined, threads: undefined },
    ]);
  });

  it('loads anew for another backend, and back', async () => {
    const { worker, client, loading } = started();
    await loading;
    void client.load({ ...options, backend: 'wasm' });
    expect(worker.sent.at(-1)).toMatchObject({ type: 'load', backend: 'wasm' });
    void client.load(options);
    expect(worker.sent.at(-1)).toMatchObject({ type: 'load', backend: undefined });
    expect(worker.sent).toHaveLength(3);
  });

  it('can be asked again after a failed load', async () => {
    const worker = new GenerateWorker();
    const client = new GenerateClient(() => worker as unknown as Worker);
    const loading = client.load(options);
    worker.reply({ type: 'error', job: worker.last('load'), message: 'no network' });
    await expect(loading).rejects.toThrow('no network');
    await tick();
    const again = client.load(options);
    worker.reply({ type: 'loaded', job: worker.last('load'), ...loaded });
    expect(await again).toEqual(loaded);
  });

  it('hands on parts and the result', async () => {
    const { worker, client } = started();
    const onPartial = vi.fn();
    const dance = client.generate(job, { onPartial });
    await tick();
    const id = worker.last('generate');
    worker.reply({ type: 'partial', job: id, motion: emptyMotion(1), fraction: 0.5, windows: 1 });
    worker.reply({ type: 'result', job: id, ...result });
    expect(await dance).toEqual(result);
    expect(onPartial).toHaveBeenCalledTimes(1);
  });

  it('rejects at once when cancelled, tells the worker, and ignores what still comes', async () => {
    const { worker, client } = started();
    const controller = new AbortController();
    const onPartial = vi.fn();
    const dance = client.generate(job, { onPartial, signal: controller.signal });
    await tick();
    const id = worker.last('generate');
    controller.abort();
    await expect(dance).rejects.toMatchObject({ name: 'AbortError' });
    expect(worker.last('cancel')).toBe(id);
    worker.reply({ type: 'partial', job: id, motion: emptyMotion(1), fraction: 0.5, windows: 1 });
    worker.reply({ type: 'result', job: id, ...result });
    expect(onPartial).not.toHaveBeenCalled();
    const next = client.generate(job);
    await tick();
    worker.reply({ type: 'result', job: worker.last('generate'), ...result });
    expect(await next).toEqual(result);
  });

  it('passes on errors, and starts a new worker after one that died', async () => {
    const { worker, client } = started();
    const failing = client.generate(job);
    await tick();
    worker.reply({ type: 'error', job: worker.last('generate'), message: 'what to do' });
    await expect(failing).rejects.toThrow('what to do');
    const dying = client.generate(job);
    await tick();
    worker.onerror?.({ message: 'out of memory', preventDefault: () => undefined } as unknown as ErrorEvent);
    await expect(dying).rejects.toThrow(/stopped unexpectedly \(out of memory\)/);
    expect(worker.terminate).toHaveBeenCalled();
    expect(client.loaded).toBeUndefined();
  });

  it('says when the worker moved to another backend', async () => {
    const { worker, client, loading } = started();
    await loading;
    client.onBackendChange = vi.fn();
    worker.reply({ type: 'loaded', job: worker.last('load'), ...loaded, reason: 'WebGPU failed' });
    expect(client.onBackendChange).toHaveBeenCalledWith({ ...loaded, reason: 'WebGPU failed' });
    expect((await client.loaded)?.reason).toBe('WebGPU failed');
  });
});
