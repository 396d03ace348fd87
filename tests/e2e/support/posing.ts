import { expect, type Locator, type Page } from '@playwright/test';

/** The figure in the pose editor. */
export const figure = (page: Page): Locator => page.getByRole('application', { name: 'Figure' });

/** A rectangle on the page, CSS pixels. */
export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** Where a joint is on the screen: the pointer goes through points until its label says so. */
export async function findJoint(
  page: Page,
  label: string,
  points: (box: Box) => [number, number][],
): Promise<{ x: number; y: number }> {
  const box = (await figure(page).boundingBox())!;
  for (const [x, y] of points(box)) {
    await page.mouse.move(x, y);
    const tip = page.locator('.joint-tip', { hasText: label });
    if ((await tip.count()) === 0) continue;
    // The label hangs on the joint itself.
    const [left, top] = await tip.evaluate((element) => [element.style.left, element.style.top].map(parseFloat));
    return { x: box.x + left, y: box.y + top };
  }
  throw new Error(`The pointer never found "${label}".`);
}

/** Heights of an outstretched arm in the view, the likely ones first: a drag of the other arm may have made the trunk lean. */
const ARM_HEIGHTS = [0.3, 0.33, 0.36, 0.315, 0.345, 0.28, 0.38, 0.26, 0.4, 0.24, 0.42];

/** Points along an outstretched arm of the standing figure, from the shoulder outwards; `side` is where it is on the screen. */
export const alongTheArm =
  (side: 'left' | 'right') =>
  (box: Box): [number, number][] =>
    ARM_HEIGHTS.flatMap((height) =>
      Array.from({ length: 50 }, (_, i): [number, number] => [
        box.x + box.width * (0.5 + (side === 'right' ? 1 : -1) * (0.03 + i * 0.004)),
        box.y + box.height * height,
      ]),
    );

/** Opens the editor with the figure standing, its arms out, and waits until it is drawn. */
export async function newPose(page: Page): Promise<void> {
  await page.getByRole('tab', { name: 'Poses' }).click();
  await page.getByRole('button', { name: 'New pose' }).click();
  await expect(figure(page)).toBeVisible();
  await page.waitForTimeout(600);
}
