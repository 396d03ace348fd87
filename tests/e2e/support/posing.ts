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

/** The camera and the figure stand still when a joint moves less than this over some frames, CSS pixels. */
const STILL = 0.5;

/** Where a joint's label is once a pointer hovers over one of the points; null where none of them finds it. */
const hover = (page: Page, label: string, points: [number, number][]) =>
  figure(page).evaluate(
    async (element, { label, points }) => {
      const canvas = element.querySelector('canvas')!;
      for (let frame = 0; frame < 3; frame++) await new Promise(requestAnimationFrame);
      /** Lets the page draw what it heard; timers would be slowed down. */
      const heard = () =>
        new Promise((resolve) => {
          const { port1, port2 } = new MessageChannel();
          port1.onmessage = resolve;
          port2.postMessage(null);
        });
      for (const [clientX, clientY] of points) {
        canvas.dispatchEvent(
          new PointerEvent('pointermove', { clientX, clientY, pointerType: 'mouse', bubbles: true }),
        );
        await heard();
        const tip = document.querySelector<HTMLElement>('.joint-tip');
        if (!tip?.textContent.includes(label)) continue;
        // The label hangs on the joint itself.
        const { left, top } = element.getBoundingClientRect();
        return { x: left + parseFloat(tip.style.left), y: top + parseFloat(tip.style.top) };
      }
      return null;
    },
    { label, points },
  );

/** Puts the pointer on a joint: it goes through points until the joint's label is there, and waits until the joint stays in its place. */
export async function findJoint(
  page: Page,
  label: string,
  points: (box: Box) => [number, number][],
): Promise<{ x: number; y: number }> {
  const all = points((await figure(page).boundingBox())!);
  let before = await hover(page, label, all);
  for (let attempt = 0; attempt < 30; attempt++) {
    const now = await hover(page, label, before ? [[before.x, before.y], ...all] : all);
    if (before && now && Math.hypot(now.x - before.x, now.y - before.y) < STILL) {
      await page.mouse.move(now.x, now.y);
      await expect(page.locator('.joint-tip', { hasText: label })).toBeVisible();
      return now;
    }
    before = now;
  }
  throw new Error(`The pointer never found "${label}".`);
}

/** Waits until what the editor tells of the chosen joint stands still: the body follows a drag within some frames. */
export async function poseAtRest(page: Page): Promise<void> {
  await page.locator('.joint-row').evaluate(async () => {
    /** Degrees or centimetres; a body at full stretch may tremble by less than that. */
    const slack = 0.5;
    const read = () =>
      [...document.querySelectorAll<HTMLInputElement>('.angles input')].map(({ value }) => Number(value));
    let before = read();
    // However far the way, a drag is over after so many frames.
    for (let frame = 0, still = 0; still < 6 && frame < 60; frame++) {
      await new Promise(requestAnimationFrame);
      const now = read();
      still = now.every((value, i) => Math.abs(value - before[i]) < slack) ? still + 1 : 0;
      if (still === 0) before = now;
    }
  });
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

/** Opens the editor with the figure standing, its arms out. */
export async function newPose(page: Page): Promise<void> {
  await page.getByRole('tab', { name: 'Poses' }).click();
  await page.getByRole('button', { name: 'New pose' }).click();
  await expect(figure(page)).toBeVisible();
}
