/** Every panel and state of the page, at the sizes of screens that people have: nothing misplaced, and nothing that axe objects to. */
import { expect, test } from '@playwright/test';
import { violations } from './support/axe';
import { misplaced } from './support/layout';
import { collectErrors, open } from './support/page';
import { dismissAll, STATES } from './support/states';
import { serveTinyModel } from './support/tiny';

const SCREENS = [
  { name: 'standing phone', width: 390, height: 844, touch: true, axe: true },
  { name: 'lying phone', width: 844, height: 390, touch: true, axe: false },
  { name: 'small laptop', width: 1024, height: 768, touch: false, axe: false },
  { name: 'laptop', width: 1440, height: 900, touch: false, axe: true },
  { name: 'desktop', width: 1920, height: 1080, touch: false, axe: false },
];

for (const { name, width, height, touch, axe } of SCREENS) {
  test.describe(`${name}, ${width} x ${height}`, () => {
    test.use({
      viewport: { width, height },
      hasTouch: touch,
      isMobile: touch,
      contextOptions: { reducedMotion: 'reduce' },
    });

    test(`every panel is whole${axe ? ', and axe finds no violation of level A or AA' : ''}`, async ({ page }) => {
      test.setTimeout(300_000);
      const errors = collectErrors(page);
      await serveTinyModel(page);
      await open(page, '?backend=wasm');
      // There is no stage here, and a message says so.
      await page.locator('.notice').first().waitFor();
      await dismissAll(page);
      const found: string[] = [];
      for (const state of STATES) {
        await test.step(state.name, async () => {
          await state.go(page);
          for (const fault of await misplaced(page, touch)) found.push(`${state.name}: ${fault}`);
          if (axe) for (const each of await violations(page, state.scope)) found.push(`${state.name}: ${each}`);
        });
      }
      expect([...new Set(found)]).toEqual([]);
      expect(errors).toEqual([]);
    });
  });
}
