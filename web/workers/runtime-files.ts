/** Where onnxruntime's loader and its WebAssembly lie, one pair for each backend; only the pair that is used is ever downloaded. */
import type { Backend } from './protocol';

/** @returns addresses relative to the page's scripts, as the bundler gives them */
export async function runtimeFiles(backend: Backend): Promise<{ mjs: string; wasm: string }> {
  const [mjs, wasm] =
    backend === 'webgpu'
      ? await Promise.all([
          import('onnxruntime-web/ort-wasm-simd-threaded.jspi.mjs?url'),
          import('onnxruntime-web/ort-wasm-simd-threaded.jspi.wasm?url'),
        ])
      : await Promise.all([
          import('onnxruntime-web/ort-wasm-simd-threaded.mjs?url'),
          import('onnxruntime-web/ort-wasm-simd-threaded.wasm?url'),
        ]);
  return { mjs: mjs.default, wasm: wasm.default };
}
