/** The model's files: fetched with progress, kept in the Cache API by their fingerprint, refused when made for another spec. */
import { specHash } from '../core/spec';
import type { WindowInputs } from '../core/windows';
import type { GoldenRun } from './onnx-network';

/** public/models/manifest.json, as far as the app reads it. */
export interface ModelManifest {
  name: string;
  file: string;
  bytes: number;
  sha256: string;
  specHash: string;
  precision: string;
  /** Shapes of the inputs and outputs by their names. */
  inputs?: Record<string, unknown>;
  outputs?: Record<string, unknown>;
}

/** One window with the output that every backend must reproduce. */
export interface GoldenWindow {
  inputs: WindowInputs;
  /** [T, 147] */
  motion: Float32Array;
}

/** What a worker needs to run a model. */
export interface StoredModel<G = GoldenWindow> {
  manifest: ModelManifest;
  weights: Uint8Array;
  golden: G;
  /** Whether the weights came from the cache. */
  cached: boolean;
}

/** Which files a model has in the models folder. */
export interface ModelFiles<G> {
  /** In sentences for people: "The dance model". */
  title: string;
  manifest: string;
  /** Name of the two files with a golden run, without .json and .bin. */
  golden: string;
  parse(header: GoldenHeader, bytes: ArrayBuffer, manifest: ModelManifest): G;
}

/** Makes the motion between key poses. */
export const DANCE_MODEL: ModelFiles<GoldenWindow> = {
  title: 'The dance model',
  manifest: 'manifest.json',
  golden: 'golden',
  parse: (header, bytes) => parseGolden(header, bytes),
};

const CACHE = 'posebeat-models';

/**
 * Loads the model that a manifest names.
 * @param folder absolute URL of the models folder, with a slash at its end
 * @param onProgress bytes so far, bytes in all, whether they come from the cache
 * @throws Error with a message for people when a file is missing, damaged, or made for another version of the app
 */
export function loadModel(folder: string, onProgress: OnProgress): Promise<StoredModel>;
export function loadModel<G>(folder: string, onProgress: OnProgress, files: ModelFiles<G>): Promise<StoredModel<G>>;
export async function loadModel<G>(
  folder: string,
  onProgress: OnProgress,
  files: ModelFiles<G> | ModelFiles<GoldenWindow> = DANCE_MODEL,
): Promise<StoredModel<G | GoldenWindow>> {
  const { title } = files;
  const cache = await openCache();
  const manifest = (await smallFile(folder + files.manifest, cache, 'json', title)) as ModelManifest;
  if (manifest.specHash !== specHash) {
    throw new Error(
      `The model "${manifest.name}" was made for another version of Posebeat (spec ${String(manifest.specHash).slice(0, 8)}, ` +
        `this page has ${specHash.slice(0, 8)}). Reload the page; if that does not help, export the model again.`,
    );
  }
  const [header, bytes] = await Promise.all([
    smallFile(`${folder}${files.golden}.json`, cache, 'json', title),
    smallFile(`${folder}${files.golden}.bin`, cache, 'bytes', title),
  ]);
  const golden = files.parse(header as GoldenHeader, bytes as ArrayBuffer, manifest);
  const url = `${folder}${manifest.file}?${manifest.sha256.slice(0, 16)}`;
  const kept = await cache?.match(url);
  if (kept) {
    const weights = new Uint8Array(await kept.arrayBuffer());
    if (weights.length === manifest.bytes) {
      onProgress(weights.length, manifest.bytes, true);
      return { manifest, weights, golden, cached: true };
    }
    await cache?.delete(url);
  }
  const weights = await download(url, manifest.bytes, title, (read) => onProgress(read, manifest.bytes, false));
  await verify(weights, manifest, title);
  await keep(cache, url, weights);
  return { manifest, weights, golden, cached: false };
}

type OnProgress = (bytes: number, total: number, cached: boolean) => void;

/** Undefined where there is no Cache API (an insecure origin) or the browser forbids it (private windows). */
async function openCache(): Promise<Cache | undefined> {
  try {
    return typeof caches === 'undefined' ? undefined : await caches.open(CACHE);
  } catch {
    return undefined;
  }
}

