import { expect, test, type Page } from '@playwright/test';
import { fourPoses, loadSong, open, rejection } from './support/page';
import { wav } from './support/songs';

test.use({ serviceWorkers: 'allow' });

const SONG = wav({ seconds: 4 });

const kept = (page: Page) =>
  page.evaluate(async () => {
    const all: Record<string, string[]> = {};
    for (const name of await caches.keys()) {
      const keys = await (await caches.open(name)).keys();
      all[name.replace(/-v2-.*/, '')] = keys.map(({ url }) => new URL(url).pathname);
    }
    return all;
  });

test('with the network cut the page opens, dances, and makes a dance', async ({ page, context }) => {
  test.slow();
  await open(page, '?backend=wasm');
  await page.waitForFunction(() => navigator.serviceWorker.controller !== null, null, { timeout: 60_000 });
  await expect.poll(async () => (await kept(page))['posebeat-content']).toContain('/demo/song.mp3');
  // Kept before they are asked for: the page's own scripts, and nothing that is large.
  const precached = (await kept(page))['workbox-precache'];
  expect(precached).toContain('/index.html');
  expect(
    precached.filter((path) => !/^\/(index\.html|manifest\.webmanifest|assets\/.*\.(js|mjs|css))$/.test(path)),
  ).toEqual([]);
  expect((await kept(page))['posebeat-models']).toBeUndefined();

  await loadSong(page, SONG);
  const online = await page.evaluate(() => window.posebeat.generate({ seed: 4 }));
  await expect.poll(async () => (await kept(page))['posebeat-assets']?.join()).toMatch(/\.wasm/);

  await context.setOffline(true);
  await page.reload();
  await page.waitForFunction(() => 'posebeat' in window);
  await page.evaluate(() => window.posebeat.ready);
  expect(await page.evaluate(() => crossOriginIsolated)).toBe(true);
  await loadSong(page, SONG, 'again.wav');
  const offline = await page.evaluate(() => window.posebeat.generate({ seed: 4 }));
  expect(offline.motionHash).toBe(online.motionHash);
  const poses = fourPoses();
  await page.evaluate((rotations) => window.posebeat.setKeyPoses([{ time: 2, rotations }]), poses[0]);
  const other = await page.evaluate(() => window.posebeat.generate());
  expect(other.motionHash).not.toBe(online.motionHash);

  // A link works without a network too, and so does the frame.
  const link = await page.evaluate(() => window.posebeat.shareLink());
  const fresh = await context.newPage();
  await fresh.goto(link.replace('#', '?embed=1#'));
  await fresh.waitForFunction(() => 'posebeat' in window);
  await fresh.evaluate(() => window.posebeat.ready);
  expect(await fresh.evaluate(() => window.posebeat.document().keyPoses.length)).toBe(1);
});

test('without a network at the first dance, it says what is missing', async ({ page, context }) => {
  await open(page, '?backend=wasm');
  await page.waitForFunction(() => navigator.serviceWorker.controller !== null, null, { timeout: 60_000 });
  await context.setOffline(true);
  expect(await rejection(page.evaluate(() => window.posebeat.generate()))).toMatch(/check the network/);
});

test('where the browser keeps nothing, the page works and says what is not kept', async ({ page }) => {
  await page.addInitScript(() => {
    for (const name of ['indexedDB', 'caches']) Object.defineProperty(window, name, { value: undefined });
    Object.defineProperty(navigator, 'serviceWorker', { value: undefined });
    Object.defineProperty(navigator.storage, 'getDirectory', {
      value: () => Promise.reject(new DOMException('', 'SecurityError')),
    });
    Object.defineProperty(window, 'localStorage', {
      get: () => {
        throw new DOMException('', 'SecurityError');
      },
    });
  });
  await open(page, '?backend=wasm');
  await loadSong(page, SONG, 'Mine.wav');
  await expect(page.locator('.notices')).toContainText('“Mine.wav” could not be kept in this browser');
  await page.evaluate((rotations) => window.posebeat.setKeyPoses([{ time: 2, rotations }]), fourPoses()[0]);
  await expect(page.locator('.notices')).toContainText('This browser does not keep your work');
  expect((await page.evaluate(() => window.posebeat.generate())).frames).toBe(120);
});
