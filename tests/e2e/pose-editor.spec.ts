import { expect, test, type Page } from '@playwright/test';
import { collectErrors, loadSong, open } from './support/page';
import { alongTheArm, figure, findJoint, newPose, poseAtRest } from './support/posing';
import { wav } from './support/songs';

const keyPoses = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses);
const joint = (page: Page) => page.getByLabel('Joint', { exact: true });
const angles = (page: Page) =>
  Promise.all(['x', 'y', 'z'].map(async (axis) => Number(await page.getByLabel(`Turn ${axis}, degrees`).inputValue())));
// A small stage: without a graphics card every pixel costs.
test.use({ viewport: { width: 960, height: 640 } });

test('by mouse: a joint is clicked on the figure, turned by a ring, undone, redone and kept', async ({ page }) => {
  const errors = collectErrors(page);
  await open(page);
  await loadSong(page, wav({ seconds: 6 }));
  await newPose(page);
  const elbow = await findJoint(page, 'Left elbow', alongTheArm('right'));
  await page.mouse.click(elbow.x, elbow.y);
  await expect(joint(page)).toHaveValue('18');
  expect(await angles(page)).toEqual([0, 0, 0]);

  // The ring that faces the camera is as large on the screen as the stage is high; its top is dragged to the right.
  const { height } = (await figure(page).boundingBox())!;
  const radius = height * 0.0736;
  await page.mouse.move(elbow.x, elbow.y - radius);
  await page.mouse.down();
  await page.mouse.move(elbow.x + radius * 0.5, elbow.y - radius * 0.9, { steps: 4 });
  await page.mouse.move(elbow.x + radius * 0.9, elbow.y - radius * 0.5, { steps: 4 });
  await page.mouse.up();
  const turned = await angles(page);
  expect(Math.hypot(...turned)).toBeGreaterThan(10);

  await page.getByRole('button', { name: 'Undo' }).click();
  expect(await angles(page)).toEqual([0, 0, 0]);
  await page.getByRole('button', { name: 'Redo' }).click();
  expect(await angles(page)).toEqual(turned);

  await page.getByRole('button', { name: 'To other side' }).click();
  await joint(page).selectOption({ label: 'Right elbow' });
  const [x, y, z] = await angles(page);
  expect([x, -y + 0, -z + 0]).toEqual(turned);
  await page.getByRole('button', { name: 'Add to timeline' }).click();
  const [key] = await keyPoses(page);
  expect(Math.hypot(...key.rotations.slice(54, 57))).toBeGreaterThan(0.17);
  expect(errors).toEqual([]);
});

test('by keyboard alone: a pose is made, copied, varied, undone to the start, redone and placed', async ({ page }) => {
  await open(page);
  await loadSong(page, wav({ seconds: 6 }));
  await page.getByRole('tab', { name: 'Poses' }).focus();
  await page.keyboard.press('Enter');
  await page.getByRole('button', { name: 'New pose' }).focus();
  await page.keyboard.press('Enter');
  await figure(page).focus();

  // From the hips up the spine to the chest, out to the left arm and down it.
  await page.keyboard.press('ArrowDown');
  await expect(joint(page)).toHaveValue('0');
  for (const key of ['ArrowDown', 'ArrowDown', 'ArrowDown', 'ArrowRight', 'ArrowDown', 'ArrowDown'])
    await page.keyboard.press(`Control+${key}`);
  await expect(joint(page)).toHaveValue('18');

  const states: number[][] = [await angles(page)];
  await page.keyboard.press('ArrowLeft');
  // Quick presses are one step; another joint in between makes them two.
  const elsewhereAndBack = async () => {
    await page.keyboard.press('Control+ArrowUp');
    await expect(joint(page)).not.toHaveValue('18');
    await page.keyboard.press('Control+ArrowDown');
    await expect(joint(page)).toHaveValue('18');
  };
  await elsewhereAndBack();
  states.push(await angles(page));
  expect(states[1][1]).toBeCloseTo(-5, 0);
  await page.keyboard.press('Shift+ArrowLeft');
  await elsewhereAndBack();
  states.push(await angles(page));
  expect(states[2][1]).toBeCloseTo(-20, 0);

  await page.keyboard.press('Control+c');
  await page.keyboard.press('Shift+r');
  states.push(await angles(page));
  expect(states[3]).toEqual([0, 0, 0]);
  await page.keyboard.press('Control+v');
  states.push(await angles(page));
  expect(states[4]).toEqual(states[2]);
  await page.keyboard.press('r');
  states.push(await angles(page));
  expect(states[5]).not.toEqual(states[4]);

  for (let i = 4; i >= 0; i--) {
    await page.keyboard.press('Control+z');
    expect(await angles(page)).toEqual(states[i]);
  }
  for (let i = 1; i <= 5; i++) await page.keyboard.press('Control+y');
  expect(await angles(page)).toEqual(states[5]);

  await page.keyboard.press('Enter');
  await expect(figure(page)).toHaveCount(0);
  expect(await keyPoses(page)).toHaveLength(1);
});

