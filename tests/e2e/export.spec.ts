import { readFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { unzipSync } from 'fflate';
import { validateBytes } from 'gltf-validator';
import { BVHLoader } from 'three/examples/jsm/loaders/BVHLoader.js';
import { openGltf } from '../../web/core/formats/gltf-file';
import { readNpy } from '../../web/core/formats/npy-read';
import { angleBetween, axisAngleToQuaternion } from '../../web/core/rotation';
import { collectErrors, loadSong, open, rejection } from './support/page';
import { wav } from './support/songs';

const SPEC = JSON.parse(readFileSync(new URL('../../web/core/spec.json', import.meta.url), 'utf8')) as {
  skeleton: { joints: string[] };
};

type Call = Parameters<typeof window.posebeat.exportAs>;

/** The bytes that the API gives. */
async function exported(page: Page, ...call: Call): Promise<Uint8Array> {
  const base64 = await page.evaluate(async (call) => {
    const blob = await window.posebeat.exportAs(...call);
    const url = await new Promise<string>((resolve) => {
      const reader = new FileReader();
      reader.onload = () => resolve(reader.result as string);
      reader.readAsDataURL(blob);
    });
    return url.slice(url.indexOf(',') + 1);
  }, call);
  return new Uint8Array(Buffer.from(base64, 'base64'));
}

const dialog = (page: Page) => page.getByRole('dialog', { name: 'Export the dance' });
const choose = (page: Page, name: string | RegExp) => dialog(page).getByRole('radio', { name }).check({ force: true });

/** Presses the button and takes the file. */
async function saved(page: Page) {
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    dialog(page)
      .getByRole('button', { name: /^Save \./ })
      .click(),
  ]);
  return { name: file.suggestedFilename(), bytes: new Uint8Array(readFileSync(await file.path())) };
}

const JOINTS = SPEC.skeleton.joints;
const text = (bytes: Uint8Array) => new TextDecoder().decode(bytes);

/** The dance on stage, frame by frame. */
const motionOf = async (page: Page) => {
  const plain = await page.evaluate(() => {
    const { fps, rotations, root } = window.posebeat.motion();
    return { fps, rotations: Array.from(rotations), root: Array.from(root) };
  });
  return { ...plain, frames: plain.root.length / 3 };
};

/** Rotations of a file by joint and frame, as other people's readers give them. */
type Turns = (joint: number, frame: number) => ArrayLike<number>;

function inGlb(bytes: Uint8Array): { frames: number; joints: number; turns: Turns } {
  const { json, numbers } = openGltf(bytes);
  const { channels, samplers } = json.animations[0];
  const tracks = new Map(
    channels
      .filter(({ target }) => target.path === 'rotation')
      .map(({ sampler, target }) => [target.node!, numbers(samplers[sampler].output)]),
  );
  const places = channels.find(({ target }) => target.path === 'translation')!;
  return {
    frames: numbers(samplers[places.sampler].input).length,
    joints: json.skins[0].joints.length,
    turns: (joint, frame) => {
      const values = tracks.get(joint)!;
      return values.length === 4 ? values : values.subarray(frame * 4, frame * 4 + 4);
    },
  };
}

function inBvh(text: string): { frames: number; duration: number; places: ArrayLike<number>; turns: Turns } {
  const { clip, skeleton } = new BVHLoader().parse(text);
  const names = skeleton.bones.map(({ name }) => name).filter((name) => name !== 'ENDSITE');
  const track = (joint: number) => clip.tracks.find(({ name }) => name === `${JOINTS[joint]}.quaternion`)!;
  expect(names).toHaveLength(24);
  return {
    frames: track(0).times.length,
    duration: clip.duration,
    places: clip.tracks.find(({ name }) => name === 'pelvis.position')!.values,
    turns: (joint, frame) => track(joint).values.subarray(frame * 4, frame * 4 + 4),
  };
}

function inNpz(bytes: Uint8Array): { frames: number; turns: Turns } {
  const files = unzipSync(bytes);
  const { shape, data } = readNpy(files['smpl_poses.npy'], 'smpl_poses');
  expect(Object.keys(files)).toContain('mocap_framerate.npy');
  return {
    frames: shape[0],
    turns: (joint, frame) => axisAngleToQuaternion(data.subarray(frame * 72 + joint * 3, frame * 72 + joint * 3 + 3)),
  };
}

interface MotionJson {
  fps: number;
  frames: number;
  root: number[][];
  rotations: number[][];
  song: { name: string; start: number };
  keyPoses: { time: number }[];
}
const inJson = (bytes: Uint8Array) => JSON.parse(text(bytes)) as MotionJson;

/** The greatest angle between a joint of the file and of the dance, radians. */
function farthest(turns: Turns, rotations: number[], every = 1): number {
  let most = 0;
  for (let i = 0; i * 3 < rotations.length; i += 1) {
    const ours = axisAngleToQuaternion(rotations.slice(i * 3, i * 3 + 3));
    most = Math.max(most, angleBetween(turns(i % 24, Math.floor(i / 24) * every), ours));
  }
  return most;
}

