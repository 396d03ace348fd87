import { expect, test, type Page } from '@playwright/test';
import { collectErrors, loadSong, open } from './support/page';
import { wav } from './support/songs';

const keys = (page: Page) =>
  page.evaluate(() => window.posebeat.document().keyPoses.map(({ time, name }) => ({ time, name })));
/** The timeline's scale, from where its last key pose is drawn. */
const pixelsPerSecond = (page: Page) =>
  page
    .locator('.key-item')
    .last()
    .evaluate((item: HTMLElement) => parseFloat(item.style.left) / Number(item.dataset.time));
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

/** Puts key poses at these seconds, with ids k1, k2... */
const place = (page: Page, times: number[]) =>
  page.evaluate(
    (times) =>
      window.posebeat.setKeyPoses(
        times.map((time, i) => {
          const rotations = new Array<number>(72).fill(0);
          rotations[16 * 3 + 2] = 0.2 * (i + 1);
          return { time, rotations };
        }),
      ),
    times,
  );
const times = async (page: Page) => (await keys(page)).map(({ time }) => Math.round(time * 100) / 100);
const key = (page: Page, id: number) => page.locator(`[data-key="k${id}"]`);
const centre = async (page: Page, id: number) => {
  const box = (await key(page, id).boundingBox())!;
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
};
const chosen = (page: Page) =>
  page
    .locator('.key-pose[aria-pressed=true]')
    .evaluateAll((all) => all.map((each) => (each as HTMLElement).dataset.key));

test('key poses are selected by band, range and one by one, move together and are copied by dragging', async ({
  page,
}) => {
  const errors = collectErrors(page);
  await open(page);
  const grid = await beats(page);
  const at = [4, 8, 12, 16].map((beat) => grid[beat]);
  await place(page, at);
  const rounded = at.map((time) => Math.round(time * 100) / 100);
  expect(await times(page)).toEqual(rounded);
  const [a, b, c, d] = await Promise.all([1, 2, 3, 4].map((id) => centre(page, id)));

  // A band over the first two, from the empty lane.
  await page.mouse.move(a.x - 45, a.y);
  await page.mouse.down();
  await page.mouse.move((b.x + c.x) / 2, a.y + 5, { steps: 6 });
  await expect(page.locator('.key-band')).toBeVisible();
  await page.mouse.up();
  expect(await chosen(page)).toEqual(['k1', 'k2']);
  // Ctrl takes one more, and one out; Shift takes all between.
  await page.mouse.click(d.x, d.y, { delay: 5 });
  await page.keyboard.down('Control');
  await page.mouse.click(a.x, a.y);
  await page.keyboard.up('Control');
  expect(await chosen(page)).toEqual(['k1', 'k4']);
  await page.mouse.click(b.x, b.y);
  await page.keyboard.down('Shift');
  await page.mouse.click(d.x, d.y);
  await page.keyboard.up('Shift');
  expect(await chosen(page)).toEqual(['k2', 'k3', 'k4']);

  // Both selected ones go along, snapped; Escape in a drag takes it back; with Alt there is no snapping.
  await page.mouse.click(a.x, a.y);
  await page.keyboard.down('Control');
  await page.mouse.click(b.x, b.y);
  await page.keyboard.up('Control');
  const beat = (b.x - a.x) / 4;
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.mouse.move(a.x + beat * 1.2, a.y, { steps: 5 });
  expect(await times(page)).toEqual([grid[5], grid[9], at[2], at[3]].map((time) => Math.round(time * 100) / 100));
  await page.keyboard.press('Escape');
  await page.mouse.up();
  expect(await times(page)).toEqual(rounded);
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.keyboard.down('Alt');
  await page.mouse.move(a.x + beat * 1.3, a.y, { steps: 5 });
  await page.mouse.up();
  await page.keyboard.up('Alt');
  const free = await keys(page);
  expect((free[0].time - at[0]) / (grid[5] - grid[4])).toBeCloseTo(1.3, 1);
  await page.keyboard.press('Control+z');
  expect(await times(page)).toEqual(rounded);

  // With Ctrl the originals stay: one step of undo.
  await page.mouse.move(d.x, d.y);
  await page.mouse.down();
  await page.keyboard.down('Control');
  await page.mouse.move(d.x + beat * 2, d.y, { steps: 5 });
  await expect(page.locator('.drag-hint')).toContainText('+');
  await page.mouse.up();
  await page.keyboard.up('Control');
  expect(await times(page)).toEqual([...rounded, Math.round(grid[18] * 100) / 100]);
  await page.keyboard.press('Control+z');
  expect(await times(page)).toEqual(rounded);
  expect(errors).toEqual([]);
});

