import { readFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { collectErrors, fourPoses, loadSong, open } from './support/page';
import { wav } from './support/songs';
import { serveTinyModel } from './support/tiny';

const TIMES = [1, 3, 6.5, 9];
const DESKTOP = { width: 1440, height: 900 };

declare global {
  interface Window {
    /** Counts what the page asks the generate worker for. */
    runs: number;
  }
}

/** A page with a song, four key poses and a dance by the tiny model. */
async function dance(page: Page): Promise<void> {
  await page.setViewportSize(DESKTOP);
  await serveTinyModel(page);
  await page.addInitScript(() => {
    window.runs = 0;
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (this: Worker, ...given: Parameters<typeof post>) {
      if ((given[0] as { type?: string }).type === 'generate') window.runs += 1;
      return post.apply(this, given);
    } as typeof post;
  });
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: 12 }), 'Click Song.wav');
  const keys = fourPoses().map((rotations, i) => ({ time: TIMES[i], rotations, name: `Pose ${i + 1}` }));
  await page.evaluate(async (keys) => {
    window.posebeat.setKeyPoses(keys);
    await window.posebeat.generate();
  }, keys);
}

const tab = (page: Page, name: string) => page.getByRole('tab', { name }).click();
const error = (page: Page) => page.evaluate(() => window.posebeat.report().consistencyError);
const motion = (page: Page) => page.evaluate(() => [...window.posebeat.motion().rotations]);
const runs = (page: Page) => page.evaluate(() => window.runs);

test('the report tells each number with a unit and a sentence, and goes to the key poses', async ({ page }) => {
  const errors = collectErrors(page);
  await dance(page);
  await tab(page, 'Report');
  const card = (name: string) => page.getByRole('region', { name, exact: true });
  await expect(card('Your key poses')).toContainText('Exact');
  await expect(card('Your key poses').getByRole('listitem')).toHaveCount(4);
  const report = await page.evaluate(() => {
    const { consistencyPerKey, beatHitRate, jerk, motionBeats, speed, meanSpeed } = window.posebeat.report();
    return { consistencyPerKey, beatHitRate, jerk, motionBeats, speeds: speed.length, meanSpeed };
  });
  expect(report.consistencyPerKey.map(({ time }) => time)).toEqual(TIMES);
  expect(report.speeds).toBe(359);
  expect(report.meanSpeed).toBeGreaterThan(0);
  expect(report.motionBeats.length).toBeGreaterThan(0);
  await expect(card('On the beat')).toContainText(`${Math.round(report.beatHitRate[2] * 100)}%`);
  await expect(card('On the beat')).toContainText('real dancers');
  await expect(card('On the beat').locator('tbody tr')).toHaveCount(5);
  await expect(card('Smoothness')).toContainText(`${report.jerk.toFixed(0)} m/s³`);
  await expect(card('Smoothness')).toContainText('people dance');
  await expect(card('Foot sliding')).toContainText('cm/s');

  await card('Your key poses')
    .getByRole('button', { name: /Pose 3/ })
    .focus();
  await page.keyboard.press('Enter');
  await expect(page.locator('.readout-time')).toContainText('0:06.5');
  await expect(page.locator('.key-pose.chosen')).toHaveAttribute('aria-label', /6\.50 s/);
  expect(errors).toEqual([]);
});

test('key strength moves the dance without the network: 0 leaves it, 1 is exact, undo brings it back', async ({
  page,
}) => {
  await dance(page);
  expect(await error(page)).toBeLessThan(1e-6);
  const exact = await motion(page);
  const before = await runs(page);
  await tab(page, 'Dance');
  const dial = page.getByRole('slider', { name: 'Key strength', exact: true });
  await dial.focus();
  await page.keyboard.press('Home');
  await expect.poll(() => error(page)).toBeGreaterThan(1e-4);
  await page.keyboard.press('End');
  await expect.poll(() => error(page)).toBeLessThan(1e-6);
  expect(await motion(page)).toEqual(exact);
  await expect(page.getByRole('button', { name: 'Generate' }).locator('.stale-dot')).toHaveCount(0);

  // The same on the plot, by keyboard and by mouse.
  const handle = page.getByRole('slider', { name: 'Key strength on the plot' });
  await expect(page.locator('.trade-off-dot')).toHaveCount(9);
  await handle.focus();
  await page.keyboard.press('PageDown');
  await expect(dial).toHaveValue('90');
  await page.locator('.trade-off svg').scrollIntoViewIfNeeded();
  const plot = (await page.locator('.trade-off svg').boundingBox())!;
  await page.mouse.move(plot.x + plot.width - 20, plot.y + plot.height / 2);
  await page.mouse.down();
  await page.mouse.move(plot.x + plot.width - 16, plot.y + plot.height / 2, { steps: 3 });
  await page.mouse.up();
  await expect.poll(async () => Number(await dial.inputValue())).toBeLessThan(30);
  await expect.poll(() => error(page)).toBeGreaterThan(1e-4);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await expect(dial).toHaveValue('100');
  await expect.poll(() => error(page)).toBeLessThan(1e-6);
  expect(await runs(page)).toBe(before);
});

