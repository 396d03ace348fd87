import { expect, test, type Page } from '@playwright/test';
import { collectErrors, fourPoses, loadSong, open, reload, saved } from './support/page';
import { wav } from './support/songs';
import { tapAlong } from './support/taps';

test.use({ viewport: { width: 1440, height: 900 } });

const SECONDS = 24;
const project = (page: Page) => page.evaluate(() => window.posebeat.document());
const grid = async (page: Page) => (await project(page)).grid;
const keyTimes = async (page: Page) => (await project(page)).keyPoses.map(({ time }) => time);
const away = (list: readonly number[], time: number) => Math.min(...list.map((each) => Math.abs(each - time)));

/** A song of 24 s at 120 beats a minute; the analysed beats. */
async function song(page: Page): Promise<number[]> {
  await open(page);
  const { beats } = await loadSong(page, wav({ seconds: SECONDS }));
  await expect(page.getByRole('button', { name: 'Beats', exact: true })).toBeEnabled();
  return beats;
}

const menuItem = (page: Page, name: string) =>
  page.getByRole('dialog', { name: 'Beats' }).getByRole('button', { name });
const inMenu = async (page: Page, name: string): Promise<void> => {
  await page.getByRole('button', { name: 'Beats', exact: true }).click();
  await menuItem(page, name).click();
  await page.keyboard.press('Escape');
};

async function drag(page: Page, selector: string, dx: number, modifier?: 'Shift' | 'Alt'): Promise<void> {
  const box = (await page.locator(selector).boundingBox())!;
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  if (modifier) await page.keyboard.down(modifier);
  await page.mouse.move(x + dx, y, { steps: 6 });
  await page.mouse.up();
  if (modifier) await page.keyboard.up(modifier);
}

test('tapping along with the song puts a halved tempo right', async ({ page }) => {
  const errors = collectErrors(page);
  const beats = await song(page);
  await inMenu(page, '÷ 2');
  expect((await grid(page))!.tempo).toBeCloseTo(60, 0);
  await expect(page.getByLabel('Tempo, beats per minute')).toHaveValue(/^(59|60)/);

  await page.keyboard.press('t'); // starts the song
  await expect(page.getByRole('button', { name: 'Pause' })).toBeVisible();
  await tapAlong(page, 14, 0.5);
  await expect(page.locator('.tap-text')).toContainText('BPM');
  await expect(page.locator('.tap-mark')).toHaveCount(14);
  await expect(page.locator('.tap-text')).toHaveText('Tap');
  const tapped = (await grid(page))!;
  expect(tapped.tempo).toBeCloseTo(120, 0);
  // Whatever the phase of the taps, the beats keep to the music: on its beats or right between them.
  const off = tapped.beats.map((time) => away(beats, time)).filter((distance) => distance < 0.26);
  expect(tapped.beats.length).toBeGreaterThan(45);
  expect(Math.max(...off) - Math.min(...off)).toBeLessThan(0.03);

  await page.keyboard.press('Control+z');
  expect((await grid(page))!.tempo).toBeCloseTo(60, 0);
  await page.keyboard.press('Control+z');
  expect(await grid(page)).toBeNull();
  expect(errors).toEqual([]);
});

test('Escape cancels tapping, and leaves the menu with the keyboard back on its button', async ({ page }) => {
  await song(page);
  await page.keyboard.press('t');
  for (let i = 0; i < 5; i += 1) await page.keyboard.press('t');
  await page.keyboard.press('Escape');
  await expect(page.locator('.tap-text')).toHaveText('Tap');
  // Longer than a page waits for one more tap.
  await page.waitForTimeout(2600);
  expect(await grid(page)).toBeNull();

  const button = page.getByRole('button', { name: 'Beats', exact: true });
  await button.focus();
  await page.keyboard.press('Enter');
  await expect(menuItem(page, '÷ 2')).toBeFocused();
  await page.keyboard.press('Escape');
  await expect(menuItem(page, '÷ 2')).toBeHidden();
  await expect(button).toBeFocused();
});

