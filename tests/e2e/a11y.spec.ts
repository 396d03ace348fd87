/** What axe cannot tell: the way of the Tab key, the ring of the focus, reduced motion, forced colours. axe itself runs in panels.spec.ts. */
import { expect, test, type Page } from '@playwright/test';
import { dropFile, loadSong, open } from './support/page';
import { wav } from './support/songs';
import { dismissAll, STATES } from './support/states';
import { serveTinyModel } from './support/tiny';

test.use({ viewport: { width: 1440, height: 900 } });

/** Marks what the Tab key should come to: everything that can be used and be seen, of a group of radio buttons the checked one. */
const wanted = (page: Page) =>
  page.evaluate(() => {
    const selector = 'button, a[href], input, select, textarea, summary, [tabindex]';
    const all = [...document.querySelectorAll<HTMLElement>(selector)].filter(
      (each) =>
        each.tabIndex >= 0 &&
        !(each as HTMLButtonElement).disabled &&
        each.checkVisibility({ visibilityProperty: true }) &&
        !(each instanceof HTMLInputElement && each.type === 'radio' && !each.checked) &&
        !each.closest('fieldset:disabled'),
    );
    for (const each of document.querySelectorAll('[data-tab]')) each.removeAttribute('data-tab');
    all.forEach((each, i) => (each.dataset.tab = String(i)));
    return all.map((each) => each.outerHTML.slice(0, 140));
  });

interface Focused {
  index: number;
  tag: string;
  /** What its name comes from, the same in every state. */
  whole: string;
  ring: boolean;
  inSight: boolean;
}

/** What has the keyboard now, and whether a ring shows it where it can be seen. */
const focused = (page: Page): Promise<Focused | null> =>
  page.evaluate(async () => {
    // What was out of sight comes into it with the next frames.
    for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame);
    const element = document.activeElement as HTMLElement | null;
    if (!element || element === document.body) return null;
    // A control that is drawn by its label or by what follows it wears the ring there.
    const wearers = [element, element.nextElementSibling, element.closest('label')].filter((each) => each !== null);
    const worn = wearers.find((each) => {
      const { outlineStyle, outlineWidth, outlineColor } = getComputedStyle(each);
      return outlineStyle !== 'none' && parseFloat(outlineWidth) >= 1 && !/^rgba.*, 0\)$/.test(outlineColor);
    });
    const box = (worn ?? element).getBoundingClientRect();
    const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
    return {
      index: Number(element.dataset.tab ?? -1),
      tag: element.outerHTML.slice(0, 140),
      whole: (element.closest('label') ?? element).outerHTML.replace(/ data-tab="\d+"/g, ''),
      ring: worn !== undefined,
      inSight: box.width > 0 && x >= 0 && y >= 0 && x <= innerWidth && y <= innerHeight,
    };
  });

/**
 * Goes once round the page by the Tab key and tells what is wrong on the way.
 * @param spoken - How controls are read aloud; what one state has found another need not ask again
 */
