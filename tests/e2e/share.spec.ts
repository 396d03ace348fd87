import { expect, test, type Browser, type Page } from '@playwright/test';
import { violations } from './support/axe';
import { misplaced } from './support/layout';
import { collectErrors, fourPoses, loadSong, open, reload, saved } from './support/page';
import { wav } from './support/songs';

const SONG = wav({ seconds: 6 });
const poses = fourPoses();

const json = (page: Page) => page.evaluate(() => JSON.stringify(window.posebeat.document()));
const place = (page: Page, times: number[]) =>
  page.evaluate(
    ({ times, poses }) => window.posebeat.setKeyPoses(times.map((time, i) => ({ time, rotations: poses[i % 4] }))),
    { times, poses },
  );
const linkOf = (page: Page) => page.evaluate(() => window.posebeat.shareLink());
const copied = (page: Page) => page.evaluate(() => (window as { copied?: string }).copied);
/** A dance that the page makes by itself is there. */
const danced = (page: Page) => page.locator('.generate.fresh').waitFor({ timeout: 110_000 });
/** What the project file says of the dance on stage. */
const motionOf = (page: Page) =>
  page.evaluate(async () => {
    const file = JSON.parse(await (await window.posebeat.exportAs('project')).text()) as { motion?: object };
    return file.motion;
  });

/** A fresh visitor who opens an address of this page. */
async function visitor(browser: Browser, address: string): Promise<Page> {
  const page = await (await browser.newContext()).newPage();
  await page.goto(address);
  await page.waitForFunction(() => 'posebeat' in window);
  await page.evaluate(() => window.posebeat.ready);
  return page;
}
/** The link with its question: WASM is the same everywhere. */
const onWasm = (link: string) => link.replace('#', '?backend=wasm#');

