/** One session with a change of every durable kind: undo takes each back alone, redo brings each again, and looking around is no step. */
import { expect, test, type Page } from '@playwright/test';
import { collectErrors, fourPoses, loadSong, open } from './support/page';
import { wav } from './support/songs';
import { dismissAll } from './support/states';
import { serveTinyModel } from './support/tiny';

test.use({ viewport: { width: 1440, height: 900 }, contextOptions: { reducedMotion: 'reduce' } });

/** All that is durable; where the camera stands is kept too, but is no step. */
const work = (page: Page) => page.evaluate(() => ({ ...window.posebeat.document(), camera: null }));
const undo = (page: Page) => page.getByRole('banner').getByRole('button', { name: 'Undo' });
const redo = (page: Page) => page.getByRole('banner').getByRole('button', { name: 'Redo' });
const keyPose = (page: Page, index: number) => page.locator('.key-pose').nth(index);

async function calm(page: Page): Promise<void> {
  await expect(page.locator('.generate.busy')).toHaveCount(0, { timeout: 60_000 });
}

async function choose(page: Page, index: number): Promise<void> {
  await keyPose(page, index).focus();
  await page.keyboard.press('Escape');
  await keyPose(page, index).click();
}

async function beats(page: Page, name: string): Promise<void> {
  await page.getByRole('button', { name: 'Beats', exact: true }).click();
  await page.getByRole('dialog', { name: 'Beats' }).getByRole('button', { name, exact: true }).click();
  await page.keyboard.press('Escape');
}

async function dial(page: Page, name: string, keys: string): Promise<void> {
  await page.getByRole('tab', { name: 'Dance' }).click();
  await page.getByRole('slider', { name, exact: true }).focus();
  await page.keyboard.press(keys);
}

/** Each is one step. */
const CHANGES: readonly [name: string, change: (page: Page) => Promise<unknown>][] = [
  ['a pose from the library', (page) => page.locator('.pose-tile').nth(1).click()],
  [
    'a key pose moved',
    async (page) => {
      await choose(page, 3);
      await page.keyboard.press('ArrowLeft');
    },
  ],
  ['a key pose mirrored', (page) => page.keyboard.press('m')],
  ['a key pose locked', (page) => page.keyboard.press('Shift+L')],
  [
    'a key pose weaker',
    async (page) => {
      await choose(page, 1);
      await page.getByRole('slider', { name: 'Strength', exact: true }).focus();
      await page.keyboard.press('PageDown');
    },
  ],
  [
    'a key pose renamed',
    async (page) => {
      await page.getByLabel('Name of the key pose').fill('Mine');
      await page.keyboard.press('Enter');
      await page.getByRole('slider', { name: 'Playhead' }).focus();
    },
  ],
  [
    'a key pose deleted',
    async (page) => {
      await choose(page, 1);
      await page.keyboard.press('Delete');
    },
  ],
  [
    'a pose edited',
    async (page) => {
      await keyPose(page, 0).dblclick();
      await page.getByRole('combobox', { name: 'Joint', exact: true }).selectOption({ label: 'Left elbow' });
      await page.getByLabel('Turn y, degrees').fill('-40');
      await page.keyboard.press('Tab');
      await page.locator('.pose-bar').getByRole('button', { name: 'Update' }).click();
    },
  ],
  ['beats shifted', (page) => beats(page, '+10 ms')],
  ['beats doubled', (page) => beats(page, '× 2')],
  ['another meter', (page) => beats(page, '3/4')],
  [
    'a part of the song',
    async (page) => {
      await page.getByRole('slider', { name: /Start of the part/ }).focus();
      await page.keyboard.press('ArrowRight');
    },
  ],
  ['variation', (page) => dial(page, 'Variation', 'End')],
  ['key strength', (page) => dial(page, 'Key strength', 'PageDown')],
  [
    'another beginning',
    async (page) => {
      await page.getByRole('tab', { name: 'Dance' }).click();
      await page.locator('.seed input').nth(1).check({ force: true });
    },
  ],
  [
    'another take of the dance',
    async (page) => {
      await page.getByRole('tab', { name: 'Dance' }).click();
      await page.getByRole('button', { name: 'Next take', exact: true }).click();
      await calm(page);
    },
  ],
  [
    'a range made anew',
    async (page) => {
      await page.keyboard.press('l');
      await page.keyboard.press('Shift+G');
      await expect(page.locator('.range-chip')).toHaveText('1/1');
      await calm(page);
    },
  ],
  [
    'a second take of the range',
    async (page) => {
      await page.keyboard.press('Shift+G');
      await expect(page.locator('.range-chip')).toHaveText('2/2');
      await calm(page);
    },
  ],
  [
    'its first take',
    async (page) => {
      await page.keyboard.press('Alt+ArrowLeft');
      await expect(page.locator('.range-chip')).toHaveText('1/2');
      await calm(page);
    },
  ],
];

/** Looks at everything and changes nothing. */
async function lookAround(page: Page): Promise<void> {
  await page.getByRole('tab', { name: 'Poses' }).click();
  await keyPose(page, 0).click();
  for (const key of [
    'Control+a',
    'Escape',
    'l',
    'l',
    '+',
    '0',
    '.',
    '>',
    'o',
    'o',
    'v',
    'v',
    's',
    'Shift+F',
    'Shift+F',
  ])
    await page.keyboard.press(key);
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await page.getByRole('button', { name: 'Pause', exact: true }).click();
  await page.getByRole('button', { name: 'Camera follows the dancer' }).click();
  await page.getByRole('button', { name: 'Camera follows the dancer' }).click();
  await page.getByRole('tab', { name: 'Report' }).click();
  await page.getByRole('tab', { name: 'Poses' }).click();
}

test('undo and redo of every durable change in one session', async ({ page }) => {
  test.setTimeout(240_000);
  const errors = collectErrors(page);
  await serveTinyModel(page);
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: 16 }), 'session.wav');
  await dismissAll(page);
  await page.evaluate(
    (poses) => window.posebeat.setKeyPoses(poses.map((rotations, i) => ({ time: 3 + 3 * i, rotations }))),
    fourPoses(),
  );
  await page.keyboard.press('g');
  await calm(page);

  const documents = [await work(page)];
  for (const [name, change] of CHANGES) {
    await test.step(name, async () => {
      await page.getByRole('tab', { name: 'Poses' }).click();
      await change(page);
      await expect.poll(() => work(page), name).not.toEqual(documents.at(-1));
      documents.push(await work(page));
    });
  }
  expect(new Set(documents.map((each) => JSON.stringify(each))).size).toBe(CHANGES.length + 1);

  await lookAround(page);
  expect(await work(page)).toEqual(documents.at(-1));
  for (let step = documents.length - 2; step >= 0; step--) {
    await undo(page).click();
    expect(await work(page), `without ${CHANGES[step][0]}`).toEqual(documents[step]);
  }
  await lookAround(page);
  await calm(page);
  await expect(redo(page)).toBeEnabled();
  for (let step = 1; step < documents.length; step++) {
    await redo(page).click();
    expect(await work(page), `with ${CHANGES[step - 1][0]}`).toEqual(documents[step]);
  }
  await expect(redo(page)).toBeDisabled();
  await calm(page);
  expect(errors).toEqual([]);
});