/** A small file from the network, or as it was last time when there is no network. */
async function smallFile(
  url: string,
  cache: Cache | undefined,
  kind: 'json' | 'bytes',
  title: string,
): Promise<unknown> {
  let response: Response | undefined;
  try {
    response = await fetch(url, { cache: 'no-cache' });
    if (response.ok) await cache?.put(url, response.clone()).catch(() => undefined);
  } catch {
    response = await cache?.match(url);
  }
  if (!response) throw new Error(`${title} could not be loaded: check the network connection and try again.`);
  if (!response.ok) throw new Error(`${title} is missing on this site (${response.status} for ${fileName(url)}).`);
  try {
    return kind === 'json' ? await response.json() : await response.arrayBuffer();
  } catch {
    // Many static hosts answer a missing file with their start page.
    throw new Error(`${title} is missing on this site (${fileName(url)} is not what it should be).`);
  }
}

function fileName(url: string): string {
  return new URL(url).pathname.split('/').slice(-2).join('/');
}

async function download(
  url: string,
  total: number,
  title: string,
  onProgress: (bytes: number) => void,
): Promise<Uint8Array> {
  const bytes = new Uint8Array(total);
  let read = 0;
  const broken = `The download of ${title.toLowerCase()} broke off: check the network and try again.`;
  try {
    const response = await fetch(url);
    if (!response.ok || !response.body) {
      throw new Error(`${title} is missing on this site (${response.status} for ${fileName(url)}).`);
    }
    const reader = response.body.getReader();
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      if (read + part.value.length > total)
        throw new Error(`${title} is not the one that was announced: reload the page.`);
      bytes.set(part.value, read);
      read += part.value.length;
      onProgress(read);
    }
  } catch (error) {
    // fetch reports a broken connection as a TypeError.
    if (error instanceof TypeError) throw new Error(broken, { cause: error });
    throw error;
  }
  if (read < total) throw new Error(broken);
  return bytes;
}

/** crypto.subtle exists on secure origins only; elsewhere the length and the golden window have to do. */
async function verify(weights: Uint8Array, manifest: ModelManifest, title: string): Promise<void> {
  if (typeof crypto === 'undefined' || !crypto.subtle) return;
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', weights as Uint8Array<ArrayBuffer>));
  const hex = Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
  if (hex !== manifest.sha256)
    throw new Error(`${title} was damaged on its way here: reload the page to fetch it again.`);
}

/** Keeps the weights for the next visit and lets go of older ones of the same file. A full disk only costs another download. */
async function keep(cache: Cache | undefined, url: string, weights: Uint8Array): Promise<void> {
  if (!cache) return;
  try {
    const [file] = url.split('?');
    for (const request of await cache.keys()) {
      if (request.url.split('?')[0] === file && request.url !== url) await cache.delete(request);
    }
    await cache.put(url, new Response(weights as Uint8Array<ArrayBuffer>));
  } catch {
    // Without the cache the app works as before.
  }
}

/** golden.json: shapes and offsets (in float32 numbers) of the arrays in golden.bin. */
export interface GoldenHeader {
  arrays: Record<string, { shape: number[]; offset: number }>;
}

/** Every named array of a golden file. */
function readArrays(header: GoldenHeader, bytes: ArrayBuffer) {
  const numbers = new Float32Array(bytes);
  return (name: string) => {
    const entry = header.arrays[name];
    if (!entry) throw new Error(`The model's check run has no "${name}": export the model again.`);
    const size = entry.shape.reduce((product, each) => product * each, 1);
    return { data: numbers.slice(entry.offset, entry.offset + size), dims: entry.shape };
  };
}

/** A golden run of a network whose manifest names its inputs and outputs, as the arrays in the golden file are named. */
export function parseGoldenRun(header: GoldenHeader, bytes: ArrayBuffer, manifest: ModelManifest): GoldenRun {
  const read = readArrays(header, bytes);
  const names = (part: Record<string, unknown> | undefined) => Object.keys(part ?? {});
  return {
    feeds: Object.fromEntries(names(manifest.inputs).map((name) => [name, read(name)])),
    outputs: Object.fromEntries(names(manifest.outputs).map((name) => [name, read(name).data])),
  };
}

/** The golden window of golden.json + golden.bin (float32, little-endian). */
export function parseGolden(header: GoldenHeader, bytes: ArrayBuffer): GoldenWindow {
  const read = (name: string) => readArrays(header, bytes)(name).data;
  return {
    inputs: {
      frames: header.arrays.music.shape[1],
      seedFrames: header.arrays.seed.shape[1],
      music: read('music'),
      seed: read('seed'),
      keyPoses: read('key_poses'),
      keyMask: read('key_mask'),
      toPrevious: read('to_previous'),
      toNext: read('to_next'),
    },
    motion: read('motion'),
  };
}
