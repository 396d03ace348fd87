import { expect, test, type Page } from '@playwright/test';
import { fourPoses, loadSong, open, rejection, saved } from './support/page';
import { wav } from './support/songs';
import { twoBuilds } from './support/two-builds';

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

test('a newer build waits for the visitor: later keeps the page, now reloads into it with the work kept', async ({
  page,
}) => {
  const host = await twoBuilds();
  const [first, second, third] = fourPoses();
  const place = (poses: number[][]) =>
    page.evaluate(
      (list) => window.posebeat.setKeyPoses(list.map((rotations, i) => ({ time: 1 + i, rotations }))),
      poses,
    );
  const count = () => page.evaluate(() => window.posebeat.document().keyPoses.length);
  const build = () => page.evaluate(() => document.documentElement.dataset.build ?? '1');
  const notice = page.locator('.notice.update');
  const arrive = async () => {
    await page.waitForFunction(() => 'posebeat' in window);
    await page.evaluate(() => window.posebeat.ready);
  };
  try {
    await page.addInitScript(() => localStorage.setItem('posebeat.tour', 'seen'));
    await page.goto(host.url);
    await arrive();
    await page.waitForFunction(() => navigator.serviceWorker.controller !== null, null, { timeout: 60_000 });
    await place([first]);
    host.release();
    await page.evaluate(async () => (await navigator.serviceWorker.getRegistration())!.update());
    await expect(notice).toContainText('A newer Posebeat is ready. Your work is saved before the page reloads.');

    // Later: nothing is lost, nothing reloads.
    await place([first, second]);
    await page.evaluate(() => Object.assign(window, { stayed: true }));
    await notice.getByRole('button', { name: 'Dismiss' }).click();
    await expect(notice).toHaveCount(0);
    expect(await page.evaluate(() => 'stayed' in window)).toBe(true);
    expect(await count()).toBe(2);

    // Until it is let in, opening the page again gives the old build whole, which asks again.
    await saved(page);
    await page.reload();
    await arrive();
    expect([await build(), await count()]).toEqual(['1', 2]);
    await expect(notice).toBeVisible();

    // Now, with work that was not saved a moment ago.
    await Promise.all([
      page.waitForURL(host.url, { waitUntil: 'load' }),
      place([first, second, third]).then(() => notice.getByRole('button', { name: 'Reload' }).click()),
    ]);
    await expect.poll(() => build().catch(() => '')).toBe('2');
    await arrive();
    expect(await count()).toBe(3);
    await expect(notice).toHaveCount(0);
  } finally {
    await host.close();
  }
});
