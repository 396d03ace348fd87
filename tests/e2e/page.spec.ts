import AxeBuilder from '@axe-core/playwright';
import { expect, test } from '@playwright/test';
import { collectErrors, open } from './support/page';

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

for (const [name, viewport] of [
  ['desktop', { width: 1440, height: 900 }],
  ['phone', { width: 390, height: 844 }],
] as const) {
  test(`on a ${name} nothing is cut off and axe finds no violation of level A or AA`, async ({ page }) => {
    await page.setViewportSize(viewport);
    await open(page);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    expect(overflow).toBeLessThanOrEqual(0);
    const results = await new AxeBuilder({ page }).withTags(['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa']).analyze();
    expect(results.violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.target).join(', ')}`)).toEqual(
      [],
    );
  });
}

test('the help overlay lists the shortcuts and Escape closes it', async ({ page }) => {
  await open(page);
  await page.keyboard.press('?');
  const help = page.getByRole('dialog');
  await expect(help).toBeVisible();
  await expect(help).toContainText('Generate');
  await page.keyboard.press('Escape');
  await expect(help).toBeHidden();
});
