/** The library beside its poses: placing exactly with Alt, and what it shows after the editor was in its place. */
import { readFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { loadSong, open } from './support/page';
import { wav } from './support/songs';

const spec = JSON.parse(readFileSync(new URL('../../web/core/spec.json', import.meta.url), 'utf8')) as { fps: number };

test.use({ viewport: { width: 1280, height: 800 } });

const keys = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses.map(({ time }) => time));
const tiles = (page: Page) => page.locator('.pose-tile');

async function openWithSong(page: Page): Promise<number[]> {
  await open(page);
  return (await loadSong(page, wav({ seconds: 12 }))).beats;
}

test('with Alt a pose goes exactly where it is clicked or dropped', async ({ page }) => {
  const beats = await openWithSong(page);
  const offBeat = (time: number) => Math.min(...beats.map((beat) => Math.abs(beat - time)));

  for (let i = 0; i < 7; i++) await page.keyboard.press('.');
  await tiles(page)
    .nth(1)
    .click({ modifiers: ['Alt'] });
  const playhead = 7 / spec.fps;
  expect(offBeat(playhead)).toBeGreaterThan(0.05);
  expect(await keys(page)).toEqual([expect.closeTo(playhead, 6)]);
  await page.keyboard.press('Control+z');

  // Dropped beside a beat it goes to it; with Alt it stays.
  const tile = (await tiles(page).nth(1).boundingBox())!;
  const lane = (await page.locator('.key-lane').boundingBox())!;
  const drop = async (x: number) => {
    await page.mouse.move(tile.x + tile.width / 2, tile.y + tile.height / 2);
    await page.mouse.down();
    await page.mouse.move(x, lane.y + lane.height / 2, { steps: 8 });
  };
  const middle = async () => {
    const box = (await page.locator('.key-pose').boundingBox())!;
    return box.x + box.width / 2;
  };
  await drop(lane.x + lane.width / 2);
  await page.mouse.up();
  await expect(page.locator('.key-pose')).toHaveCount(1);
  const [onBeat] = await keys(page);
  expect(offBeat(onBeat)).toBeLessThan(0.001);
  const beside = Math.round(await middle()) + 12;
  await page.keyboard.press('Control+z');
  await drop(beside);
  // Also when it is pressed only when the pose is there.
  await page.keyboard.down('Alt');
  await page.mouse.up();
  await page.keyboard.up('Alt');
  await expect(page.locator('.key-pose')).toHaveCount(1);
  expect(Math.abs((await middle()) - beside)).toBeLessThan(1);
  expect(offBeat((await keys(page))[0])).toBeGreaterThan(0.05);
});

test('the library is as it was left when the pose editor closes', async ({ page }) => {
  await openWithSong(page);
  const scrolled = () => page.locator('.panel').evaluate((element) => element.scrollTop);
  await page.locator('.panel').evaluate((element) => (element.scrollTop = 700));
  await expect.poll(scrolled).toBe(700);
  const editACopy = async (index: number) => {
    await tiles(page).nth(index).press('Shift+F10');
    await page.getByRole('menuitem', { name: 'Edit a copy' }).click();
    await expect(page.getByRole('toolbar', { name: 'Pose editor' })).toBeVisible();
    expect(await scrolled()).toBe(0);
    await page.getByRole('button', { name: 'Cancel' }).press('Enter');
    await expect(tiles(page).first()).toBeAttached();
  };
  await tiles(page).nth(16).focus();
  const before = await scrolled();
  expect(before).toBeGreaterThan(300);
  await editACopy(16);
  expect(await scrolled()).toBe(before);

  await page.getByPlaceholder('Search poses').fill('arm');
  const found = await tiles(page).count();
  expect(found).toBeGreaterThan(0);
  await editACopy(0);
  await expect(page.getByPlaceholder('Search poses')).toHaveValue('arm');
  await expect(tiles(page)).toHaveCount(found);
});
