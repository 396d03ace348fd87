import { expect, test, type Page } from '@playwright/test';
import { loadSong, open, rejection } from './support/page';
import { wav } from './support/songs';
import { serveTinyModel } from './support/tiny';

const generate = (page: Page, options = {}) => page.evaluate((options) => window.posebeat.generate(options), options);

test('the weights are downloaded once: the second visit takes them from the cache', async ({ page }) => {
  const weights: string[] = [];
  page.on('request', (request) => {
    if (request.url().includes('tiny.onnx')) weights.push(request.url());
  });
  await serveTinyModel(page);
  for (const visit of [1, 2]) {
    await open(page, '?backend=wasm');
    await loadSong(page, wav({ seconds: 4 }));
    await generate(page);
    expect(weights, `downloads after visit ${visit}`).toHaveLength(1);
  }
});

test('a page that is not cross-origin isolated dances with one thread', async ({ page }) => {
  await serveTinyModel(page);
  await page.route('**/', async (route) => {
    const response = await route.fetch();
    const headers = { ...response.headers() };
    delete headers['cross-origin-opener-policy'];
    delete headers['cross-origin-embedder-policy'];
    await route.fulfill({ response, headers });
  });
  await open(page);
  expect(await page.evaluate(() => crossOriginIsolated)).toBe(false);
  await loadSong(page, wav({ seconds: 4 }));
  const result = await generate(page);
  expect(result).toMatchObject({ backend: 'wasm', frames: 120 });
});

test('an isolated page has threads and says so', async ({ page }) => {
  await serveTinyModel(page);
  await open(page);
  expect(await page.evaluate(() => crossOriginIsolated)).toBe(true);
  await loadSong(page, wav({ seconds: 4 }));
  await generate(page);
  await page.getByRole('tab', { name: 'Dance' }).click();
  await expect(page.getByText(/threads/).first()).toBeAttached();
});

test('cancelling leaves the last good dance, and the page can generate again', async ({ page }) => {
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: 12 }));
  await generate(page, { seed: 1 });
  const dance = () => page.evaluate(() => [...window.posebeat.motion().rotations.slice(0, 7200)]);
  const before = await dance();
  const button = page.getByRole('button', { name: /generate/i }).last();
  await button.click();
  await page.locator('.generate.busy').click();
  await expect(page.getByRole('button', { name: /generate/i }).last()).toBeEnabled();
  expect(await dance()).toEqual(before);
  expect(await generate(page, { seed: 1 })).toMatchObject({ frames: 360 });
  expect(await dance()).toEqual(before);
});

test('a later call cancels an earlier one', async ({ page }) => {
  await serveTinyModel(page);
  await open(page);
  await loadSong(page, wav({ seconds: 30 }));
  const [first, second] = await page.evaluate(async () => {
    const earlier = window.posebeat.generate({ seed: 1 }).then(
      () => 'finished',
      (error: Error) => error.name,
    );
    const later = await window.posebeat.generate({ seed: 2 });
    return [await earlier, later.frames];
  });
  expect(first).toBe('AbortError');
  expect(second).toBe(900);
});

test('a range is made anew and the rest stays as it was, without a pop at its ends', async ({ page }) => {
  await serveTinyModel(page);
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: 12 }));
  await generate(page, { seed: 1, variation: 0.5 });
  const dance = () => page.evaluate(() => [...window.posebeat.motion().rotations]);
  const before = await dance();
  await generate(page, { seed: 5, variation: 1, range: { start: 4, end: 8 } });
  const after = await dance();
  const frame = (motion: number[], t: number) => motion.slice(t * 72 + 3, t * 72 + 72);
  const apart = (a: number[], b: number[]) => Math.max(...a.map((value, i) => Math.abs(value - b[i])));
  for (const t of [0, 60, 119, 240, 300, 359]) expect(apart(frame(before, t), frame(after, t))).toBeLessThan(1e-5);
  expect(apart(frame(before, 180), frame(after, 180))).toBeGreaterThan(0.01);
  const step = (motion: number[], t: number) => apart(frame(motion, t), frame(motion, t - 1));
  const largest = Math.max(...Array.from({ length: 359 }, (_, t) => step(before, t + 1)));
  for (const t of [119, 120, 121, 239, 240, 241]) expect(step(after, t)).toBeLessThan(Math.max(largest, 0.5));
});

test('a model made for another spec is refused with a message, and the page lives on', async ({ page }) => {
  await serveTinyModel(page);
  await page.route('**/models/manifest.json', (route) =>
    route.fulfill({ json: { name: 'old', file: 'old.onnx', bytes: 1, sha256: 'x', specHash: 'y', precision: 'fp32' } }),
  );
  await open(page);
  await loadSong(page, wav({ seconds: 4 }));
  expect(await rejection(generate(page))).toMatch(/another version/i);
  await expect(page.getByRole('button', { name: /generate/i }).last()).toBeEnabled();
});
