import { expect, test, type Page } from '@playwright/test';
import { collectErrors, loadSong, open } from './support/page';
import { wav } from './support/songs';
import { Fingers, way } from './support/touch';

test.use({
  viewport: { width: 390, height: 844 },
  hasTouch: true,
  isMobile: true,
  contextOptions: { reducedMotion: 'reduce' },
});

const keys = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses.map(({ time }) => time));
const rotations = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses[0].rotations);

/** Lets the page believe that every frame is in time: otherwise a slow machine lowers the quality while pictures are compared. */
async function steady(page: Page): Promise<void> {
  await page.addInitScript(() => {
    const request = window.requestAnimationFrame.bind(window);
    let now = 0;
    window.requestAnimationFrame = (callback) => request(() => callback((now += 16)));
  });
}

/** The stage's own picture, once it stands still. */
async function stagePicture(page: Page): Promise<Buffer> {
  const canvas = page.locator('.stage canvas');
  let before = await canvas.screenshot();
  for (let attempt = 0; attempt < 30; attempt++) {
    // What moves is drawn with every frame, however long that takes.
    await page.evaluate(async () => {
      for (let frame = 0; frame < 6; frame++) await new Promise(requestAnimationFrame);
    });
    const now = await canvas.screenshot();
    if (now.equals(before)) return now;
    before = now;
  }
  throw new Error('The stage does not come to rest.');
}

/** Whether the stage shows a picture again, or still. */
const looksLike = async (page: Page, picture: Buffer) =>
  (await page.locator('.stage canvas').screenshot()).equals(picture);

test('posing: a tap selects, a ring turns, a finger beside the figure orbits, two zoom, and the pose is placed', async ({
  page,
}) => {
  const errors = collectErrors(page);
  await steady(page);
  await open(page);
  await loadSong(page, wav({ seconds: 12 }));
  await page.getByRole('button', { name: 'New pose' }).tap();
  await stagePicture(page);
  const box = (await page.locator('.stage canvas').boundingBox())!;
  // The stage has most of the screen while a pose is made.
  expect(box.height).toBeGreaterThan(400);
  const middle = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
  const joint = page.getByRole('combobox', { name: 'Joint', exact: true });
  await expect(joint).toHaveValue('');

  // The camera looks at the hips: a tap there selects something of the trunk.
  await page.touchscreen.tap(middle.x, middle.y);
  await expect(joint).not.toHaveValue('');

  const fingers = await Fingers.of(page);
  const undo = page.getByRole('button', { name: 'Undo' });
  await expect(undo).toBeDisabled();
  // Some ring runs through here, whichever joint it is: feel for it from the middle outwards.
  for (let radius = 24; radius <= 120 && (await undo.isDisabled()); radius += 8) {
    const from = { x: middle.x + radius, y: middle.y };
    await fingers.drag([way(from, { x: from.x, y: from.y - 50 }, 8)]);
  }
  await expect(undo).toBeEnabled();

  const posed = await stagePicture(page);
  const beside = { x: box.x + box.width - 40, y: box.y + 130 };
  await fingers.drag([way(beside, { x: beside.x - 90, y: beside.y })]);
  await expect.poll(() => looksLike(page, posed)).toBe(false);
  const orbited = await stagePicture(page);
  const [left, right] = [-30, 30].map((offset) => ({ x: middle.x + offset, y: box.y + 110 }));
  await fingers.drag([way(left, { ...left, x: left.x - 60 }), way(right, { ...right, x: right.x + 60 })]);
  await expect.poll(() => looksLike(page, orbited)).toBe(false);

  await page.getByRole('button', { name: 'Add to timeline' }).tap();
  await expect.poll(() => keys(page)).toHaveLength(1);
  expect((await rotations(page)).some((angle) => Math.abs(angle) > 0.05)).toBe(true);
  expect(errors).toEqual([]);
});

test('ghosts and the path of a joint are shown and hidden by a tap', async ({ page }) => {
  await steady(page);
  await open(page);
  await loadSong(page, wav({ seconds: 12 }));
  await page.evaluate(() => {
    const pose = (turn: number) => Array.from({ length: 72 }, (_, i) => (i === 50 ? turn : 0));
    window.posebeat.setKeyPoses([1, 3].map((time) => ({ time, rotations: pose(time / 3) })));
  });
  const plain = await stagePicture(page);
  await page.getByRole('button', { name: /^Ghosts/ }).tap();
  await expect.poll(() => looksLike(page, plain)).toBe(false);
  const ghosts = await stagePicture(page);
  await page.getByRole('button', { name: 'Path of a joint' }).tap();
  await expect(page.getByRole('combobox', { name: /path/ })).toBeVisible();
  await expect.poll(() => looksLike(page, ghosts)).toBe(false);
  const both = await stagePicture(page);
  await page.getByRole('button', { name: /^Ghosts/ }).tap();
  await expect.poll(() => looksLike(page, both)).toBe(false);
  await page.getByRole('button', { name: 'Path of a joint' }).tap();
  await expect(page.getByRole('combobox', { name: /path/ })).toBeHidden();
});
