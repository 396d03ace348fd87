import { expect, test, type Page } from '@playwright/test';
import { collectErrors, fourPoses, loadSong, open, rejection } from './support/page';
import { wav } from './support/songs';

const SONG = wav({ seconds: 16, tempo: 120 });

const keys = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses);

/** Opens the page with a song and waits until poses can be suggested. */
async function withSong(page: Page) {
  await open(page, '?backend=wasm', { ahead: true });
  const song = await loadSong(page, SONG);
  await expect(page.getByRole('button', { name: 'Suggest', exact: true })).toBeEnabled();
  return song;
}

/** Waits until the suggestions are all there. */
const finished = (page: Page) =>
  expect(
    page
      .getByRole('status')
      .or(page.locator('.notice'))
      .filter({ hasText: /key poses suggested/ })
      .first(),
  ).toBeVisible({
    timeout: 60_000,
  });

test('an empty timeline is filled with poses on beats, around an own one; one alternate, undo, dance', async ({
  page,
}) => {
  const errors = collectErrors(page);
  // Unasked, while the song is listened to.
  const model = page.waitForRequest('**/models/suggest.onnx*');
  const song = await withSong(page);
  await model;
  await expect(page.getByRole('button', { name: 'Suggest key poses' })).toBeVisible();
  const own = fourPoses()[0];
  await page.evaluate((rotations) => window.posebeat.setKeyPoses([{ time: 5.1, rotations }]), own);
  await page.getByRole('button', { name: 'What to suggest' }).click();
  await page
    .getByRole('radiogroup', { name: 'A pose every' })
    .getByRole('radio', { name: 'Beat' })
    .check({ force: true });
  await page
    .getByRole('dialog', { name: 'What to suggest' })
    .getByRole('button', { name: 'Suggest key poses' })
    .click();
  await finished(page);

  const made = await keys(page);
  expect(made.length).toBeGreaterThan(24);
  const mine = made.filter(({ suggested }) => !suggested);
  expect(mine.map(({ time, rotations }) => ({ time, rotations }))).toEqual([{ time: 5.1, rotations: own }]);
  for (const { time, suggested } of made)
    if (suggested) expect(Math.min(...song.beats.map((beat) => Math.abs(beat - time)))).toBeLessThan(1e-6);
  // They move: neighbours are not the same pose.
  const changed = made
    .slice(1)
    .filter(({ rotations }, i) => rotations.some((v, j) => Math.abs(v - made[i].rotations[j]) > 0.05));
  expect(changed.length).toBeGreaterThan(0.8 * made.length);

  // Another pose for one of them, by keyboard, and back.
  const suggestion = page.getByRole('button', { name: /suggested/ }).nth(2);
  const id = await suggestion.getAttribute('data-key');
  await suggestion.focus();
  const stepper = page.getByRole('group', { name: 'Other poses for this suggestion' });
  await expect(stepper).toContainText(/1 of [4-9]/, { timeout: 30_000 });
  await page.keyboard.press('n');
  await expect(stepper).toContainText(/2 of/);
  const flipped = await keys(page);
  const differ = flipped.filter((key, i) => JSON.stringify(key) !== JSON.stringify(made[i]));
  expect(differ.map((key) => key.id)).toEqual([id]);
  await stepper.getByRole('button', { name: 'Previous alternate' }).click();
  await expect(stepper).toContainText(/1 of/);
  expect(await keys(page)).toEqual(made);

  // Two flips and the suggestion are three steps back.
  for (let i = 0; i < 3; i++) await page.keyboard.press('Control+z');
  expect(await keys(page)).toHaveLength(1);
  for (let i = 0; i < 3; i++) await page.keyboard.press('Control+Shift+z');
  expect(await keys(page)).toEqual(made);

  await page.evaluate(() => window.posebeat.generate({ seed: 1 }));
  expect((await page.evaluate(() => window.posebeat.report())).consistencyError).toBeLessThan(1e-6);
  expect(errors).toEqual([]);
});

test('the API suggests the same poses for the same seed, keeps to a range, and says what is wrong', async ({
  page,
}) => {
  await withSong(page);
  const suggest = (options: object) => page.evaluate((options) => window.posebeat.suggestKeyPoses(options), options);
  const bars = await suggest({ density: 'bar', seed: 4 });
  expect(bars.length).toBeGreaterThan(5);
  expect(bars[0].rotations).toHaveLength(72);
  await suggest({ density: 'bar', seed: 5 });
  expect(await suggest({ density: 'bar', seed: 4 })).toEqual(bars);
  const part = await suggest({ density: 'beat', range: { start: 4, end: 7.9 } });
  expect(part.every(({ time }) => time >= 4 && time <= 7.9)).toBe(true);
  const outside = (list: { time: number }[]) =>
    list.filter(({ time }) => time < 4 || time > 7.9).map(({ time }) => time);
  expect(outside(await keys(page))).toEqual(outside(bars));
  const before = await keys(page);
  expect(await rejection(suggest({ density: 'sometimes' }))).toMatch(/"beat", "half" or "bar"/);
  expect(await rejection(suggest({ range: { start: 9, end: 2 } }))).toMatch(/inside the song/);
  expect(await keys(page)).toEqual(before);
});

test('a model of another version is refused in words, and the timeline stays', async ({ page }) => {
  await page.route('**/models/suggest.json', async (route) => {
    const response = await route.fetch();
    const manifest = (await response.json()) as Record<string, unknown>;
    await route.fulfill({ json: { ...manifest, specHash: 'f'.repeat(64) } });
  });
  await withSong(page);
  await page.getByRole('button', { name: 'Suggest key poses' }).focus();
  await page.keyboard.press('Enter');
  await expect(page.getByText(/made for another version of Posebeat/).first()).toBeVisible();
  expect(await keys(page)).toEqual([]);
});
