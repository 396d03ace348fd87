/** Posing by dragging: the joint goes with the pointer, the body follows. */
import { readFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { collectErrors, loadSong, open } from './support/page';
import { alongTheArm, figure, findJoint, newPose, poseAtRest } from './support/posing';
import { wav } from './support/songs';

const spec = JSON.parse(readFileSync(new URL('../../web/core/spec.json', import.meta.url), 'utf8')) as {
  skeleton: { joints: string[] };
};
const joint = (page: Page) => page.getByLabel('Joint', { exact: true });

// A small stage: without a graphics card every pixel costs.
test.use({ viewport: { width: 960, height: 640 } });

/** The pose on the timeline, as one angle per joint, degrees. */
async function addAndRead(page: Page): Promise<(name: string) => number> {
  await page.getByRole('button', { name: 'Add to timeline' }).click();
  const [key] = await page.evaluate(() => window.posebeat.document().keyPoses);
  return (name) => {
    const at = spec.skeleton.joints.indexOf(name) * 3;
    return (Math.hypot(...key.rotations.slice(at, at + 3)) * 180) / Math.PI;
  };
}

async function startMoving(page: Page): Promise<void> {
  await open(page);
  await loadSong(page, wav({ seconds: 6 }));
  await newPose(page);
  await page.keyboard.press('w');
}

test('a hand is dragged by its dot; Esc takes the drag back', async ({ page }) => {
  const errors = collectErrors(page);
  await startMoving(page);
  const wrist = await findJoint(page, 'Left wrist', alongTheArm('right'));
  await page.mouse.down();
  await page.mouse.move(wrist.x - 20, wrist.y + 60, { steps: 5 });
  await page.keyboard.press('Escape');
  await page.mouse.up();
  await expect(joint(page)).toHaveValue('20');
  await expect(page.getByRole('button', { name: 'Undo' })).toBeDisabled();

  await page.mouse.move(wrist.x, wrist.y);
  await page.mouse.down();
  await page.mouse.move(wrist.x - 76, wrist.y - 30, { steps: 8 });
  await poseAtRest(page);
  await page.mouse.up();
  await expect(page.getByRole('button', { name: 'Undo' })).toBeEnabled();

  const angle = await addAndRead(page);
  expect(angle('left_shoulder')).toBeGreaterThan(10);
  expect(angle('left_elbow')).toBeGreaterThan(10);
  expect(angle('right_shoulder')).toBeLessThan(2);
  expect(angle('left_knee')).toBeLessThan(8);
  expect(errors).toEqual([]);
});

test('arrow keys move the hips, and the knees bend over standing feet', async ({ page }) => {
  await startMoving(page);
  await joint(page).selectOption({ value: '0' });
  await figure(page).focus();
  for (let i = 0; i < 3; i++) await page.keyboard.press('Shift+ArrowDown');
  await poseAtRest(page);
  const angle = await addAndRead(page);
  expect(angle('left_knee')).toBeGreaterThan(25);
  expect(Math.abs(angle('left_knee') - angle('right_knee'))).toBeLessThan(10);
  expect(angle('left_ankle')).toBeGreaterThan(10);
});