test('every format is saved from the panel, and is the dance on stage', async ({ page }) => {
  const errors = collectErrors(page);
  await open(page);
  const dance = await motionOf(page);
  await page.keyboard.press('Control+e');
  await expect(dialog(page)).toBeVisible();

  const glb = await saved(page);
  expect(glb.name).toBe('Warm Circuit.glb');
  expect((await validateBytes(glb.bytes)).issues).toMatchObject({ numErrors: 0, numWarnings: 0 });
  const figure = inGlb(glb.bytes);
  expect(figure.joints).toBeGreaterThan(24);
  expect(figure.frames).toBe(dance.frames);
  expect(farthest(figure.turns, dance.rotations)).toBeLessThan(1e-5);
  await choose(page, 'Skeleton only');
  const bones = await saved(page);
  expect(inGlb(bones.bytes).joints).toBe(24);
  expect(bones.bytes.length).toBeLessThan(glb.bytes.length / 2);

  await choose(page, /FBX/);
  const fbx = await saved(page);
  expect(fbx.name).toBe('Warm Circuit.fbx');
  expect(text(fbx.bytes.subarray(0, 18))).toBe('Kaydara FBX Binary');

  await choose(page, /BVH/);
  await choose(page, '60');
  await choose(page, /^Metres/);
  const bvh = await saved(page);
  const fast = inBvh(text(bvh.bytes));
  expect(fast.frames).toBe(dance.frames * 2 - 1);
  expect(fast.duration).toBeCloseTo((dance.frames - 1) / dance.fps, 4);
  expect(farthest(fast.turns, dance.rotations, 2)).toBeLessThan(1e-5);
  for (let k = 0; k < 3; k += 1) expect(fast.places[k]).toBeCloseTo(dance.root[k], 5);

  await choose(page, /SMPL/);
  await choose(page, '30');
  const npz = await saved(page);
  expect(npz.name).toBe('Warm Circuit.npz');
  expect(inNpz(npz.bytes).frames).toBe(dance.frames);
  expect(farthest(inNpz(npz.bytes).turns, dance.rotations)).toBeLessThan(1e-5);

  await choose(page, /JSON/);
  const json = inJson((await saved(page)).bytes);
  expect(json.frames).toBe(dance.frames);
  expect(json.song.name).toBe('Warm Circuit');
  expect(json.keyPoses.length).toBeGreaterThan(3);
  const row = (joint: number, frame: number) => json.rotations[frame].slice(joint * 4, joint * 4 + 4);
  expect(farthest(row, dance.rotations)).toBeLessThan(1e-5);

  await page.keyboard.press('Escape');
  await expect(dialog(page)).toBeHidden();
  expect(errors).toEqual([]);
});

test('the API gives the same files, and a stretch of them', async ({ page }) => {
  await open(page);
  const dance = await motionOf(page);
  expect(inJson(await exported(page, 'json')).frames).toBe(dance.frames);
  const range = { start: 2, end: 4 };
  const part = inJson(await exported(page, 'json', { range, fps: 120 }));
  expect(part.frames).toBe(241);
  expect(part.song.start).toBe(2);
  part.root[0].forEach((value, k) => expect(value).toBeCloseTo(dance.root[60 * 3 + k], 5));
  part.root[240].forEach((value, k) => expect(value).toBeCloseTo(dance.root[120 * 3 + k], 5));
  const bvh = inBvh(text(await exported(page, 'bvh', { range })));
  expect(bvh.frames).toBe(61);
  // Centimetres, where nothing is said.
  expect(bvh.places[1]).toBeCloseTo(dance.root[60 * 3 + 1] * 100, 3);
  expect(inGlb(await exported(page, 'glb', { range, figure: false })).frames).toBe(61);
  expect(inNpz(await exported(page, 'npz', { range })).frames).toBe(61);
  expect(await rejection(exported(page, 'bvh', { fps: 29 }))).toContain('fps must be one of');
  expect(await rejection(exported(page, 'json', { range: 'loop' }))).toContain('No stretch is selected');
});

test('by keyboard alone; Esc gives the focus back', async ({ page }) => {
  await open(page);
  const opener = page.getByRole('button', { name: 'Save the project' });
  await opener.focus();
  await page.keyboard.press('Control+e');
  await expect(dialog(page)).toBeVisible();
  await expect(dialog(page).getByRole('radio', { name: /GLB/ })).toBeFocused();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('ArrowDown');
  await expect(dialog(page).getByRole('radio', { name: /BVH/ })).toBeChecked();
  // Keys of the page rest: G would generate.
  await page.keyboard.press('g');
  const button = dialog(page).getByRole('button', { name: 'Save .bvh' });
  for (let i = 0; i < 8 && !(await button.evaluate((each) => each === document.activeElement)); i += 1) {
    await page.keyboard.press('Tab');
  }
  await expect(button).toBeFocused();
  const [file] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('Enter')]);
  expect(file.suggestedFilename()).toBe('Warm Circuit.bvh');
  // The button was away while the file was written: the keyboard is not left on the page behind.
  await expect(button).toBeFocused();
  await page.keyboard.press('Escape');
  await expect(dialog(page)).toBeHidden();
  await expect(opener).toBeFocused();
});

test('without a dance the panel says what to do', async ({ page }) => {
  await open(page);
  await loadSong(page, wav({ seconds: 6 }));
  await page.keyboard.press('Control+e');
  await expect(dialog(page)).toContainText('There is no dance yet.');
  await expect(dialog(page).getByRole('button', { name: /^Save/ })).toHaveCount(0);
  expect(await rejection(exported(page, 'glb'))).toContain('no dance yet');
});

test('on a phone the panel is whole, from the project menu', async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open(page);
  await page.getByRole('button', { name: 'Save the project' }).click();
  await page.getByRole('button', { name: /Export the dance/ }).click();
  await expect(dialog(page)).toBeVisible();
  const box = (await dialog(page).boundingBox())!;
  expect(box.x).toBeGreaterThanOrEqual(0);
  expect(box.x + box.width).toBeLessThanOrEqual(390);
  expect(box.y + box.height).toBeLessThanOrEqual(844);
  const button = dialog(page).getByRole('button', { name: /^Save \./ });
  await expect(button).toBeInViewport({ ratio: 1 });
  for (const each of await dialog(page).locator('label, button').all()) {
    expect((await each.boundingBox())!.height).toBeGreaterThanOrEqual(44);
  }
});
