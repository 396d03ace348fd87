import { defineConfig } from '@playwright/test';
import { CHROMIUM_FLAGS, installedChromium } from './tests/chromium.mjs';

const port = 4179;

const launch = (...flags: string[]) => ({
  executablePath: installedChromium(),
  args: [...CHROMIUM_FLAGS, '--autoplay-policy=no-user-gesture-required', ...flags],
});

export default defineConfig({
  testDir: 'tests/e2e',
  timeout: 120_000,
  expect: { timeout: 20_000 },
  workers: 1,
  retries: 0,
  reporter: [['list']],
  outputDir: 'test-results',
  use: {
    baseURL: `http://127.0.0.1:${port}/`,
    viewport: { width: 1440, height: 900 },
  },
  // Software rendering costs more time than all else: what does not look at the stage runs without one, which the page must bear anyway.
  projects: [
    {
      name: 'no stage',
      testMatch: /(api|library|songs|generate|ranges|report|beats|touch|a11y|project)\.spec\.ts/,
      use: { viewport: { width: 640, height: 480 }, launchOptions: launch('--disable-3d-apis') },
    },
    {
      name: 'stage',
      testMatch: /(page|timeline|pose-editor|studio|stage)\.spec\.ts/,
      use: { launchOptions: launch('--enable-unsafe-swiftshader') },
    },
    {
      name: 'webgpu',
      testMatch: /webgpu\.spec\.ts/,
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