test('key poses by keyboard alone: walk, select, copy, lock, strength, distribute, zoom to them', async ({ page }) => {
  const errors = collectErrors(page);
  await open(page);
  const grid = await beats(page);
  await place(page, [grid[2], grid[3], grid[8]]);
  // What comes after a deleted one has the keyboard, at the end what comes before.
  for (const [gone, next] of [
    [0, 1],
    [2, 1],
  ]) {
    await page.locator('.key-pose').nth(gone).focus();
    const label = await page.locator('.key-pose').nth(next).getAttribute('aria-label');
    await page.keyboard.press('Delete');
    await expect(page.locator(':focus')).toHaveAttribute('aria-label', label!);
    await page.keyboard.press('Control+z');
  }

  await key(page, 1).focus();
  await page.keyboard.press('Shift+ArrowDown');
  expect(await chosen(page)).toEqual(['k1', 'k2']);
  await expect(key(page, 2)).toBeFocused();
  await page.keyboard.press('Shift+End');
  expect(await chosen(page)).toEqual(['k1', 'k2', 'k3']);
  await page.keyboard.press('d');
  const even = [2, 5, 8].map((beat) => Math.round(grid[beat] * 100) / 100);
  expect(await times(page)).toEqual(even);

  // The copy has the keyboard: it moves on by beats.
  await page.keyboard.press('Control+d');
  expect(await times(page)).toHaveLength(6);
  const copies = await chosen(page);
  expect(copies).toHaveLength(3);
  await page.keyboard.press('Control+z');
  expect(await times(page)).toEqual(even);

  // Locked: neither keys nor the editor change it, and a word says so.
  await key(page, 2).focus();
  await page.keyboard.press('Shift+L');
  await expect(key(page, 2)).toHaveAttribute('aria-label', /locked/);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Delete');
  expect(await times(page)).toEqual(even);
  await expect(page.getByText(/locked and stays/).first()).toBeVisible();
  await page.keyboard.press('Shift+L');

  // Strength by the slider: one step.
  const strength = page.getByRole('slider', { name: 'Strength', exact: true });
  await strength.focus();
  await strength.fill('40');
  await expect(key(page, 2)).toHaveAttribute('aria-label', /strength 40 %/);
  const stored = () => page.evaluate(() => window.posebeat.document().keyPoses.map((each) => each.strength ?? 1));
  expect(await stored()).toEqual([1, 0.4, 1]);
  await page.keyboard.press('Control+z');
  expect(await stored()).toEqual([1, 1, 1]);

  // Its time as a number, and its beat.
  await page.getByLabel('Time, s').fill('1.23');
  await page.getByLabel('Time, s').press('Enter');
  expect(await times(page)).toContain(1.23);
  await page.keyboard.press('Control+z');

  // Zoom: far in, to the selection, the whole song.
  const scale = () => pixelsPerSecond(page);
  await key(page, 1).focus();
  await page.keyboard.press('Shift+ArrowDown');
  await page.keyboard.press('0');
  const whole = await scale();
  await page.keyboard.press('Shift+0');
  await expect.poll(scale).toBeGreaterThan(whole * 2);
  await page.keyboard.press('0');
  await expect.poll(scale).toBeCloseTo(whole, 6);
  await page.keyboard.press('s');
  await expect(page.getByRole('radio', { name: 'Key poses snap to half beats' })).toBeChecked();
  expect(errors).toEqual([]);
});

test.describe('by touch', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('a finger drags a key pose, a long press selects one more, two fingers zoom', async ({ page }) => {
    await open(page);
    const grid = await beats(page);
    await place(page, [grid[2], grid[6]]);
    const client = await page.context().newCDPSession(page);
    const touch = (type: 'touchStart' | 'touchMove' | 'touchEnd', points: { x: number; y: number }[]) =>
      client.send('Input.dispatchTouchEvent', { type, touchPoints: points.map((point, id) => ({ ...point, id })) });

    const [a, b] = [await centre(page, 1), await centre(page, 2)];
    const beat = (b.x - a.x) / 4;
    await touch('touchStart', [a]);
    for (let step = 1; step <= 6; step += 1) await touch('touchMove', [{ x: a.x + (beat * step) / 3, y: a.y }]);
    await touch('touchEnd', []);
    expect(await times(page)).toEqual([grid[4], grid[6]].map((time) => Math.round(time * 100) / 100));

    await touch('touchStart', [b]);
    await expect.poll(() => chosen(page)).toEqual(['k1', 'k2']);
    await touch('touchEnd', []);
    expect(await chosen(page)).toEqual(['k1', 'k2']);

    const lane = (await page.locator('.timeline-surface').boundingBox())!;
    const scale = () => pixelsPerSecond(page);
    const before = await scale();
    const y = lane.y + 60;
    await touch('touchStart', [{ x: 150, y }]);
    await touch('touchStart', [
      { x: 150, y },
      { x: 250, y },
    ]);
    for (let step = 1; step <= 6; step += 1)
      await touch('touchMove', [
        { x: 150 - 10 * step, y },
        { x: 250 + 10 * step, y },
      ]);
    await touch('touchEnd', []);
    expect((await scale()) / before).toBeGreaterThan(1.8);

    // One finger on the music scrolls.
    const start = () =>
      page.locator('.key-rail').evaluate((rail) => new DOMMatrix((rail as HTMLElement).style.transform).e);
    const from = await start();
    await touch('touchStart', [{ x: 300, y }]);
    for (let step = 1; step <= 5; step += 1) await touch('touchMove', [{ x: 300 - 30 * step, y }]);
    await touch('touchEnd', []);
    expect(await start()).toBeLessThan(from - 100);
  });
});
