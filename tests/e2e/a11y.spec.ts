import AxeBuilder from '@axe-core/playwright';
import { expect, test, type Page } from '@playwright/test';
import { open } from './support/page';
import { STATES } from './support/states';

const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa'];

async function violations(page: Page): Promise<string[]> {
  // Colours are judged when they have arrived.
  await page.evaluate(() => Promise.all(document.getAnimations().map((each) => each.finished.catch(() => undefined))));
  const { violations } = await new AxeBuilder({ page }).withTags(TAGS).analyze();
  return violations.flatMap(({ id, nodes }) => nodes.map((node) => `${id}: ${node.target.join(' ')}`));
}

test.use({ viewport: { width: 1440, height: 900 }, contextOptions: { reducedMotion: 'reduce' } });

test('axe finds no violation of level A or AA in any panel', async ({ page }) => {
  test.setTimeout(900_000); // axe alone takes half a minute a panel on a busy machine
  await open(page);
  const found: string[] = [];
  for (const state of STATES) {
    await state.go(page);
    for (const each of await violations(page)) found.push(`${state.name}: ${each}`);
  }
  expect([...new Set(found)]).toEqual([]);
});
