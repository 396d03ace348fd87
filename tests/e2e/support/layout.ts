import type { Page } from '@playwright/test';

/**
 * What is not where it should be on the page as it is: cut off, lying under something else, overlapping, too wide, with its words cut,
 * or, with `touch`, too small for a finger (44 px). One line each.
 */
export const misplaced = (page: Page, touch: boolean): Promise<string[]> =>
  page.evaluate((touch) => {
    const faults: string[] = [];
    /** A finger's width, CSS pixels. */
    const FINGER = 44;
    // What lies on the timeline may lie on each other, and is found by a finger's own rules.
    const APART = '.timeline-surface, .scrollbar, .visually-hidden, .notices';
    const describe = (element: Element) =>
      `${element.tagName.toLowerCase()}.${element.getAttribute('class') ?? ''} “${element.getAttribute('aria-label') ?? element.textContent?.trim().slice(0, 30) ?? ''}”`;
    const shown = (element: Element) => element.checkVisibility({ visibilityProperty: true, opacityProperty: true });
    const size = ({ width, height }: DOMRect) => `${Math.round(width)}x${Math.round(height)}`;

    if (document.documentElement.scrollWidth > innerWidth) faults.push('the page is wider than the screen');
    if (document.documentElement.scrollHeight > innerHeight) {
      const low = [...document.querySelectorAll('#app *')].filter((each) => {
        const { position } = getComputedStyle(each);
        return position === 'absolute' && each.getBoundingClientRect().bottom > innerHeight;
      });
      faults.push(`the page is higher than the screen, for ${low.map(describe).join(', ')}`);
    }

    /** What an element can be scrolled in. */
    const scrollers = (element: Element) => {
      const found: DOMRect[] = [];
      for (let each = element.parentElement; each; each = each.parentElement)
        if (/auto|scroll/.test(getComputedStyle(each).overflow)) found.push(each.getBoundingClientRect());
      return found;
    };

    // The main regions share the screen, each in sight.
    const overlap = (a: DOMRect, b: DOMRect) =>
      Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
      Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
    const compare = (selectors: string[]) => {
      const found = selectors.flatMap((selector) => {
        const element = document.querySelector(selector);
        return element && shown(element) ? [{ selector, box: element.getBoundingClientRect() }] : [];
      });
      found.forEach(({ selector, box }, i) => {
        if (box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1)
          faults.push(`not on the screen: ${selector}`);
        for (const other of found.slice(i + 1))
          if (overlap(box, other.box)) faults.push(`${selector} and ${other.selector} overlap`);
      });
    };
    compare(['.top-bar', '.stage', '.transport', '.timeline', '.inspector']);
    // So does what lies over the stage.
    compare([
      '.welcome h1', '.welcome p', '.drop-target', '.stage-tools', '.sound-chip', '.work-chip', '.pose-bar', '.tool-strip', '.compare-badge', '.tour',
    ]); // prettier-ignore
    const panel = document.querySelector('#inspector-panel')!;
    if (panel.scrollWidth > panel.clientWidth) {
      const edge = panel.getBoundingClientRect().left + panel.clientWidth;
      const wide = [...panel.querySelectorAll('*')].filter((each) => each.getBoundingClientRect().right > edge + 0.5);
      faults.push(`the panel is wider than its place, for ${wide.slice(0, 3).map(describe).join(', ')}`);
    }
    const stage = document.querySelector('.stage')!.getBoundingClientRect();
    if (stage.height < 150) faults.push(`the stage is only ${Math.round(stage.height)} px high`);

    // A dialog or a menu that is open is all that can be used.
    const scope = document.querySelector('dialog[open], :popover-open') ?? document.body;
    for (const element of scope.querySelectorAll<HTMLElement>('button, select, input, [role=tab], summary')) {
      if (element.closest(APART) || !shown(element)) continue;
      let box = element.getBoundingClientRect();
      // What is drawn by its label is hit there.
      const label =
        element instanceof HTMLInputElement && /radio|checkbox/.test(element.type) && element.closest('label');
      if (label) box = label.getBoundingClientRect();
      if (box.width < 2 || element.matches('.visually-hidden')) continue;
      const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
      const outer = scrollers(element);
      if (outer.some(({ left, right, top, bottom }) => x < left + 1 || x > right - 1 || y < top + 1 || y > bottom - 1))
        continue;
      if (
        outer.length === 0 &&
        (box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1)
      )
        faults.push(`cut off: ${describe(element)}`);
      const hit = document.elementFromPoint(x, y);
      // A panel scrolls under the buttons that stay at its foot.
      if (hit && outer.length > 0 && hit.closest('.pose-import-actions') && !element.closest('.pose-import-actions'))
        continue;
      const own = hit && (element.contains(hit) || hit.contains(element) || hit.closest('label')?.contains(element));
      if (!own && !hit?.closest('.notices, .tour'))
        faults.push(`covered: ${describe(element)}, by ${hit && describe(hit)}`);
      if (touch && (box.height < FINGER - 0.5 || box.width < FINGER - 0.5))
        faults.push(`small: ${describe(element)} ${size(box)}`);
      if (element.matches('button') && element.scrollWidth > element.clientWidth + 1)
        faults.push(`words cut: ${describe(element)} ${element.scrollWidth} in ${element.clientWidth}`);
    }
    return faults;
  }, touch);
