import { defineConfig } from 'vite';

/** Cross-origin isolation gives WASM its threads; the page works without it too, with one thread. */
const isolation = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
};

export default defineConfig(({ mode }) => ({
  root: 'web',
  base: './',
  publicDir: '../public',
  build: { outDir: '../dist', emptyOutDir: true, target: 'es2022', chunkSizeWarningLimit: 1500 },
  worker: { format: 'es' as const },
  resolve: {
    // A bundled onnxruntime re-imports the app in its thread workers and hangs; these conditions keep its loader outside.
    conditions: [
      'onnxruntime-web-use-extern-wasm',
      'module',
      'browser',
      mode === 'production' ? 'production' : 'development',
    ],
  },
  esbuild: { jsx: 'automatic' as const, jsxImportSource: 'preact' },
  server: { headers: isolation, port: 5173 },
  preview: { headers: isolation, port: 4173 },
}));
