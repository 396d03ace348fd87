import { defineConfig } from 'vite';
import { VitePWA } from 'vite-plugin-pwa';
import { LICENSES_FILE, licenses } from './licenses.ts';

/** Cross-origin isolation gives WASM its threads; the page works without it too, with one thread. */
const isolation = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
};

/**
 * The page without a network. The page's own scripts are kept before they are asked for; what is large or content (WebAssembly, the
 * figure, the demo, the library) only once it was used. The model's weights have a cache of their own (model-store.ts).
 */
const offline = VitePWA({
  registerType: 'prompt',
  // Registered by web/app/offline.ts, when the page has opened.
  injectRegister: false,
  manifest: {
    id: './',
    name: 'Posebeat',
    short_name: 'Posebeat',
    description: 'Drop a song, place a few poses on its beats, and watch a figure dance through them.',
    start_url: './',
    scope: './',
    display: 'standalone',
    background_color: '#0d1015',
    theme_color: '#0d1015',
    categories: ['music', 'entertainment', 'graphics'],
    icons: [
      { src: 'icons/icon-192.png', sizes: '192x192', type: 'image/png' },
      { src: 'icons/icon-512.png', sizes: '512x512', type: 'image/png' },
      { src: 'icons/maskable-512.png', sizes: '512x512', type: 'image/png', purpose: 'maskable' },
      { src: 'icons/icon.svg', sizes: 'any', type: 'image/svg+xml' },
    ],
  },
  includeManifestIcons: false,
  workbox: {
    globPatterns: ['index.html', 'assets/*.{js,mjs,css}'],
    // Only pages with a graphics processor want the WebGPU build.
    // So does what makes videos, or opens characters, wait for somebody who wants it.
    globIgnores: ['**/*jspi*', '**/video.worker*', '**/avatar-open*', '**/three-vrm*', '**/meshopt_decoder*'],
    navigateFallback: 'index.html',
    navigateFallbackDenylist: [new RegExp(`/${LICENSES_FILE}$`)],
    clientsClaim: true,
    skipWaiting: false,
    cleanupOutdatedCaches: true,
    runtimeCaching: [
      {
        // Their names change with their content.
        urlPattern: ({ url, sameOrigin }) => sameOrigin && url.pathname.includes('/assets/'),
        handler: 'CacheFirst',
        options: {
          cacheName: 'posebeat-assets',
          expiration: { maxEntries: 20 },
          cacheableResponse: { statuses: [200] },
        },
      },
      {
        // Belongs to the page's version: as it was last time only where there is no network.
        urlPattern: ({ url, sameOrigin }) => sameOrigin && /\/(demo|library|icons)\/[^/]+$/.test(url.pathname),
        handler: 'NetworkFirst',
        options: { cacheName: 'posebeat-content', cacheableResponse: { statuses: [200] } },
      },
    ],
  },
});

const licences = licenses();

export default defineConfig(({ mode }) => ({
  root: 'web',
  base: './',
  publicDir: '../public',
  build: { outDir: '../dist', emptyOutDir: true, target: 'es2022', chunkSizeWarningLimit: 1500 },
  plugins: [offline, licences.page],
  worker: { format: 'es' as const, plugins: licences.worker },
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