test('takes: the next is another dance, the one before comes back at once and as it was', async ({ page }) => {
  await dance(page);
  await tab(page, 'Dance');
  const first = await motion(page);
  const made = await runs(page);
  await page.getByRole('button', { name: 'Next take' }).focus();
  await page.keyboard.press('Enter');
  await expect.poll(() => runs(page)).toBe(made + 1);
  await expect(page.locator('.generate.fresh')).toBeVisible();
  const second = await motion(page);
  const apart = first.reduce((sum, angle, i) => sum + Math.abs(angle - second[i]), 0) / first.length;
  expect(apart).toBeGreaterThan(0.003);

  const number = page.getByRole('spinbutton', { name: 'Take' });
  await expect(number).toHaveValue('2');
  await page.getByRole('button', { name: 'Previous take' }).click();
  await expect(number).toHaveValue('1');
  await expect.poll(() => motion(page)).toEqual(first);
  expect(await runs(page), 'takes that were made are kept').toBe(made + 1);
  await number.fill('2');
  await number.press('Enter');
  await expect.poll(() => motion(page)).toEqual(second);

  // The same number made anew is the same dance.
  await page.evaluate(() => window.posebeat.generate({ seed: 1 }));
  expect(await motion(page)).toEqual(first);
  await page.getByRole('button', { name: 'Another take' }).click();
  await expect.poll(() => runs(page)).toBe(made + 3);
  expect(await number.inputValue()).not.toBe('2');
});

test('motion against music lies on the timeline: it scrolls with it, the playhead crosses it, V hides it', async ({
  page,
}) => {
  await dance(page);
  await tab(page, 'Report');
  await page.getByRole('button', { name: 'See the moves on the timeline' }).click();
  const lane = page.getByRole('group', { name: 'Motion against music' });
  await expect(lane).toBeVisible();
  await expect(lane).toContainText('m/s');
  const box = (await lane.boundingBox())!;
  const playhead = (await page.locator('.playhead').boundingBox())!;
  expect(playhead.y).toBeLessThan(box.y);
  expect(playhead.y + playhead.height).toBeGreaterThanOrEqual(box.y + box.height - 1);
  await page.locator('.timeline-surface').hover();
  for (let i = 0; i < 4; i++) await page.keyboard.press('+');

  /** Columns of the lane that hold something violet, and their mean height. */
  const curve = () =>
    lane.locator('canvas').evaluate((element) => {
      const canvas = element as HTMLCanvasElement;
      const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
      return Array.from({ length: canvas.width }, (_, x) => {
        let [sum, count] = [0, 0];
        for (let y = 0; y < canvas.height; y++) {
          const i = (y * canvas.width + x) * 4;
          if (data[i] > 120 && data[i + 2] > 200 && data[i + 1] < 190) [sum, count] = [sum + y, count + 1];
        }
        return count ? sum / count : -1;
      });
    });
  const still = await curve();
  expect(still.filter((height) => height >= 0).length).toBeGreaterThan(still.length * 0.8);
  expect(new Set(still.map(Math.round)).size, 'a curve, not a line').toBeGreaterThan(8);
  const SHIFT = 60;
  await page.mouse.wheel(SHIFT, 0);
  await expect.poll(async () => (await curve())[0]).not.toBe(still[0]);
  const moved = await curve();
  const same = moved.slice(0, 1000).filter((height, x) => Math.abs(height - still[x + SHIFT]) < 1).length;
  expect(same).toBeGreaterThan(950);

  await page.keyboard.press('v');
  await expect(lane).toBeHidden();
  await page.getByRole('button', { name: 'Motion against music' }).click();
  await expect(lane).toBeVisible();
  await lane.getByRole('button', { name: /hide/i }).click();
  await expect(lane).toBeHidden();
});

test('the picture of two dances is saved; document and dance stay as they are', async ({ page }) => {
  // Some 36 figures, each drawn in software here.
  test.setTimeout(300_000);
  await dance(page);
  const before = await page.evaluate(() => JSON.stringify(window.posebeat.document()));
  const shown = await motion(page);
  await tab(page, 'Report');
  const download = page.waitForEvent('download', { timeout: 240_000 });
  await page.getByRole('button', { name: 'Save picture' }).click();
  const file = await download;
  expect(file.suggestedFilename()).toBe('Click Song in two dances.png');
  const bytes = readFileSync(await file.path());
  const look = await page.evaluate(async (base64) => {
    const blob = await (await fetch(`data:image/png;base64,${base64}`)).blob();
    const bitmap = await createImageBitmap(blob);
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const brush = canvas.getContext('2d')!;
    brush.drawImage(bitmap, 0, 0);
    const count = (top: number, bottom: number, is: (r: number, g: number, b: number) => boolean) => {
      const { data } = brush.getImageData(0, top, bitmap.width, bottom - top);
      let found = 0;
      for (let i = 0; i < data.length; i += 4) if (is(data[i], data[i + 1], data[i + 2])) found += 1;
      return found;
    };
    const amber = (r: number, g: number, b: number) => r > 240 && g > 165 && g < 195 && b > 60 && b < 110;
    const pale = (r: number, g: number, b: number) => r > 200 && g > 200 && b > 200;
    return {
      size: [bitmap.width, bitmap.height],
      music: count(168, 338, (r, g, b) => r < 110 && g > 180 && b > 220),
      frames: [count(362, 674, amber), count(698, 1010, amber)],
      figures: [count(362, 674, pale), count(698, 1010, pale)],
    };
  }, bytes.toString('base64'));
  expect(look.size[0]).toBe(2400);
  expect(look.size[1]).toBeGreaterThan(1000);
  expect(look.music).toBeGreaterThan(5000);
  for (const amount of look.frames) expect(amount, 'key poses are framed').toBeGreaterThan(3000);
  for (const amount of look.figures) expect(amount, 'figures are drawn').toBeGreaterThan(5000);
  expect(await page.evaluate(() => JSON.stringify(window.posebeat.document()))).toBe(before);
  expect(await motion(page)).toEqual(shown);

  // It can be stopped, and a dance of the visitor's comes first.
  await page.getByRole('button', { name: 'Save picture' }).click();
  await page.getByTitle('Stop the picture').click();
  await expect(page.getByRole('button', { name: 'Save picture' })).toBeEnabled();
  await expect(page.locator('.notice.error', { hasText: /picture/i })).toHaveCount(0);
});
