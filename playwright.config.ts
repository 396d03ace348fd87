import { defineConfig } from '@playwright/test';
import { CHROMIUM_FLAGS, installedChromium } from './tests/chromium.mjs';

const port = 4179;

/** What looks at the figure. */
const STAGE = /(page|timeline|pose-editor|studio|video|avatar|stage)\.spec\.ts/;
const WEBGPU = /webgpu\.spec\.ts/;

const launch = (...flags: string[]) => ({
  executablePath: installedChromium(),
  args: [...CHROMIUM_FLAGS, '--autoplay-policy=no-user-gesture-required', ...flags],
});

export default defineConfig({
  testDir: 'tests/e2e',
  timeout: 120_000,
  expect: { timeout: 20_000 },
  // Two cores are enough for two pages; what waits for real time has its own slack.
  workers: 2,
  fullyParallel: true,
  retries: 0,
  reporter: [['list']],
  outputDir: 'test-results',
  use: {
    baseURL: `http://127.0.0.1:${port}/`,
    viewport: { width: 1440, height: 900 },
    // What is not there by then never comes.
    actionTimeout: 30_000,
    // What a test answers in place of the network must not come from a worker's cache; offline.spec.ts lets it in.
    serviceWorkers: 'block',
  },
  // Software rendering costs more time than all else: what does not look at the stage runs without one, which the page must bear anyway.
  projects: [
    {
      name: 'no stage',
      testIgnore: [STAGE, WEBGPU],
      use: { viewport: { width: 640, height: 480 }, launchOptions: launch('--disable-3d-apis') },
    },
    {
      name: 'stage',
      testMatch: STAGE,
      // A quarter of the pixels, the same layout.
      use: { deviceScaleFactor: 0.5, launchOptions: launch('--enable-unsafe-swiftshader') },
    },
    {
      name: 'webgpu',
      testMatch: WEBGPU,
      use: {
        viewport: { width: 640, height: 480 },
        launchOptions: launch('--enable-unsafe-webgpu', '--enable-unsafe-swiftshader'),
      },
    },
  ],
  webServer: {
    command: `npx vite preview --port ${port} --strictPort --host 127.0.0.1`,
    port,
    reuseExistingServer: false,
  },
});
