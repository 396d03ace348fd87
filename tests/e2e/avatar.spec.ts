import { readFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { AnimationMixer, Vector3 } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { anonymousGlb, chairGlb, mixamoGlb, vrm1File } from '../unit/support/avatar-rigs';
import { violations } from './support/axe';
import { dismissAll } from './support/states';
import { collectErrors, dropFile, open } from './support/page';

const SPEC = JSON.parse(readFileSync(new URL('../../web/core/spec.json', import.meta.url), 'utf8')) as {
  skeleton: { joints: string[] };
};
const jointIndex = (name: string) => SPEC.skeleton.joints.indexOf(name);
const FEET = ['left_ankle', 'right_ankle', 'left_foot', 'right_foot'].map(jointIndex);

const who = (page: Page) => page.evaluate(() => window.posebeat.avatar()?.name ?? null);
const dances = (page: Page, name: string) => expect.poll(() => who(page)).toBe(name);

/** Heights of the lowest joint of the feet and ways of the right wrist, from picture to picture of the dance that plays. */
const watch = (page: Page, pictures: number) =>
  page.evaluate(
    async ({ feet, wrist, pictures }) => {
      const lowest: number[] = [];
      const places: string[] = [];
      for (let tries = 0; lowest.length < pictures && tries < 2000; tries++) {
        await new Promise(requestAnimationFrame);
        const { joints } = window.posebeat.avatar()!;
        const place = Array.from(joints.subarray(wrist * 3, wrist * 3 + 3)).join();
        if (places.includes(place)) continue;
        places.push(place);
        lowest.push(Math.min(...feet.map((joint) => joints[joint * 3 + 1])));
      }
      return lowest;
    },
    { feet: FEET, wrist: jointIndex('right_wrist'), pictures },
  );

type Kind = 'exportPicture' | 'exportKeyPoses';

/** A small picture of the dance, and the contact sheet of its key poses, their dancers cut out: 1 where one is. */
const silhouettes = (page: Page, kinds: readonly Kind[]) =>
  page.evaluate(async (kinds) => {
    const made: number[][] = [];
    for (const kind of kinds) {
      const options = { size: 180, aspect: '9:16', camera: 'front', background: 'none', time: 2 } as const;
      const blob =
        kind === 'exportPicture'
          ? await window.posebeat.exportPicture(options)
          : await window.posebeat.exportKeyPoses({ scale: 0.1 });
      const picture = await createImageBitmap(blob);
      const brush = new OffscreenCanvas(picture.width, picture.height).getContext('2d')!;
      brush.drawImage(picture, 0, 0);
      const { data } = brush.getImageData(0, 0, picture.width, picture.height);
      // The sheet has no see-through ground: there a dancer is what is brighter than all round it.
      const bright = (at: number) => data[at] + data[at + 1] + data[at + 2] > 300;
      made.push(
        Array.from({ length: data.length / 4 }, (_, i) =>
          Number(kind === 'exportPicture' ? data[i * 4 + 3] > 128 : bright(i * 4)),
        ),
      );
    }
    return made;
  }, kinds);

/** It moves, and one of its feet is on the floor or just above it, never below. */
async function expectFeetOnFloor(page: Page): Promise<void> {
  const lowest = await watch(page, 6);
  expect(lowest).toHaveLength(6);
  // The joint of the toes lies a few centimetres above the sole.
  expect(Math.min(...lowest)).toBeGreaterThan(-0.005);
  expect(Math.min(...lowest)).toBeLessThan(0.07);
}

test('a character of one’s own dances, is kept, and leaves as a file with the dance', async ({ page }) => {
  const errors = collectErrors(page);
  await page.setViewportSize({ width: 900, height: 560 });
  await open(page);
  const kinds = ['exportPicture', 'exportKeyPoses'] as const;
  const figures = await silhouettes(page, kinds);

  await dropFile(page, mixamoGlb(), 'Robo.glb');
  await dances(page, 'Robo');
  await expectFeetOnFloor(page);

  // It is in the pictures too, in our figure's place.
  const characters = await silhouettes(page, kinds);
  kinds.forEach((kind, i) => {
    const count = (pixels: readonly number[]) => pixels.filter((pixel) => pixel === 1).length;
    const changed = characters[i].map((pixel, at) => Number(pixel !== figures[i][at]));
    expect(characters[i], kind).toHaveLength(figures[i].length);
    expect(count(characters[i]), kind).toBeGreaterThan(0.3 * count(figures[i]));
    expect(count(characters[i]), kind).toBeLessThan(3 * count(figures[i]));
    expect(count(changed), kind).toBeGreaterThan(0.1 * count(figures[i]));
  });

  // What cannot dance changes nothing.
  for (const [bytes, name] of [
    [mixamoGlb().slice(0, 4000), 'broken.glb'],
    [chairGlb(), 'chair.glb'],
  ] as const) {
    await dropFile(page, bytes, name);
    await expect(page.getByRole('alert').filter({ hasText: name })).toBeVisible();
    expect(await who(page)).toBe('Robo');
  }
  await dismissAll(page);

  // Names that say nothing: the guess is shown, by keyboard.
  await dropFile(page, anonymousGlb(), 'Strange.glb');
  const bones = page.getByRole('dialog', { name: 'Which bone is which?' });
  await expect(bones).toBeVisible();
  expect(await violations(page, '.bones-panel')).toEqual([]);
  const knee = bones.getByRole('combobox', { name: 'Left knee' });
  const guess = await knee.inputValue();
  await knee.selectOption('None');
  await expect(bones.getByRole('button', { name: 'Use these bones' })).toBeDisabled();
  await expect(knee).toHaveAttribute('aria-invalid', 'true');
  await bones.getByRole('button', { name: 'Reset' }).click();
  await expect(knee).toHaveValue(guess);
  await page.keyboard.press('Escape');
  await expect(bones).toBeHidden();
  expect(await who(page)).toBe('Robo');
  await dropFile(page, anonymousGlb(), 'Strange.glb');
  await bones.getByRole('combobox', { name: 'Hips' }).press('Enter');
  await bones.getByRole('button', { name: 'Use these bones' }).click();
  await dances(page, 'Strange');
  await expectFeetOnFloor(page);

  await dropFile(page, vrm1File(), 'Box.vrm');
  await dances(page, 'Box');
  await expectFeetOnFloor(page);

  // The file with the dance, through the panel, read by three.
  await page.getByRole('button', { name: 'Export the dance' }).click();
  const panel = page.getByRole('dialog', { name: 'Export the dance' });
  await panel.getByRole('radio', { name: 'Your character (GLB)' }).check({ force: true });
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    panel.getByRole('button', { name: 'Save .glb' }).click(),
  ]);
  await page.keyboard.press('Escape');
  const bytes = readFileSync(await download.path());
  const { scene, animations } = await new GLTFLoader().parseAsync(Uint8Array.from(bytes).buffer, '');
  const { seconds, root } = await page.evaluate(() => {
    const { fps, root } = window.posebeat.motion();
    return { seconds: (root.length / 3 - 1) / fps, root: Array.from(root) };
  });
  expect(animations[0].duration).toBeCloseTo(seconds, 3);
  const mixer = new AnimationMixer(scene);
  mixer.clipAction(animations[0]).play();
  const hips = scene.getObjectByName('J_0')!;
  const walked = [0, 10].map((time) => {
    mixer.setTime(time);
    scene.updateMatrixWorld(true);
    return new Vector3().setFromMatrixPosition(hips.matrixWorld);
  });
  const ours = [0, 10].map((time) => new Vector3().fromArray(root, time * 30 * 3));
  // It goes where the dance goes, by the length of its own legs.
  const stride = walked[0].y / ours[0].y;
  const [way, ourWay] = [walked, ours].map(([a, b]) => b.clone().sub(a));
  expect(way.distanceTo(ourWay.multiplyScalar(stride))).toBeLessThan(0.05);

  // It holds a motion now too: which of them is wanted?
  await dropFile(page, bytes, 'both.glb');
  const question = page.getByRole('dialog', { name: 'Character or motion?' });
  await question.getByRole('button', { name: 'Use the motion' }).click();
  await expect(page.getByRole('heading', { name: 'Choose a frame' })).toBeVisible();

  await page.reload();
  await dances(page, 'Box');
  await page.getByRole('tab', { name: 'Dance', exact: true }).click();
  await page.locator('.figure-fold > summary').click();
  await page.getByRole('radio', { name: 'Robo' }).check();
  await dances(page, 'Robo');
  await page.getByRole('button', { name: 'Remove Robo' }).click();
  await expect.poll(() => who(page)).toBeNull();
  await expect(page.getByRole('radio', { name: 'Robo' })).toHaveCount(0);
  expect(errors).toEqual([]);
});
