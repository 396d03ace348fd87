import { expect, test, type Page } from '@playwright/test';
import { bvh } from './support/bvh';
import { collectErrors, loadSong, open } from './support/page';
import { wav } from './support/songs';

test.use({ viewport: { width: 1440, height: 900 } });

const keys = (page: Page) =>
  page.evaluate(() =>
    window.posebeat.document().keyPoses.map(({ time, name, rotations }) => ({ time, name, rotations: [...rotations] })),
  );
const own = (page: Page) => page.getByRole('list', { name: 'My poses' });
const tile = (page: Page, name: string) => page.getByRole('button', { name: `${name}: add at the playhead` });

async function openWithSong(page: Page): Promise<void> {
  await open(page);
  await loadSong(page, wav({ seconds: 12 }));
}

test('a pose of the library is dragged to the timeline, searched for and filtered', async ({ page }) => {
  const errors = collectErrors(page);
  await openWithSong(page);
  await page.getByPlaceholder('Search poses').fill('robot');
  await expect(page.locator('.pose-tile')).toHaveCount(1);
  const from = (await tile(page, 'Robot').boundingBox())!;
  const lane = (await page.locator('.key-lane').boundingBox())!;
  await page.mouse.move(from.x + from.width / 2, from.y + from.height / 2);
  await page.mouse.down();
  await page.mouse.move(lane.x + 200, lane.y + lane.height / 2, { steps: 8 });
  await page.mouse.up();
  expect((await keys(page)).map(({ name }) => name)).toEqual(['Robot']);
  await page.getByPlaceholder('Search poses').fill('zzz');
  await expect(page.getByText('No pose is called that.')).toBeVisible();
  await page.getByPlaceholder('Search poses').fill('');
  await page.getByRole('radio', { name: 'Vogue' }).check({ force: true });
  await expect(page.locator('.pose-sections h3')).toHaveText(['Vogue']);
  expect(errors).toEqual([]);
});

test('an own pose is saved, survives a reload, is exported, deleted, brought back and imported', async ({ page }) => {
  await openWithSong(page);
  await expect(page.getByText('Poses that you save come here.')).toBeVisible();
  await tile(page, 'Arabesque').click();
  const [placed] = await keys(page);
  await page.getByRole('button', { name: 'Save pose' }).click();
  await expect(own(page).locator('.pose-tile')).toHaveText(['Arabesque']);

  await page.reload();
  await page.evaluate(() => window.posebeat.ready);
  await expect(own(page).locator('.pose-tile')).toHaveText(['Arabesque']);

  const download = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Export', exact: true }).click();
  const file = await (await download).path();

  await own(page).locator('.pose-tile').focus();
  await page.keyboard.press('Delete');
  await expect(own(page)).toHaveCount(0);
  await page.getByRole('button', { name: 'Undo', exact: true }).last().click();
  await expect(own(page).locator('.pose-tile')).toHaveCount(1);
  await own(page).locator('.pose-tile').focus();
  await page.keyboard.press('Delete');
  await expect(own(page)).toHaveCount(0);

  const chooser = page.waitForEvent('filechooser');
  await page.getByRole('button', { name: 'Import' }).click();
  await (
    await chooser
  ).setFiles({
    name: 'my-poses.json',
    mimeType: 'application/json',
    buffer: await import('node:fs').then((fs) => fs.readFileSync(file)),
  });
  await expect(own(page).locator('.pose-tile')).toHaveText(['Arabesque']);
  await own(page).locator('.pose-tile').click();
  expect((await keys(page)).at(-1)?.rotations).toEqual(placed.rotations);
});

test('a frame of a BVH file is chosen, placed and saved; a broken file says so and changes nothing', async ({
  page,
}) => {
  const requests: string[] = [];
  page.on('request', (request) => requests.push(request.url()));
  await openWithSong(page);
  expect(requests.filter((url) => /bvh-read|npz-read|gltf-read/.test(url))).toEqual([]);
  const choose = async (name: string, buffer: Buffer) => {
    const chooser = page.waitForEvent('filechooser');
    await page.getByRole('button', { name: 'Import' }).click();
    await (await chooser).setFiles({ name, mimeType: 'application/octet-stream', buffer });
  };
  await choose('broken.bvh', bvh().subarray(0, 300));
  await expect(page.getByRole('alert').last()).toContainText('“broken.bvh” was not opened.');
  await choose('swing.bvh', bvh());
  await expect(page.getByRole('heading', { name: 'Choose a frame' })).toBeVisible();
  expect(requests.filter((url) => /gltf-read|npz-read/.test(url))).toEqual([]);

  const scrubber = page.getByRole('slider', { name: 'Frame' });
  await scrubber.focus();
  await page.keyboard.press('ArrowRight');
  await expect(scrubber).toHaveAttribute('aria-valuetext', '0.02 s, frame 2 of 3');
  await page.getByRole('button', { name: 'Add to timeline' }).click();
  const [placed] = await keys(page);
  expect(placed.name).toBe('swing 2');
  expect(placed.rotations[16 * 3 + 2]).toBeCloseTo(-1, 4);
  await page.locator('.pose-import').getByRole('button', { name: 'Save', exact: true }).click();
  await page.getByRole('button', { name: 'Close the file' }).click();
  await expect(own(page).locator('.pose-tile')).toHaveText(['swing 2']);
});

test('without a mouse: through the grid by arrow keys, adding, copying, renaming and deleting', async ({ page }) => {
  await openWithSong(page);
  await page.getByRole('radio', { name: 'All', exact: true }).focus();
  await page.keyboard.press('Tab');
  await expect(page.locator('.pose-tile:focus')).toHaveText('T-pose');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('End');
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('.pose-tile:focus')).toHaveText('A-pose');
  await page.keyboard.press('Enter');
  expect((await keys(page)).map(({ name }) => name)).toEqual(['A-pose']);

  await page.keyboard.press('Shift+F10');
  await expect(page.getByRole('menu', { name: 'A-pose' })).toBeVisible();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  await expect(own(page).locator('.pose-tile')).toHaveText(['A-pose']);

  await own(page).locator('.pose-tile').focus();
  await page.keyboard.press('F2');
  await expect(page.locator('.tile-rename')).toBeFocused();
  await page.keyboard.type('Scarecrow');
  await page.keyboard.press('Enter');
  await expect(own(page).locator('.pose-tile')).toHaveText(['Scarecrow']);
  await expect(own(page).locator('.pose-tile')).toBeFocused();
  await page.keyboard.press('Shift+F10');
  await expect(page.getByRole('menuitem').first()).toBeFocused();
  await page.keyboard.press('Escape');
  await expect(page.getByRole('menu')).toHaveCount(0);
  await page.keyboard.press('Delete');
  await expect(own(page)).toHaveCount(0);
});
