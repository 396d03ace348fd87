import { expect, test, type Page } from '@playwright/test';
import { collectErrors, loadSong, open } from './support/page';
import { wav } from './support/songs';
import { serveTinyModel } from './support/tiny';
import { Fingers, middleOf, way } from './support/touch';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

const keys = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses.map(({ time }) => time));

/** Gives the held tile another picture as soon as the drag has begun, as the renderer does when it is ready. */
const renewPictureOnDrag = (page: Page) =>
  page.evaluate(() => {
    const watcher = new MutationObserver(() => {
      const picture = document.querySelector('.pose-tile[data-dragged] .pose-picture');
      if (!picture) return;
      watcher.disconnect();
      picture.replaceWith(picture.cloneNode(true));
    });
    watcher.observe(document.body, { childList: true });
  });

test('placing: a pose is held, dragged onto the lane and moved along it, or tapped; a swipe scrolls the poses instead', async ({
  page,
}) => {
  const errors = collectErrors(page);
  await open(page);
  const { beats } = await loadSong(page, wav({ seconds: 12 }));
  const fingers = await Fingers.of(page);
  const lane = (await page.locator('.key-lane').boundingBox())!;
  await page.locator('.pose-tile').nth(1).scrollIntoViewIfNeeded();
  const tile = await middleOf(page, '.pose-tile', 1);
  const onLane = { x: lane.x + lane.width * 0.45, y: lane.y + lane.height / 2 };

  // A swipe over the poses scrolls them and places nothing.
  const scrolled = () => page.locator('.panel').evaluate((element) => element.scrollTop);
  const before = await scrolled();
  await fingers.drag([way(tile, { x: tile.x, y: tile.y - 120 })]);
  await expect.poll(scrolled).toBeGreaterThan(before + 20);
  expect(await keys(page)).toEqual([]);

  // A tap places one on a beat.
  const offBeat = (time: number) => Math.min(...beats.map((beat) => Math.abs(beat - time)));
  await page.locator('.pose-tile').nth(1).tap();
  await expect.poll(() => keys(page)).toHaveLength(1);
  expect(offBeat((await keys(page))[0])).toBeLessThan(0.02);
  await page.keyboard.press('Control+z');
  await expect.poll(() => keys(page)).toEqual([]);

  // Held and dragged it lands on a beat, and nothing scrolls, though the rendered picture comes meanwhile.
  // A finger on poses that still glide only stops them.
  let last = -1;
  await expect.poll(async () => -last + (last = await scrolled()), { intervals: [300] }).toBe(0);
  const inSight = await page.locator('.pose-tile').evaluateAll((tiles) =>
    tiles.findIndex((each) => {
      const { left, top, width, height } = each.getBoundingClientRect();
      return each.contains(document.elementFromPoint(left + width / 2, top + height / 2));
    }),
  );
  const held = await middleOf(page, '.pose-tile', inSight);
  await renewPictureOnDrag(page);
  const released = page.evaluate(
    () =>
      new Promise<number>((resolve) => {
        const look = () => {
          const { top, height } = document.querySelector('.pose-tile[data-dragged]')!.getBoundingClientRect();
          resolve(top + height / 2);
        };
        window.addEventListener('pointerup', look, { capture: true, once: true });
      }),
  );
  await fingers.drag([way(held, onLane)], { hold: 400 });
  await expect.poll(() => keys(page)).toHaveLength(1);
  const [placed] = await keys(page);
  expect(offBeat(placed)).toBeLessThan(0.02);
  expect(await released).toBe(held.y);
  // The chosen pose's tools come above the tiles, and the browser scrolls by whole pixels to keep these where they are.
  expect(Math.abs((await middleOf(page, '.pose-tile', inSight)).y - held.y)).toBeLessThan(1);

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
