/** Where there is nothing yet, the page says what to do. */
import { expect, test, type Page } from '@playwright/test';
import { loadSong, open } from './support/page';
import { wav } from './support/songs';
import { dismissAll } from './support/states';

test.use({ viewport: { width: 1440, height: 900 }, contextOptions: { reducedMotion: 'reduce' } });

const tab = (page: Page, name: string) => page.getByRole('tab', { name }).click();

test('without a song, and without the demo, every panel says how to begin', async ({ page }) => {
  await page.route('**/demo/**', (route) => route.abort());
  await open(page);
  await dismissAll(page);
  await expect(page.getByRole('button', { name: 'Drop a song' })).toBeVisible();
  await expect(page.locator('.song-title')).toHaveText('No song yet');
  for (const name of ['Play', 'Loop', 'Generate'])
    await expect(page.getByRole('button', { name, exact: true })).toBeDisabled();
  await expect(page.locator('.timeline')).toContainText('Drop a song');

  await page.locator('.pose-tile').first().click();
  await expect(page.getByRole('status').filter({ hasText: 'Drop a song first' })).toBeVisible();
  await expect(page.locator('.pose-sections')).toContainText('Poses that you save come here.');
  await tab(page, 'Report');
  await expect(page.locator('#inspector-panel')).toContainText('Generate a dance');
  await tab(page, 'Dance');
  await expect(page.locator('#inspector-panel')).toContainText('The model loads with your first dance');
});

test('with a song but without key poses, a dance or what was searched for, the way on is told', async ({ page }) => {
  await open(page);
  await loadSong(page, wav({ seconds: 6 }));
  await expect(page.getByText('Drag a pose here, or choose one in the list')).toBeVisible();
  await page.getByPlaceholder('Search poses').fill('zzz');
  await expect(page.getByText('Search for another word, or clear the search.')).toBeVisible();
  await page.getByPlaceholder('Search poses').fill('');
  await page.getByRole('button', { name: 'New pose' }).click();
  await expect(page.locator('#inspector-panel')).toContainText('Choose, or click the figure');
  await page.keyboard.press('Escape');
  await tab(page, 'Report');
  await expect(page.locator('#inspector-panel')).toContainText('Generate a dance, and this page tells how good it is');
  await page.keyboard.press('?');
  await page.getByPlaceholder('Search the keys').fill('zzz');
  await expect(page.getByText('No key does that.')).toBeVisible();
});
