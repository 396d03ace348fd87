import { expect, test } from '@playwright/test';
import { collectErrors, loadSong, open, reload, saved } from './support/page';
import { wav } from './support/songs';

test('the page opens on a demo that is already dancing, with neither model nor runtime loaded', async ({ page }) => {
  const errors = collectErrors(page);
  const requests: string[] = [];
  page.on('request', (request) => requests.push(request.url()));
  await open(page);
  await expect(page.getByText('Drop a song', { exact: true })).toBeVisible();
  const pose = () => page.evaluate(() => [...window.posebeat.motion().rotations.slice(0, 72 * 60)]);
  const motion = await pose();
  expect(motion.some((angle) => Math.abs(angle) > 0.3)).toBe(true);
  // The clock moves by itself: the bar and beat readout changes.
  const clock = page.locator('.readout-time');
  const first = await clock.innerText();
  await expect(clock).not.toHaveText(first);
  expect(requests.filter((url) => /\.onnx|ort-wasm|ort\./.test(url))).toEqual([]);
  expect(errors).toEqual([]);
});

test('the help overlay lists the shortcuts and Escape closes it', async ({ page }) => {
  await open(page);
  await page.keyboard.press('?');
  const help = page.getByRole('dialog');
  await expect(help).toBeVisible();
  await expect(help).toContainText('Generate');
  await page.keyboard.press('Escape');
  await expect(help).toBeHidden();
});

test('where the camera stands is found again after a reload, and undo does not move it', async ({ page }) => {
  await page.setViewportSize({ width: 800, height: 600 });
  await open(page);
  await loadSong(page, wav({ seconds: 4 }));
  const camera = () => page.evaluate(() => window.posebeat.document().camera);
  /** Which way the camera looks, radians about the upright. */
  const heading = async () => {
    const view = (await camera())!;
    return Math.atan2(view.position[0] - view.target[0], view.position[2] - view.target[2]);
  };
  const orbit = async (dx: number) => {
    const box = (await page.locator('.stage canvas').boundingBox())!;
    const [x, y] = [box.x + box.width / 2 + 60, box.y + 30];
    const before = JSON.stringify(await camera());
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx, y, { steps: 5 });
    await page.mouse.up();
    // Kept when the camera has come to rest.
    await expect.poll(async () => JSON.stringify(await camera())).not.toBe(before);
  };
  expect(await camera()).toBeNull();
  await orbit(80);
  const turned = await heading();
  expect(Math.abs(turned)).toBeGreaterThan(0.2);
  await page.locator('.pose-tile').first().click();
  await page.keyboard.press('Control+z');
  expect(await heading()).toBe(turned);

  await saved(page);
  await reload(page);
  expect(await heading()).toBe(turned);
  // The stage itself looks from there: the same way back ends where it began.
  await page.locator('.stage canvas').waitFor();
  await orbit(-80);
  expect(Math.abs(await heading())).toBeLessThan(Math.abs(turned) / 3);
  await page.getByRole('button', { name: 'Show the whole figure' }).click();
  await expect.poll(camera).toBeNull();
});