test('a hand is dragged and the body follows; a place is typed in centimetres', async ({ page }) => {
  await open(page);
  await newPose(page);
  await page.keyboard.press('w');
  const wrist = await findJoint(page, 'Left wrist', alongTheArm('right'));
  await page.mouse.down();
  await page.mouse.move(wrist.x - 30, wrist.y + 60, { steps: 6 });
  await poseAtRest(page);
  await page.mouse.up();
  await joint(page).selectOption({ label: 'Left elbow' });
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Bring it back' }).click();
  await page.getByRole('button', { name: 'Turn joints' }).click();
  await joint(page).selectOption({ label: 'Left shoulder' });
  expect(Math.hypot(...(await angles(page)))).toBeGreaterThan(5);
  await page.getByRole('button', { name: 'Undo' }).click();
  expect(await angles(page)).toEqual([0, 0, 0]);

  await page.getByRole('button', { name: 'Move joints' }).click();
  await joint(page).selectOption({ label: 'Left wrist' });
  const up = page.getByLabel('Place up, centimetres');
  await up.fill('110');
  await up.press('Enter');
  await expect.poll(async () => Math.abs(Number(await up.inputValue()) - 110)).toBeLessThan(2);
});

test('the tools answer to their keys and say what they do', async ({ page }) => {
  await open(page);
  await newPose(page);
  const tool = (name: string) => page.getByRole('toolbar', { name: 'Posing tools' }).getByRole('button', { name });
  const presses: [string, string, string, string][] = [
    ['w', 'Move joints', 'false', 'true'],
    ['x', 'World axes', 'false', 'true'],
    ['j', 'Limits of the joints', 'true', 'false'],
    ['Shift+M', 'Both sides', 'false', 'true'],
    ['b', 'Balance', 'false', 'true'],
  ];
  for (const [key, name, before, after] of presses) {
    await expect(tool(name)).toHaveAttribute('aria-pressed', before);
    await page.keyboard.press(key);
    await expect(tool(name)).toHaveAttribute('aria-pressed', after);
  }
  await page.keyboard.press('p');
  await expect(page.locator('.pose-bar')).toContainText('Choose a joint to pin first.');
  await joint(page).selectOption({ label: 'Left wrist' });
  await figure(page).focus();
  await page.keyboard.press('p');
  await expect(tool('Pin left wrist')).toHaveAttribute('aria-pressed', 'true');
  await page.keyboard.press('e');
  await joint(page).selectOption({ label: 'Left elbow' });
  await page.getByLabel('Turn y, degrees').fill('-40');
  await page.getByLabel('Turn y, degrees').press('Enter');
  await joint(page).selectOption({ label: 'Right elbow' });
  expect((await angles(page))[1]).toBeGreaterThan(0);
});

test('a blend is live and Esc takes it back; a dropped pose comes back', async ({ page }) => {
  await open(page);
  await newPose(page);
  await joint(page).selectOption({ label: 'Left shoulder' });
  const before = await angles(page);
  await page.getByText('Blend with another pose').click();
  await page.getByLabel('Other pose', { exact: true }).selectOption({ index: 3 });
  const slider = page.getByLabel('How much of the other pose');
  await slider.fill('50');
  const half = await angles(page);
  expect(half).not.toEqual(before);
  await slider.fill('100');
  expect(await angles(page)).not.toEqual(half);
  await page.keyboard.press('Escape');
  expect(await angles(page)).toEqual(before);
  await slider.fill('50');
  await page.getByRole('button', { name: 'Keep' }).click();
  await page.getByRole('button', { name: 'Cancel' }).click();
  await expect(figure(page)).toHaveCount(0);
  await page.getByRole('button', { name: 'Bring it back' }).click();
  expect(await angles(page)).toEqual(half);
  await page.getByRole('button', { name: 'Undo' }).click();
  expect(await angles(page)).toEqual(before);
});

for (const [name, viewport] of [
  ['desktop', { width: 1440, height: 900 }],
  ['phone', { width: 390, height: 844 }],
] as const) {
  test(`on a ${name} the editor is whole, with a stage of some size`, async ({ page }) => {
    await page.setViewportSize(viewport);
    await open(page);
    await newPose(page);
    await joint(page).selectOption({ label: 'Left elbow' });
    for (const fold of await page.locator('.fold summary').all()) await fold.click();
    const stage = (await figure(page).boundingBox())!;
    expect(stage.height).toBeGreaterThan(240);
    for (const button of await page.locator('.tool-strip button, .pose-bar button').all()) {
      const box = (await button.boundingBox())!;
      expect(box.x).toBeGreaterThanOrEqual(0);
      expect(box.x + box.width).toBeLessThanOrEqual(viewport.width);
      expect(box.y + box.height).toBeLessThanOrEqual(stage.y + stage.height + 1);
      expect(box.height).toBeGreaterThanOrEqual(name === 'phone' ? 44 : 36);
    }
    expect(await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth)).toBeLessThanOrEqual(0);
  });
}