async function walk(page: Page, name: string, spoken: Map<string, string>): Promise<string[]> {
  const expected = await wanted(page);
  await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
  const seen = new Map<number, Focused>();
  const faults: string[] = [];
  for (let press = 0; press < expected.length + 20; press++) {
    await page.keyboard.press('Tab');
    const now = await focused(page);
    if (!now) continue;
    const [first] = seen.keys();
    if (now.index === first && seen.size > 1) break;
    if (seen.has(now.index)) continue;
    seen.set(now.index, now);
    if (!now.ring) faults.push(`no ring: ${now.tag}`);
    if (!now.inSight) faults.push(`out of sight: ${now.tag}`);
    const read = spoken.get(now.whole) ?? (await page.locator(':focus').ariaSnapshot());
    spoken.set(now.whole, read);
    if (!/^- (text: |'?\w+ ")[^"]*\w/.test(read)) faults.push(`no name: ${now.tag} is read as ${read}`);
  }
  expected.forEach((tag, i) => seen.has(i) || faults.push(`never reached: ${tag}`));
  if (seen.size < 8) faults.push(`only ${seen.size} controls were reached`);
  // And back: nothing holds the keyboard.
  const order = [...seen.keys()];
  await page.locator(`[data-tab="${order[5]}"]`).focus();
  for (const index of order.slice(1, 5).reverse()) {
    await page.keyboard.press('Shift+Tab');
    const now = await focused(page);
    if (now?.index !== index) faults.push(`Shift+Tab comes to ${now?.tag} instead of control ${index}`);
  }
  return faults.map((fault) => `${name}: ${fault}`);
}

test('the Tab key comes round to every control, each with a name and a ring, and nothing holds it', async ({
  page,
}) => {
  test.setTimeout(240_000);
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await serveTinyModel(page);
  await open(page, '?backend=wasm');
  await page.locator('.notice').first().waitFor();
  await dismissAll(page);
  const faults: string[] = [];
  const spoken = new Map<string, string>();
  const walked = new Set([
    'opening page',
    'own poses, the menu of one',
    'a frame of a file',
    'several key poses, a loop',
    'dance panel with a dance, a range with takes',
    'report with a dance, curves',
    'pose editor, turning a joint',
    'pose editor, moving a joint, balance, ghosts and path',
  ]);
  for (const state of STATES) {
    await state.go(page);
    if (!walked.delete(state.name)) continue;
    // A menu is a place of its own, left by Escape.
    if (/menu/.test(state.name)) await page.keyboard.press('Escape');
    faults.push(...(await test.step(state.name, () => walk(page, state.name, spoken))));
  }
  expect([...walked], 'states that are there').toEqual([]);
  expect(faults).toEqual([]);
});

test('dialogs and menus take the keyboard, keep it to themselves, and give it back on Escape', async ({ page }) => {
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await open(page);
  await loadSong(page, wav({ seconds: 6 }));
  const inside = (selector: string) =>
    page.evaluate((selector) => Boolean(document.activeElement?.closest(selector)), selector);

  const help = page.getByRole('button', { name: 'Keys and help' });
  await help.focus();
  await page.keyboard.press('Enter');
  await expect(page.getByRole('dialog')).toBeVisible();
  for (let i = 0; i < 8; i++) {
    await page.keyboard.press('Tab');
    expect(await page.evaluate(() => document.activeElement === document.body), 'a stop outside the page').toBe(false);
    expect(await inside('.help')).toBe(true);
    if (await page.evaluate(() => document.activeElement?.matches('.help input'))) break;
  }
  await page.keyboard.press('Escape');
  await expect(page.getByRole('dialog')).toBeHidden();
  await expect(help).toBeFocused();

  const beats = page.getByRole('button', { name: 'Beats', exact: true });
  await beats.focus();
  await page.keyboard.press('Enter');
  await expect.poll(() => inside('.beat-menu')).toBe(true);
  await page.keyboard.press('Escape');
  await expect(beats).toBeFocused();

  const save = page.getByRole('button', { name: 'Save the project' });
  await save.focus();
  await page.keyboard.press('Enter');
  await page.keyboard.press('Tab');
  expect(await inside('.project-menu')).toBe(true);
  await page.keyboard.press('Escape');
  await expect(save).toBeFocused();

  const tile = page.locator('.pose-tile').first();
  await tile.focus();
  await page.keyboard.press('Shift+F10');
  await expect.poll(() => inside('.pose-menu')).toBe(true);
  await page.keyboard.press('Escape');
  await expect(tile).toBeFocused();

  // From a message that is dismissed it goes to the next one, and back to where it was.
  await dismissAll(page);
  for (const name of ['one.txt', 'two.txt']) await dropFile(page, Buffer.from('no song'), name);
  const dismiss = page.locator('.notice').getByRole('button', { name: 'Dismiss' });
  await expect(page.getByRole('alert')).toHaveCount(2);
  await tile.focus();
  await dismiss.first().focus();
  for (let left = await dismiss.count(); left > 0; left--) {
    await expect(page.locator('.notice :focus')).toHaveCount(1);
    await page.keyboard.press('Enter');
    await expect(dismiss).toHaveCount(left - 1);
  }
  await expect(tile).toBeFocused();
});

test('with reduced motion nothing moves by itself, flies or fades', async ({ page }) => {
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await serveTinyModel(page);
  // Kept from the first moment: what has run and is over is no longer among the animations.
  await page.addInitScript(() => {
    const long: string[] = [];
    Object.assign(window, { long });
    const note = (kind: string, element: EventTarget | null, milliseconds: number) => {
      if (milliseconds > 1) long.push(`${kind} of ${milliseconds} ms on ${(element as Element).className}`);
    };
    for (const kind of ['transitionrun', 'animationstart']) {
      document.addEventListener(
        kind,
        ({ target }) => {
          const style = getComputedStyle(target as Element);
          const durations = kind === 'transitionrun' ? style.transitionDuration : style.animationDuration;
          note(kind, target, Math.max(...durations.split(',').map((each) => parseFloat(each) * 1000)));
        },
        true,
      );
    }
    const animate = Element.prototype.animate;
    Element.prototype.animate = function (frames, options) {
      note('animate()', this, typeof options === 'number' ? options : Number(options?.duration ?? 0));
      return animate.call(this, frames, options);
    };
  });
  const long = () => page.evaluate(() => (window as unknown as { long: string[] }).long);
  await open(page, '?backend=wasm');
  // The demo waits to be played.
  await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible();
  const clock = page.locator('.readout-time');
  const still = await clock.innerText();
  await page.waitForTimeout(500);
  expect(await clock.innerText()).toBe(still);

  const leave = new Set(['pose editor, turning a joint', 'pose editor, moving a joint, balance, ghosts and path']);
  for (const state of STATES.filter(({ name }) => !leave.has(name)).slice(0, 14)) await state.go(page);
  await page.locator('.pose-tile, .seed').first().hover();
  expect(await long()).toEqual([]);
  const running = await page.evaluate(
    () => document.getAnimations().filter((each) => Number(each.effect?.getComputedTiming().duration) > 1).length,
  );
  expect(running).toBe(0);

  // The measure itself sees what moves where motion is welcome.
  await page.emulateMedia({ reducedMotion: 'no-preference' });
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Keys and help' }).hover();
  await expect.poll(async () => (await long()).length).toBeGreaterThan(0);
});

test('with forced colours controls keep their edges, and what is chosen, focused or filled still shows', async ({
  page,
}) => {
  await page.emulateMedia({ forcedColors: 'active', reducedMotion: 'reduce' });
  await serveTinyModel(page);
  await open(page, '?backend=wasm');
  await page.locator('.notice').first().waitFor();
  await dismissAll(page);
  const edgeless = () =>
    page.evaluate(() => {
      const ground = getComputedStyle(document.body).backgroundColor;
      return [...document.querySelectorAll<HTMLElement>('button, select, input:not([type=radio], [type=checkbox])')]
        .filter((each) => each.checkVisibility({ visibilityProperty: true, opacityProperty: true }))
        .filter((each) => !each.closest('.visually-hidden') && !each.matches('[type=range], [type=file]'))
        .filter((each) => {
          const style = getComputedStyle(each);
          const edge = style.borderTopStyle !== 'none' && parseFloat(style.borderTopWidth) >= 1;
          const filled = style.backgroundColor !== ground && !/^rgba.*, 0\)$/.test(style.backgroundColor);
          // On the lanes the colours are the picture's own.
          return !edge && !filled && style.forcedColorAdjust !== 'none';
        })
        .map((each) => each.outerHTML.slice(0, 120));
    });
  const look = (selector: string) =>
    page
      .locator(selector)
      .first()
      .evaluate((element) => {
        const { backgroundColor, color, outlineStyle, borderBottomColor } = getComputedStyle(element);
        return [backgroundColor, color, outlineStyle, borderBottomColor].join(' ');
      });
  const differ = async (chosen: string, other: string) =>
    expect(await look(chosen), `${chosen} and ${other}`).not.toBe(await look(other));

  await loadSong(page, wav({ seconds: 12 }));
  expect(await edgeless()).toEqual([]);
  await differ('.transport .tool[aria-pressed=true]', '.transport .tool[aria-pressed=false]');
  await differ('[role=tab][aria-selected=true]', '[role=tab][aria-selected=false]');
  await differ('.snap-choice input:checked + span', '.snap-choice input:not(:checked) + span');
  await differ('.group-chip:has(:checked)', '.group-chip:not(:has(:checked))');

  await page.getByRole('tab', { name: 'Dance' }).click();
  await differ('.seed:has(:checked)', '.seed:not(:has(:checked))');
  await page.getByRole('tab', { name: 'Poses' }).click();
  await page.getByRole('button', { name: 'New pose' }).click();
  expect(await edgeless()).toEqual([]);
  await differ('.strip-tool[aria-pressed=true]', '.strip-tool[aria-pressed=false]');
  await page.keyboard.press('Tab');
  const ring = await focused(page);
  expect(ring?.ring).toBe(true);
});
