import { expect, test, type Page } from '@playwright/test';
import { collectErrors, loadSong, open } from './support/page';
import { wav } from './support/songs';

const keys = (page: Page) =>
  page.evaluate(() => window.posebeat.document().keyPoses.map(({ time, name }) => ({ time, name })));
const beats = async (page: Page) => (await loadSong(page, wav({ seconds: 12 }))).beats;

/** Drags with real mouse events from the middle of one box to a point. */
async function drag(page: Page, from: { x: number; y: number }, to: { x: number; y: number }): Promise<void> {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(from.x + 8, from.y + 8, { steps: 2 });
  await page.mouse.move(to.x, to.y, { steps: 8 });
  await page.mouse.up();
}

test('a pose dragged from the library lands on a beat, moves, is deleted, and all of it is undone and redone', async ({
  page,
}) => {
  const errors = collectErrors(page);
  await open(page);
  const grid = await beats(page);
  const onBeat = (time: number) => Math.min(...grid.map((beat) => Math.abs(beat - time)));

  const tile = (await page.locator('.pose-tile').nth(1).boundingBox())!;
  const lane = (await page.locator('.key-lane').boundingBox())!;
  const middle = (box: typeof tile) => ({ x: box.x + box.width / 2, y: box.y + box.height / 2 });
  await drag(page, middle(tile), { x: lane.x + lane.width * 0.4, y: lane.y + lane.height / 2 });
  const [placed] = await keys(page);
  expect(placed.name).toBe(await page.locator('.pose-tile').nth(1).innerText());
  expect(onBeat(placed.time)).toBeLessThan(0.02);

  const button = page.locator('.key-pose');
  await drag(page, middle((await button.boundingBox())!), {
    x: lane.x + lane.width * 0.7,
    y: lane.y + lane.height / 2,
  });
  const [moved] = await keys(page);
  expect(moved.time).toBeGreaterThan(placed.time + 1);
  expect(onBeat(moved.time)).toBeLessThan(0.02);

  await button.focus();
  await page.keyboard.press('ArrowLeft');
  const [nudged] = await keys(page);
  expect(moved.time - nudged.time).toBeCloseTo(0.5, 1);
  await page.keyboard.press('Delete');
  expect(await keys(page)).toEqual([]);

  await page.keyboard.press('Control+z');
  expect(await keys(page)).toEqual([nudged]);
  await page.keyboard.press('Control+z');
  expect(await keys(page)).toEqual([moved]);
  await page.keyboard.press('Control+z');
  expect(await keys(page)).toEqual([placed]);
  await page.keyboard.press('Control+Shift+z');
  await page.keyboard.press('Control+y');
  expect(await keys(page)).toEqual([nudged]);
  expect(errors).toEqual([]);
});

test('without a mouse: Enter on a library pose adds it at the playhead', async ({ page }) => {
  await open(page);
  await beats(page);
  await page.locator('.pose-tile').first().focus();
  await page.keyboard.press('Enter');
  expect(await keys(page)).toHaveLength(1);
  await expect(page.locator('.key-pose')).toHaveCount(1);
});

test('a joint is turned in the pose editor and the pose goes onto the timeline', async ({ page }) => {
  await open(page);
  await beats(page);
  await page.locator('.pose-tile').first().focus();
  await page.keyboard.press('Enter');
  const before = await page.evaluate(() => window.posebeat.document().keyPoses[0].rotations);
  await page.locator('.key-pose').dblclick();
  await page.getByLabel('Joint', { exact: true }).selectOption({ label: 'Left elbow' });
  const angle = page.getByLabel('Turn y, degrees');
  await angle.fill('-75');
  await angle.press('Enter');
  await page
    .getByRole('button', { name: /update|add to timeline|done/i })
    .first()
    .click();
  const after = await page.evaluate(() => window.posebeat.document().keyPoses[0].rotations);
  const changed = after.flatMap((value, i) => (Math.abs(value - before[i]) > 1e-6 ? [Math.floor(i / 3)] : []));
  expect(new Set(changed)).toEqual(new Set([18]));
});