test('a beat is dragged by mouse and moved by keyboard; key poses go along, or not', async ({ page }) => {
  const errors = collectErrors(page);
  const beats = await song(page);
  const keys = [8, 20].map((index, i) => ({ time: beats[index], rotations: fourPoses()[i] }));
  await page.evaluate((poses) => window.posebeat.setKeyPoses(poses), keys);

  await drag(page, '[data-beat="8"]', 6);
  const dragged = (await grid(page))!;
  const by = dragged.beats[8] - beats[8];
  expect(by).toBeGreaterThan(0.03);
  expect(by).toBeLessThan(0.3);
  expect(dragged.beats[9]).toBe(beats[9]);
  expect((await keyTimes(page))[0]).toBeCloseTo(dragged.beats[8], 4);
  expect((await keyTimes(page))[1]).toBeCloseTo(beats[20], 6);
  await page.keyboard.press('Control+z');
  expect(await grid(page)).toBeNull();
  expect((await keyTimes(page))[0]).toBeCloseTo(beats[8], 6);

  // With Shift all later beats go along.
  await drag(page, '[data-beat="8"]', 6, 'Shift');
  const shifted = (await grid(page))!;
  expect(shifted.beats[20] - beats[20]).toBeCloseTo(shifted.beats[8] - beats[8], 5);
  expect((await keyTimes(page))[1]).toBeCloseTo(shifted.beats[20], 4);
  await page.keyboard.press('Control+z');

  // The same by keyboard, with key poses told to stay.
  const check = page.getByLabel('Key poses go along with their beats');
  await page.getByRole('button', { name: 'Beats', exact: true }).click();
  await check.uncheck();
  await page.keyboard.press('Escape');
  const beat = page.locator('[data-beat="8"]');
  await expect(beat).toHaveAttribute('aria-label', /^Beat \d of bar \d+, \d+\.\d\d s$/);
  await beat.focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  expect((await grid(page))!.beats[8]).toBeCloseTo(beats[8] + 0.02, 5);
  expect((await keyTimes(page))[0]).toBeCloseTo(beats[8], 6);
  await expect(beat).toBeFocused();
  await page.keyboard.press('ArrowDown');
  await expect(page.locator('[data-beat="9"]')).toBeFocused();
  await page.keyboard.press('b');
  expect((await grid(page))!.downbeats).toContain(beats[9]);
  await page.keyboard.press('End');
  await expect(page.locator(`[data-beat="${beats.length - 1}"]`)).toBeFocused();
  await page.keyboard.press('Delete');
  expect((await grid(page))!.beats).toHaveLength(beats.length - 1);
  for (let i = 0; i < 4; i += 1) await page.keyboard.press('Control+z');
  expect(await grid(page)).toBeNull();
  expect(errors).toEqual([]);
});

test('the menu and the keys shift, double, set bars and go back; a typed tempo is exact', async ({ page }) => {
  const beats = await song(page);
  await page.keyboard.press(']');
  expect((await grid(page))!.beats[5]).toBeCloseTo(beats[5] + 0.01, 5);
  await page.keyboard.press('[');
  expect((await grid(page))!.beats[5]).toBeCloseTo(beats[5], 5);
  await inMenu(page, '× 2');
  expect((await grid(page))!.tempo).toBeCloseTo(240, 0);
  await inMenu(page, '3/4');
  expect(await grid(page)).toMatchObject({ beatsPerBar: 3 });
  const field = page.getByLabel('Tempo, beats per minute');
  await field.fill('98.5');
  await field.press('Enter');
  expect((await grid(page))!.tempo).toBe(98.5);
  await inMenu(page, 'Beats as analysed');
  expect(await grid(page)).toBeNull();
});

