/** onnxruntime-web for one backend: only the build that is used is downloaded. */
import type * as Ort from 'onnxruntime-web';
import type { Backend } from './protocol';
import { runtimeFiles } from './runtime-files';

export type OrtModule = typeof Ort;

/** A graphics processor, or why there is none to use. */
export type AdapterCheck =
  { usable: true; software: boolean; name: string } | { usable: false; software: false; reason: string };

interface AdapterInfo {
  vendor?: string;
  architecture?: string;
  device?: string;
  description?: string;
  isFallbackAdapter?: boolean;
}
interface Gpu {
  requestAdapter(options?: {
    powerPreference?: string;
  }): Promise<{ info?: AdapterInfo; isFallbackAdapter?: boolean } | null>;
}

/** Adapters that compute on the processor: right, but many times slower there than WASM. */
const SOFTWARE = /swiftshader|llvmpipe|lavapipe|softpipe|software|basic render|microsoft basic|warp/i;

/** Asks for a WebGPU adapter. Its build of onnxruntime needs JavaScript Promise Integration, which browsers with WebGPU get by and by. */
export async function checkAdapter(): Promise<AdapterCheck> {
  const none = (reason: string): AdapterCheck => ({ usable: false, software: false, reason });
  const gpu = (navigator as { gpu?: Gpu }).gpu;
  if (!gpu) return none('This browser has no WebGPU');
  if (!('Suspending' in WebAssembly)) return none('This browser’s WebGPU lacks JavaScript Promise Integration');
  try {
    const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' });
    if (!adapter) return none('No graphics processor is available to this page');
    const info = adapter.info ?? {};
    const name = [info.vendor, info.architecture, info.device, info.description].filter(Boolean).join(' ');
    const software = Boolean(info.isFallbackAdapter ?? adapter.isFallbackAdapter) || SOFTWARE.test(name);
    return { usable: true, software, name: name || 'graphics processor' };
  } catch {
    return none('The graphics processor did not answer');
  }
}

/** Threads that WASM can use here: shared memory needs a cross-origin isolated page. */
export function threadsAvailable(wanted?: number): number {
  if (typeof crossOriginIsolated === 'undefined' || !crossOriginIsolated) return 1;
  const cores = navigator.hardwareConcurrency || 1;
  return Math.max(1, Math.min(wanted ?? Math.min(4, cores), 16));
}

/**
 * Loads onnxruntime for a backend. Its loader stays a file of its own: bundled, its thread workers would start the app instead and hang.
 */
export async function openRuntime(backend: Backend, threads: number): Promise<OrtModule> {
  const [ort, files] = await Promise.all([
    backend === 'webgpu' ? import('onnxruntime-web/jspi') : import('onnxruntime-web/wasm'),
    runtimeFiles(backend),
  ]);
  const absolute = (path: string) => new URL(path, self.location.href).href;
  ort.env.wasm.wasmPaths = { mjs: absolute(files.mjs), wasm: absolute(files.wasm) };
  ort.env.wasm.numThreads = threads;
  ort.env.logLevel = 'error';
  return ort;
}
