import { createHash } from 'node:crypto';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { specHash } from '../../web/core/spec';
import { loadModel } from '../../web/workers/model-store';

const folder = 'https://example.test/sub/models/';
const weights = Uint8Array.from({ length: 5000 }, (_, i) => i % 251);
const golden = {
  arrays: Object.fromEntries(
    ['music', 'seed', 'key_poses', 'key_mask', 'to_previous', 'to_next', 'motion'].map((name, i) => [
      name,
      { shape: [1, 2], offset: 2 * i },
    ]),
  ),
};
let files: Record<string, () => Response>;
let asked: string[];
let kept: Map<string, Uint8Array>;

beforeEach(() => {
  asked = [];
  kept = new Map();
  const manifest = {
    name: 'light',
    file: 'light.onnx',
    bytes: weights.length,
    sha256: createHash('sha256').update(weights).digest('hex'),
    specHash,
    precision: 'q8',
  };
  files = {
    'manifest.json': () => Response.json(manifest),
    'golden.json': () => Response.json(golden),
    'golden.bin': () => new Response(new Float32Array(14).map((_, i) => i)),
    'light.onnx': () => new Response(weights),
  };
  vi.stubGlobal('fetch', async (url: string) => {
    const name = new URL(url).pathname.split('/').pop()!;
    asked.push(name);
    return files[name]?.() ?? new Response('', { status: 404 });
  });
  const cache = {
    match: async (url: string) => (kept.has(url) ? new Response(kept.get(url)!.slice()) : undefined),
    put: async (url: string, response: Response) => void kept.set(url, new Uint8Array(await response.arrayBuffer())),
    delete: async (request: Request | string) => kept.delete(typeof request === 'string' ? request : request.url),
    keys: async () => [...kept.keys()].map((url) => ({ url })),
  };
  vi.stubGlobal('caches', { open: async () => cache });
});
afterEach(() => vi.unstubAllGlobals());

describe('the model store', () => {
  it('downloads with progress, then takes the weights from the cache', async () => {
    const progress = vi.fn();
    const first = await loadModel(folder, progress);
    expect(first.weights).toEqual(weights);
    expect(first.cached).toBe(false);
    expect(progress.mock.lastCall).toEqual([5000, 5000, false]);
    expect(first.golden.inputs.frames).toBe(2);
    expect(Array.from(first.golden.motion)).toEqual([12, 13]);
    asked = [];
    const second = await loadModel(folder, progress);
    expect(second.weights).toEqual(weights);
    expect(second.cached).toBe(true);
    expect(asked).not.toContain('light.onnx');
  });

  it('lets go of an older form of the same model, not of another one', async () => {
    kept.set(`${folder}light.onnx?old`, new Uint8Array(3));
    kept.set(`${folder}suggest.onnx?kept`, new Uint8Array(3));
    await loadModel(folder, () => undefined);
    const models = [...kept.keys()].filter((url) => url.includes('.onnx'));
    expect(models).toHaveLength(2);
    expect(models).toContain(`${folder}suggest.onnx?kept`);
    expect(models).not.toContain(`${folder}light.onnx?old`);
  });

  it('works without a cache, and without a network once it has one', async () => {
    await loadModel(folder, () => undefined);
    vi.stubGlobal('fetch', async () => {
      throw new TypeError('Failed to fetch');
    });
    expect((await loadModel(folder, () => undefined)).weights).toEqual(weights);
    vi.stubGlobal('caches', undefined);
    await expect(loadModel(folder, () => undefined)).rejects.toThrow('check the network');
  });

  it('refuses a model of another spec', async () => {
    const text = await files['manifest.json']().text();
    files['manifest.json'] = () => new Response(text.replace(specHash, 'f'.repeat(64)));
    await expect(loadModel(folder, () => undefined)).rejects.toThrow('another version of Posebeat');
  });

  it('refuses damaged, short and missing files', async () => {
    files['light.onnx'] = () => new Response(weights.map((v) => v ^ 1));
    await expect(loadModel(folder, () => undefined)).rejects.toThrow('damaged');
    files['light.onnx'] = () => new Response(weights.slice(1));
    await expect(loadModel(folder, () => undefined)).rejects.toThrow('broke off');
    files['light.onnx'] = () => new Response('', { status: 404 });
    await expect(loadModel(folder, () => undefined)).rejects.toThrow('missing on this site (404');
    files['manifest.json'] = () => new Response('<!doctype html>');
    await expect(loadModel(folder, () => undefined)).rejects.toThrow('models/manifest.json');
    expect([...kept.keys()].filter((url) => url.includes('.onnx'))).toHaveLength(0);
  });
});