test('the click goes with the song without an error, on and off', async ({ page }) => {
  const errors = collectErrors(page);
  await song(page);
  await page.evaluate(() => {
    const count = window as unknown as { clicks: number; at: number[] };
    count.clicks = 0;
    const start = OscillatorNode.prototype.start;
    OscillatorNode.prototype.start = function (...when) {
      count.clicks += 1;
      return start.apply(this, when);
    };
  });
  const clicks = () => page.evaluate(() => (window as unknown as { clicks: number }).clicks);
  await page.getByRole('button', { name: 'Sound on' }).click();
  await page.keyboard.press('k');
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await expect.poll(clicks).toBeGreaterThan(3);
  await page.keyboard.press('k');
  const stopped = await clicks();
  await page.waitForTimeout(1200);
  expect(await clicks()).toBe(stopped);
  expect(errors).toEqual([]);
});

test('the part to dance to is set by drag and keyboard, kept to by the player, and there after a reload', async ({
  page,
}) => {
  const beats = await song(page);
  await page.keyboard.press('0');
  const box = (await page.locator('.timeline-surface').boundingBox())!;
  await drag(page, '.trim-start', box.width / 4);
  const dragged = (await project(page)).trim!;
  expect(dragged.start).toBeGreaterThan(4);
  expect(away(beats, dragged.start)).toBeLessThan(1e-6);
  expect(dragged.end).toBeCloseTo(SECONDS, 1);

  await page.getByRole('slider', { name: 'End of the part to dance to' }).focus();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowLeft');
  const { trim } = await project(page);
  expect(trim!.end).toBeLessThan(SECONDS - 2);
  expect(away(beats, trim!.end)).toBeLessThan(1e-6);
  await page.keyboard.press('Shift+ArrowLeft');
  expect((await project(page)).trim!.end).toBeCloseTo(trim!.end - 1 / 30, 5);
  await page.keyboard.press('Control+z');
  expect((await project(page)).trim).toEqual(trim);
  await expect(page.locator('.trim-shade')).toHaveCount(2);

  const playhead = page.getByRole('slider', { name: 'Playhead' });
  await playhead.focus();
  await page.keyboard.press('Home');
  expect(Number(await playhead.getAttribute('aria-valuenow'))).toBeCloseTo(trim!.start, 0);
  await page.keyboard.press('End');
  expect(Number(await playhead.getAttribute('aria-valuenow'))).toBeCloseTo(trim!.end, 0);

  await page.keyboard.press(']');
  const kept = await project(page);
  await saved(page);
  await reload(page);
  const again = await project(page);
  expect(again.trim).toEqual(kept.trim);
  expect(again.grid).toEqual(kept.grid);
  await expect(page.locator('.trim-shade')).toHaveCount(2);

  await inMenu(page, 'Whole song');
  expect((await project(page)).trim).toBeNull();
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('a beat is dragged with a finger, and the tempo is tapped', async ({ page }) => {
    const beats = await song(page);
    const box = (await page.locator('[data-beat="4"]').boundingBox())!;
    const finger = await page.context().newCDPSession(page);
    const touch = (type: 'touchStart' | 'touchMove' | 'touchEnd', dx = 0) =>
      finger.send('Input.dispatchTouchEvent', {
        type,
        touchPoints: type === 'touchEnd' ? [] : [{ x: box.x + box.width / 2 + dx, y: box.y + box.height / 2 }],
      });
    await touch('touchStart');
    for (const dx of [4, 8, 9, 10]) await touch('touchMove', dx);
    await touch('touchEnd');
    const dragged = (await grid(page))!;
    expect(dragged.beats[4]).toBeGreaterThan(beats[4] + 0.03);
    expect(dragged.beats[5]).toBe(beats[5]);

    const tap = page.locator('.bar-button.tap');
    await tap.tap();
    await tap.tap();
    await expect(tap).toHaveText('3 more taps');
    await page.getByRole('button', { name: 'Beats', exact: true }).tap();
    const menu = page.getByRole('dialog', { name: 'Beats' });
    await expect(menu).toBeVisible();
    const inside = (await menu.boundingBox())!;
    expect(inside.x).toBeGreaterThanOrEqual(0);
    expect(inside.x + inside.width).toBeLessThanOrEqual(390);
    for (const button of await menu.getByRole('button').all()) {
      expect((await button.boundingBox())!.height).toBeGreaterThanOrEqual(44);
    }
  });
});