test('a link made in one browser profile opens in a fresh one to the same dance', async ({ page, browser }) => {
  test.slow();
  const errors = collectErrors(page);
  await open(page, '?backend=wasm');
  await place(page, [2, 4, 6.5, 9]);
  const link = await linkOf(page);
  expect(link).toMatch(/^http:\/\/127\.0\.0\.1:\d+\/#d=1\.[A-Za-z0-9_-]+$/);
  // Its maker looks at what others will see: poses rounded as the link has them.
  await page.evaluate((hash) => (location.hash = hash), new URL(link).hash);
  await expect(page.locator('.notices')).toContainText('Your own project is kept.');
  await danced(page);
  const made = await motionOf(page);
  expect(made).toMatchObject({ backend: 'wasm', motionHash: expect.stringMatching(/^[0-9a-f]{64}$/) });
  // Now it knows the model, too.
  const sent = await linkOf(page);
  const other = await visitor(browser, onWasm(sent));
  // At once, before the dance is made: the poses, and the demo's dance in motion.
  expect(await other.evaluate(() => window.posebeat.document().keyPoses.length)).toBe(4);
  await expect(other.getByRole('button', { name: 'Pause' })).toBeVisible();
  await danced(other);
  expect(await motionOf(other)).toEqual(made);
  expect(await json(other)).toBe(await json(page));
  expect(await linkOf(other)).toBe(sent);
  // Nothing of it is kept until it is changed.
  await other.waitForTimeout(1200);
  expect(new URL(other.url()).hash).toBe(new URL(sent).hash);
  await other.context().close();
  expect(errors).toEqual([]);
});

test('a link takes nothing from the project at hand: one press, and a reload, bring it back', async ({ page }) => {
  await open(page, '?backend=wasm');
  await place(page, [1, 3]);
  const hash = new URL(await linkOf(page)).hash;
  await loadSong(page, SONG, 'Mine.wav');
  await place(page, [1, 2.5, 4]);
  const mine = await json(page);
  await saved(page);

  await page.evaluate((hash) => (location.hash = hash), hash);
  await expect.poll(() => page.evaluate(() => window.posebeat.document().keyPoses.length)).toBe(2);
  await reload(page);
  // The link is still in the address; the own project lies behind it.
  expect(await page.evaluate(() => window.posebeat.document().keyPoses.length)).toBe(2);
  await page.locator('.notice', { hasText: 'Your own project is kept.' }).getByRole('button', { name: 'Undo' }).click();
  await expect.poll(() => json(page)).toBe(mine);
  await expect(page.locator('.song-title')).toContainText('Mine.wav');
  expect(new URL(page.url()).hash).toBe('');
  await reload(page);
  expect(await json(page)).toBe(mine);
  // And it lies aside, too, for later.
  await page.getByRole('button', { name: 'Save the project' }).click();
  await expect(page.getByRole('button', { name: 'Back to the project before the link' })).toBeVisible();
});

test('a link to a song of its maker’s asks for it, and knows it under another name', async ({ page, browser }) => {
  await open(page, '?backend=wasm');
  await loadSong(page, SONG, 'Mine.wav');
  await place(page, [1, 2.5, 4]);
  const times = await page.evaluate(() => window.posebeat.document().keyPoses.map(({ time }) => time));
  const link = await linkOf(page);

  const other = await visitor(browser, onWasm(link));
  await expect(other.locator('.welcome')).toContainText('A dance to “Mine.wav”');
  await expect(other.locator('.song-title')).toContainText('(demo)');
  expect(await other.evaluate(() => window.posebeat.document().keyPoses.length)).toBe(3);
  const chooser = other.waitForEvent('filechooser');
  await other.getByRole('button', { name: /Drop that song/ }).click();
  await (await chooser).setFiles({ name: 'track 7.wav', mimeType: 'audio/wav', buffer: SONG });
  await expect(other.locator('.song-title')).toContainText('track 7.wav');
  await expect(other.locator('.welcome')).toHaveCount(0);
  expect(await other.evaluate(() => window.posebeat.document().keyPoses.map(({ time }) => time))).toEqual(times);
  await danced(other);
  await other.context().close();
});

test('a damaged link says so and opens the page as ever', async ({ page, browser, baseURL }) => {
  const other = await visitor(browser, `${baseURL}#d=1.AAAAnonsense`);
  await expect(other.locator('.notices')).toContainText('copy it again, whole');
  expect(await other.evaluate(() => window.posebeat.document().song?.name)).toBe('Warm Circuit');
  expect(new URL(other.url()).hash).toBe('');
  await other.context().close();
  await open(page);
  const before = await json(page);
  await page.evaluate(() => (location.hash = '#d=99.AAAA'));
  await expect(page.locator('.notices')).toContainText('newer Posebeat');
  expect(await json(page)).toBe(before);
});

test('the panel by keyboard: opened, copied from, closed; nothing for axe to find', async ({ page }) => {
  // Reading the clipboard waits for a person in some browsers: what is written is caught on its way.
  await page.addInitScript(() => {
    // The walk-through moves for ever, and axe waits until nothing does.
    localStorage.setItem('posebeat.tour', 'seen');
    const writeText = (text: string) => Promise.resolve(void ((window as { copied?: string }).copied = text));
    Object.defineProperty(navigator, 'clipboard', { value: { writeText } });
  });
  await page.setViewportSize({ width: 1280, height: 800 });
  await open(page);
  await page.keyboard.press('Shift+S');
  const panel = page.getByRole('dialog', { name: 'Share this dance' });
  await expect(panel).toBeVisible();
  await expect(panel.getByRole('button', { name: 'Copy the link' })).toBeFocused();
  await page.keyboard.press('Enter');
  await expect(panel.getByRole('button', { name: 'Copied' })).toBeVisible();
  expect(await copied(page)).toBe(await linkOf(page));
  await panel.getByRole('button', { name: 'Copy the code' }).click();
  expect(await copied(page)).toMatch(/^<iframe src="[^"]+\?embed=1#d=1\.[^"]+" .*<\/iframe>$/);
  expect(await violations(page, '.share-panel')).toEqual([]);
  await page.keyboard.press('Escape');
  await expect(panel).toBeHidden();
  await expect(page.getByRole('button', { name: 'Share this dance' })).toBeFocused();
});

test('the panel on a phone: reached from the menu, whole on the screen, big enough for a finger', async ({
  browser,
  baseURL,
}) => {
  const context = await browser.newContext({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  const page = await context.newPage();
  await page.goto(baseURL!);
  await page.waitForFunction(() => 'posebeat' in window);
  await page.evaluate(() => window.posebeat.ready);
  await page.getByRole('button', { name: 'Save the project' }).tap();
  await page.getByRole('button', { name: /Share as a link/ }).tap();
  await expect(page.getByRole('dialog', { name: 'Share this dance' })).toBeVisible();
  expect(await misplaced(page, true)).toEqual([]);
  await context.close();
});

test('a dance too long for a link is offered as a file', async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 800 });
  await open(page);
  await page.evaluate(() => {
    // Noise: nothing in it repeats.
    const noise = (i: number, k: number) => ((Math.sin(i * 12.9898 + k * 78.233) * 43758.5453) % 1) * 3;
    const keys = Array.from({ length: 100 }, (_, k) => ({
      time: k / 2,
      rotations: Array.from({ length: 72 }, (_, i) => noise(i, k)),
    }));
    window.posebeat.setKeyPoses(keys);
  });
  await page.keyboard.press('Shift+S');
  const panel = page.getByRole('dialog', { name: 'Share this dance' });
  await expect(panel).toContainText('too long for a link');
  const download = page.waitForEvent('download');
  await panel.getByRole('button', { name: 'Save as a .posebeat file' }).click();
  expect((await download).suggestedFilename()).toBe('Warm Circuit.posebeat');
});
