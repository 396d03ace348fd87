import { expect, test, type Page } from '@playwright/test';
import { collectErrors, fourPoses, loadSong, open, reload, saved } from './support/page';
import { wav } from './support/songs';
import { serveTinyModel } from './support/tiny';

test.use({ viewport: { width: 1440, height: 900 } });

/** Bars of two seconds. */
const SONG = { seconds: 18 };
const FRAMES = 18 * 30;

/** What the visitor has now: the dance in full, and the ranges of the document. */
const now = (page: Page) =>
  page.evaluate(() => {
    const { rotations, root } = window.posebeat.motion();
    return { rotations: [...rotations], root: [...root], ranges: window.posebeat.document().ranges };
  });
type Shown = Awaited<ReturnType<typeof now>>;

/** Largest difference of two dances on frames [from, to). */
const apart = (a: Shown, b: Shown, from: number, to: number) => {
  let most = 0;
  for (let i = from * 72; i < to * 72; i++) most = Math.max(most, Math.abs(a.rotations[i] - b.rotations[i]));
  for (let i = from * 3; i < to * 3; i++) most = Math.max(most, Math.abs(a.root[i] - b.root[i]));
  return most;
};

/** Waits until nothing is being made. */
const calm = async (page: Page) => {
  await expect(page.locator('.generate.busy')).toHaveCount(0, { timeout: 120_000 });
  await expect(page.locator('.generate')).toHaveClass(/fresh/);
};

/** Drags over the bar numbers from one beat to another, counted from 0. */
async function select(page: Page, from: number, to: number): Promise<void> {
  const { y } = (await page.locator('.timeline-surface').boundingBox())!;
  const place = async (beat: number) => {
    const box = (await page.locator(`[data-beat="${beat}"]`).boundingBox())!;
    return box.x + box.width / 2;
  };
  const [a, b] = [await place(from), await place(to)];
  await page.mouse.move(a, y + 10);
  await page.mouse.down();
  await page.mouse.move((a + b) / 2, y + 10, { steps: 3 });
  await page.mouse.move(b, y + 10, { steps: 3 });
  await page.mouse.up();
}

test('bars 5 to 8 are made anew, takes are switched by mouse and keyboard, all is undone, redone and found after a reload', async ({
  page,
}) => {
  test.setTimeout(300_000);
  const errors = collectErrors(page);
  await serveTinyModel(page);
  await open(page, '?backend=wasm');
  await loadSong(page, wav(SONG));
  await page.evaluate(
    (poses) => window.posebeat.setKeyPoses(poses.map((rotations, i) => ({ time: 2 + 5 * i, rotations }))),
    fourPoses(),
  );
  await page.locator('.generate').click();
  await calm(page);
  const first = await now(page);

  await select(page, 16, 32);
  const tools = page.getByRole('group', { name: 'Selected range, bars 5–8' });
  await tools.getByRole('button', { name: 'Regenerate 5–8' }).click();
  await expect(page.locator('.range-chip')).toHaveText('1/1');
  await calm(page);
  const second = await now(page);
  const [{ start, end }] = second.ranges;
  const [from, to] = [Math.round(start * 30), Math.round(end * 30)];
  expect([start, end].map(Math.round)).toEqual([8, 16]);
  expect(apart(first, second, 0, from)).toBeLessThan(1e-5);
  expect(apart(first, second, to, FRAMES)).toBeLessThan(1e-5);
  expect(apart(first, second, from + 30, to - 30)).toBeGreaterThan(0.1);
  // The key poses inside, at 12 s, are hit all the same.
  const errorsOfKeys = await page.evaluate(() => window.posebeat.report().consistencyPerKey.map(({ error }) => error));
  for (const error of errorsOfKeys) expect(error).toBeLessThan(1e-3);

  await page.keyboard.press('Shift+G');
  await expect(page.locator('.range-chip')).toHaveText('2/2');
  await calm(page);
  const third = await now(page);
  expect(apart(second, third, from + 30, to - 30)).toBeGreaterThan(0.05);
  expect(apart(second, third, to, FRAMES)).toBeLessThan(1e-5);

  // By mouse: the chip's menu.
  const chip = page.locator('.range-chip');
  await chip.click();
  await page.getByRole('radio', { name: 'Take 1' }).check();
  await expect(chip).toHaveText('1/2');
  await calm(page);
  expect(apart(await now(page), second, 0, FRAMES)).toBe(0);
  await page.getByRole('radio', { name: 'Whole dance' }).check();
  await expect(chip).toHaveText('–/2');
  await calm(page);
  expect(apart(await now(page), first, 0, FRAMES)).toBe(0);
  await page.keyboard.press('Escape');
  await expect(chip).toBeFocused();

  // By keyboard: on the chip, and from anywhere.
  await page.keyboard.press('ArrowLeft');
  await expect(chip).toHaveText('2/2');
  await page.keyboard.press('Alt+ArrowLeft');
  await expect(chip).toHaveText('1/2');
  await calm(page);
  expect(apart(await now(page), second, 0, FRAMES)).toBe(0);

  // A and B.
  await page.keyboard.press('a');
  const badge = page.getByRole('group', { name: 'Compare two dances' });
  await expect(badge.getByRole('radio', { name: /^B/ })).toBeChecked();
  await page.keyboard.press('Alt+ArrowRight');
  await expect(chip).toHaveText('2/2');
  await page.keyboard.press('a');
  await expect(badge.getByRole('radio', { name: /^A/ })).toBeChecked();
  await calm(page);
  expect(apart(await now(page), third, 0, FRAMES)).toBe(0);
  await badge.getByRole('button', { name: 'End the comparison' }).click();

  // Six steps back is the first dance; six on, the last one.
  for (let i = 0; i < 6; i++) await page.keyboard.press('Control+z');
  await expect(chip).toHaveText('1/1');
  await page.keyboard.press('Control+z');
  await expect(chip).toHaveCount(0);
  await calm(page);
  expect(apart(await now(page), first, 0, FRAMES)).toBe(0);
  for (let i = 0; i < 7; i++) await page.keyboard.press('Control+Shift+z');
  await expect(chip).toHaveText('2/2');
  await calm(page);
  const last = await now(page);
  expect(apart(last, third, 0, FRAMES)).toBe(0);

  // All of it made anew in one go is the same dance to the last bit.
  await page.evaluate(() => window.posebeat.generate());
  expect(apart(await now(page), last, 0, FRAMES)).toBe(0);

  await saved(page, { dance: true });
  await reload(page);
  await expect(chip).toHaveText('2/2');
  await calm(page);
  const back = await now(page);
  expect(back.ranges).toEqual(last.ranges);
  expect(apart(back, last, 0, FRAMES)).toBe(0);
  await chip.focus();
  await page.keyboard.press('Delete');
  await expect(chip).toHaveCount(0);
  await calm(page);
  expect(apart(await now(page), first, 0, FRAMES)).toBe(0);
  expect(errors).toEqual([]);
});
