import { expect, test, type Page } from '@playwright/test';
import { collectErrors, loadSong, open } from './support/page';
import { wav } from './support/songs';
import { serveTinyModel } from './support/tiny';
import { Fingers, middleOf, way } from './support/touch';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

const keys = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses.map(({ time }) => time));

test('placing: a tap puts a pose on a beat, a finger moves it along the lane; a swipe scrolls the poses instead', async ({
  page,
}) => {
  const errors = collectErrors(page);
  await open(page);
  const { beats } = await loadSong(page, wav({ seconds: 12 }));
  const fingers = await Fingers.of(page);
  await page.locator('.pose-tile').nth(1).scrollIntoViewIfNeeded();
  const tile = await middleOf(page, '.pose-tile', 1);

  // A swipe over the poses scrolls them and places nothing.
  const scrolled = () => page.locator('.panel').evaluate((element) => element.scrollTop);
  const before = await scrolled();
  await fingers.drag([way(tile, { x: tile.x, y: tile.y - 120 }, 4)], { pause: 0 });
  await expect.poll(scrolled).toBeGreaterThan(before + 20);
  expect(await keys(page)).toEqual([]);

  // A tap places it.
  await page.locator('.pose-tile').nth(1).tap();
  await expect.poll(() => keys(page)).toHaveLength(1);
  const [placed] = await keys(page);
  expect(Math.min(...beats.map((beat) => Math.abs(beat - placed)))).toBeLessThan(0.02);

  const key = await middleOf(page, '.key-pose');
  await fingers.drag([way(key, { x: key.x + 110, y: key.y })]);
  await expect.poll(async () => (await keys(page))[0]).toBeGreaterThan(placed + 0.9);
  expect(await page.evaluate(() => window.scrollY)).toBe(0);
  expect(errors).toEqual([]);
});

test('the timeline pans under one finger and zooms under two', async ({ page }) => {
  await open(page);
  await loadSong(page, wav({ seconds: 40 }));
  const fingers = await Fingers.of(page);
  const surface = (await page.locator('.timeline-surface').boundingBox())!;
  const thumb = () =>
    page.locator('.scrollbar-thumb').evaluate((element) => {
      const { left, width } = element.getBoundingClientRect();
      return { left, width };
    });
  const middle = { x: surface.x + surface.width / 2, y: surface.y + 60 };
  const before = await thumb();
  await fingers.drag([way(middle, { x: middle.x - 120, y: middle.y })]);
  await expect.poll(async () => (await thumb()).left).toBeGreaterThan(before.left + 10);
  expect((await thumb()).width).toBeCloseTo(before.width, 0);

  const [left, right] = [-40, 40].map((offset) => ({ x: middle.x + offset, y: middle.y }));
  await fingers.drag([way(left, { ...left, x: left.x - 60 }), way(right, { ...right, x: right.x + 60 })]);
  await expect.poll(async () => (await thumb()).width).toBeLessThan(before.width * 0.75);
});

test('the sheet is put away for the stage and comes back', async ({ page }) => {
  await open(page);
  await loadSong(page, wav({ seconds: 12 }));
  const height = async () => (await page.locator('.stage').boundingBox())!.height;
  const before = await height();
  await page.getByRole('button', { name: 'Hide the panel' }).tap();
  await expect.poll(height).toBeGreaterThan(before + 150);
  await page.getByRole('button', { name: 'Show the panel' }).tap();
  await expect.poll(height).toBe(before);
});

test('playing and generating by a tap', async ({ page }) => {
  await serveTinyModel(page);
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: 6 }));
  await page.locator('.pose-tile').first().tap();
  await expect.poll(() => keys(page)).toHaveLength(1);
  await page.getByRole('button', { name: /^Generate/ }).tap();
  const rates = () => page.evaluate(() => window.posebeat.report().beatHitRate.length).catch(() => 0);
  await expect.poll(rates, { timeout: 90_000 }).toBe(5);
  const clock = page.locator('.readout-time');
  const start = await clock.innerText();
  await page.getByRole('button', { name: 'Play', exact: true }).tap();
  await expect(clock).not.toHaveText(start);
  await page.getByRole('button', { name: 'Pause', exact: true }).tap();
  await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible();
});
