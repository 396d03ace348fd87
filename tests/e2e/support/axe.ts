import AxeBuilder from '@axe-core/playwright';
import type { Page } from '@playwright/test';

const TAGS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa'];

/** What axe has against the page, or parts of it, by the rules of levels A and AA; one line each. */
export async function violations(page: Page, scope?: string): Promise<string[]> {
  // Colours are judged where they arrive, also those that change while axe looks.
  await page.evaluate(() => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync('*, ::before, ::after { transition: none !important; }');
    document.adoptedStyleSheets = [sheet];
    return Promise.all(document.getAnimations().map((each) => each.finished.catch(() => undefined)));
  });
  // There are no frames here, so that axe need not open a page of its own to put their results together.
  const axe = new AxeBuilder({ page }).setLegacyMode().options({
    runOnly: { type: 'tag', values: TAGS },
    resultTypes: ['violations'],
  });
  for (const part of scope?.split(', ') ?? []) axe.include(part);
  const { violations } = await axe.analyze();
  const found = violations.flatMap(({ id, nodes }) => nodes.map(({ target }) => ({ id, selector: target.join(' ') })));
  // On the lanes the place of a thing is what it says (WCAG 2.5.8, "essential"): the loop may begin where the playhead stands.
  const onLanes = await page.evaluate(
    (selectors) => selectors.map((selector) => document.querySelector(`.timeline-surface :is(${selector})`) !== null),
    found.map(({ selector }) => selector),
  );
  return found
    .filter(({ id }, i) => id !== 'target-size' || !onLanes[i])
    .map(({ id, selector }) => `${id}: ${selector}`);
}
