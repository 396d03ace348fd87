/** The walk-through for somebody who is here for the first time. */
import { expect, test, type Page } from '@playwright/test';
import { collectErrors, open } from './support/page';
import { wav } from './support/songs';
import { dismissAll } from './support/states';
import { serveTinyModel } from './support/tiny';

test.use({ viewport: { width: 1440, height: 900 }, contextOptions: { reducedMotion: 'reduce' } });

const card = (page: Page) => page.getByRole('region', { name: 'First steps' });
/** Longer than the page waits before it offers the steps. */
const OFFER = 2000;

test('four steps come by themselves, go on with what is really done, and do not come again', async ({ page }) => {
  const errors = collectErrors(page);
  await serveTinyModel(page);
  await open(page, '?backend=wasm', { tour: true });
  await expect(card(page)).toContainText('1 of 4');
  await expect(card(page)).toContainText('Start with your song');
  await dismissAll(page);

  // The card is in nobody's way: what it speaks of is pressed while it is there.
  const chooser = page.waitForEvent('filechooser');
  await page.getByRole('button', { name: 'Drop a song' }).click();
  await (await chooser).setFiles({ name: 'mine.wav', mimeType: 'audio/wav', buffer: wav({ seconds: 6 }) });
  await expect(card(page)).toContainText('2 of 4');
  await expect(card(page)).toContainText('Place a few poses');

  await page.locator('.pose-tile').nth(1).click();
  await expect(card(page)).toContainText('2 of 4');
  await page.keyboard.press('0');
  await page.getByRole('slider', { name: 'Playhead' }).focus();
  await page.keyboard.press('End');
  await page.locator('.pose-tile').nth(2).click();
  await expect(card(page)).toContainText('3 of 4');
  await expect(card(page)).toContainText('Make the dance');

  // While the model is on its way the button cancels that.
  await page.getByRole('button', { name: /^Generate/ }).click();
  await expect(card(page)).toContainText('4 of 4', { timeout: 60_000 });
  await expect(card(page)).toContainText('Play and change');
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await expect(card(page)).toHaveCount(0);
  await expect(page.getByText('Help (?) has these steps again')).toBeVisible();

  await page.reload();
  await page.evaluate(() => window.posebeat.ready);
  await page.waitForTimeout(OFFER);
  await expect(card(page)).toHaveCount(0);
  expect(errors).toEqual([]);
});

test('it can be skipped for good and reopened: by key, from the help, read to its end', async ({ page }) => {
  await open(page, '', { tour: true });
  await expect(card(page)).toContainText('1 of 4');
  await page.getByRole('button', { name: 'Skip the tour' }).click();
  await expect(card(page)).toHaveCount(0);
  await page.reload();
  await page.evaluate(() => window.posebeat.ready);
  await page.waitForTimeout(OFFER);
  await expect(card(page)).toHaveCount(0);

  await page.keyboard.press('h');
  const titles = ['Start with your song', 'Place a few poses', 'Make the dance', 'Play and change'];
  for (const [i, title] of titles.entries()) {
    await expect(card(page)).toContainText(`${i + 1} of 4`);
    await expect(card(page)).toContainText(title);
    // Each points at something that can be seen, and lies over no other control.
    await expect(page.locator('.tour-ring')).toBeVisible();
    const next = page.getByRole('button', { name: i < 3 ? 'Next step' : 'Finish the tour' });
    // Under the pointer it keeps the card's light colours, on which its dark words can be read.
    await next.hover();
    await expect(next).toHaveCSS('background-color', 'rgb(223, 228, 236)');
    await next.focus();
    await page.keyboard.press('Enter');
  }
  await expect(card(page)).toHaveCount(0);

  await page.keyboard.press('?');
  await page.getByRole('button', { name: 'Show the first steps' }).click();
  await expect(card(page)).toContainText('1 of 4');
  await page.keyboard.press('Escape');
  await expect(card(page)).toHaveCount(0);
});
