import { readFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { AnimationMixer, Vector3, type Object3D } from 'three';
import { evaluate, type CurveFile } from './support/curves';
import { fourPoses, loadSong, open, rejection, reload, saved } from './support/page';
import { wav } from './support/songs';

const SECONDS = 8;
const TIMES = [1, 2, 2.5, 4.5, 6];

/** The page with a song, key poses on its beats and a dance of curves through them. */
async function dancing(page: Page): Promise<void> {
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: SECONDS }));
  await page.evaluate(
    ({ times, poses }) =>
      window.posebeat.setKeyPoses(times.map((time, i) => ({ time, rotations: poses[i % poses.length] }))),
    { times: TIMES, poses: fourPoses() },
  );
  await page.evaluate(() => window.posebeat.generate({ engine: 'curves' }));
}

const rotations = (page: Page) => page.evaluate(() => [...window.posebeat.motion().rotations]);
const edits = (page: Page) => page.evaluate(() => window.posebeat.document().curveEdits ?? []);
/** Largest difference of two dances, radians, from `from` seconds to `to`. */
const apart = (a: number[], b: number[], from = 0, to = SECONDS) => {
  let most = 0;
  for (let i = Math.round(from * 30) * 72; i < Math.round(to * 30) * 72; i++) {
    most = Math.max(most, Math.abs(a[i] - b[i]));
  }
  return most;
};

/** Opens the curves of the left shoulder with the playhead between the second and the third key pose. */
async function openCurves(page: Page): Promise<void> {
  await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
  await page.keyboard.press('c');
  await page.getByRole('combobox', { name: 'Joint of the curves' }).selectOption({ label: 'Left shoulder' });
  await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
  for (let i = 0; i < 2; i++) await page.keyboard.press('>');
  await page.getByRole('button', { name: 'Zoom to the stretch' }).click();
}

/** Saves the dance's curves through the export panel, which is open then. */
async function exported(page: Page, as: 'GLB' | 'JSON'): Promise<Buffer> {
  const panel = page.getByRole('dialog', { name: 'Export the dance' });
  await panel.locator('.export-options label').filter({ hasText: as }).click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    panel.getByRole('button', { name: `Save .${as.toLowerCase()}` }).click(),
  ]);
  expect(download.suggestedFilename()).toBe(`song.curves.${as.toLowerCase()}`);
  return readFileSync(await download.path());
}

test('suggested, one pose changed, danced as curves, one bent, undone, exported and read back, all by hand', async ({
  page,
}) => {
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: SECONDS }));
  await page.getByRole('button', { name: 'Suggest key poses' }).click();
  await expect(page.locator('.notice').filter({ hasText: /key poses suggested/ })).toBeVisible({ timeout: 60_000 });
  const keys = () => page.evaluate(() => window.posebeat.document().keyPoses);
  const suggested = await keys();
  expect(suggested.length).toBeGreaterThan(5);
  await page
    .getByRole('button', { name: /suggested/ })
    .nth(2)
    .focus();
  const stepper = page.getByRole('group', { name: 'Other poses for this suggestion' });
  await expect(stepper).toContainText(/1 of [4-9]/, { timeout: 30_000 });
  await page.keyboard.press('n');
  await expect(stepper).toContainText(/2 of/);
  const changed = await keys();
  expect(changed.filter((key, i) => JSON.stringify(key) !== JSON.stringify(suggested[i]))).toHaveLength(1);

  await page.getByRole('tab', { name: 'Dance' }).click();
  await page.getByRole('radio', { name: 'Editable curves' }).check();
  await page.locator('.generate').click();
  await page.locator('.generate.fresh').waitFor({ timeout: 60_000 });
  const report = await page.evaluate(() => window.posebeat.report());
  expect(report.consistencyError).toBeLessThan(1e-6);
  expect(await page.evaluate(() => window.posebeat.document().engine)).toBe('curves');
  const before = await rotations(page);
  // The same project is the same dance.
  await page.evaluate(() => window.posebeat.generate());
  expect(await rotations(page)).toEqual(before);

  await openCurves(page);
  const tension = page.getByRole('slider', { name: 'Tension' });
  const value = Number(await tension.inputValue());
  await tension.focus();
  for (let i = 0; i < 6; i++) await page.keyboard.press(value > 0 ? 'ArrowLeft' : 'ArrowRight');
  const [edit] = await edits(page);
  expect(edit.track).toBe('left_shoulder');
  expect(Math.abs(edit.tension! - value / 100)).toBeCloseTo(0.3, 1);
  const bent = await rotations(page);
  expect(await page.evaluate(() => window.posebeat.report().consistencyError)).toBeLessThan(1e-6);

  await page.keyboard.press('Control+e');
  await page.locator('.export-card').filter({ hasText: 'Curves' }).click();
  const file = JSON.parse((await exported(page, 'JSON')).toString()) as CurveFile;
  const bytes = await exported(page, 'GLB');
  await page.keyboard.press('Escape');
  expect(file).toMatchObject({ format: 'posebeat-curves', version: 1 });
  expect(file.keys.flatMap(({ pose }) => pose ?? [])).toEqual(changed.map(({ id }) => id));
  const interval = file.keys.findIndex(({ pose, beat }) => (pose ?? beat) === edit.from);
  expect(file.keys[interval + 1].pose ?? file.keys[interval + 1].beat).toBe(edit.to);
  // A shape reaches into the two stretches beside its own, and no farther.
  const [from, to] = [file.keys[Math.max(0, interval - 1)].time, file.keys[interval + 2].time];
  expect(apart(before, bent, from, to)).toBeGreaterThan(0.005);
  expect(apart(before, bent, to + 0.1)).toBe(0);
  const dance = await page.evaluate(() => {
    const { root, rotations } = window.posebeat.motion();
    return { root: [...root], rotations: [...rotations] };
  });
  // What another program makes of the file, by its description alone, is the dance on stage.
  for (const frame of [20, 37, 75, 85, 112, 158]) {
    const values = evaluate(file, frame / 30);
    for (let c = 0; c < 3; c++) expect(values[c]).toBeCloseTo(dance.root[frame * 3 + c], 3);
    for (const joint of [0, 4, 16]) {
      const turn = dance.rotations.slice((frame * 24 + joint) * 3, (frame * 24 + joint) * 3 + 3);
      const angle = Math.hypot(...turn);
      const half = angle < 1e-9 ? 0.5 : Math.sin(angle / 2) / angle;
      const wanted = [...turn.map((value) => value * half), Math.cos(angle / 2)];
      const own = values.slice(3 + joint * 4, 7 + joint * 4);
      const length = Math.hypot(...own);
      const dot = own.reduce((sum, value, c) => sum + (value / length) * wanted[c], 0);
      expect(Math.abs(dot)).toBeCloseTo(1, 5);
    }
  }

  const { scene, animations } = await new GLTFLoader().parseAsync(Uint8Array.from(bytes).buffer, '');
  const tracks = animations[0].tracks.filter(({ name }) => file.joints.includes(name.split('.')[0]));
  expect(tracks).toHaveLength(25);
  // Keys at the key poses, and at the knots between them.
  const times = Array.from(tracks[1].times);
  expect(times.length).toBeGreaterThanOrEqual(3 * file.keys.length - 2);
  for (const key of file.keys) expect(Math.min(...times.map((time) => Math.abs(time - key.time)))).toBeLessThan(1e-5);
  const joints = file.joints.map((name) => scene.getObjectByName(name) as Object3D);
  const places = () => {
    scene.updateMatrixWorld(true);
    return joints.map((joint) => joint.getWorldPosition(new Vector3()));
  };
  const mixer = new AnimationMixer(scene);
  mixer.clipAction(animations[0]).play();
  for (const frame of [37, 75, 85, 112, 158]) {
    mixer.setTime(frame / 30);
    const given = places();
    joints[0].position.fromArray(dance.root, frame * 3);
    joints.forEach((joint, i) => {
      const turn = new Vector3().fromArray(dance.rotations, (frame * 24 + i) * 3);
      joint.quaternion.setFromAxisAngle(turn.clone().normalize(), turn.length());
    });
    places().forEach((place, i) =>
      expect(place.distanceTo(given[i]), `${file.joints[i]} at ${frame}`).toBeLessThan(0.01),
    );
  }

  // Every key press was a step of its own; all of them back is the dance as it was made.
  for (let i = 0; i < 6; i++) await page.keyboard.press('Control+z');
  expect(await edits(page)).toEqual([]);
  expect(apart(await rotations(page), before)).toBeLessThan(1e-6);
});

test('a knot is dragged live, Escape takes it back, letting go is one step; arrow keys do it too', async ({ page }) => {
  await dancing(page);
  const before = await rotations(page);
  await openCurves(page);
  const knot = page.getByRole('slider', { name: 'Left shoulder Z, first inner knot' });
  await knot.scrollIntoViewIfNeeded();
  const grab = async (by: number) => {
    const box = (await knot.boundingBox())!;
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x, y + by / 2);
    await page.mouse.move(x, y + by);
  };
  const undo = page.getByRole('button', { name: /^Undo/ });
  const label = await undo.getAttribute('title');
  await grab(20);
  await expect.poll(async () => apart(await rotations(page), before)).toBeGreaterThan(0.1);
  await page.keyboard.press('Escape');
  await page.mouse.up();
  expect(apart(await rotations(page), before)).toBeLessThan(1e-6);
  expect(await edits(page)).toEqual([]);
  expect(await undo.getAttribute('title')).toBe(label);

  await grab(20);
  await page.mouse.up();
  const dragged = await rotations(page);
  expect(apart(dragged, before)).toBeGreaterThan(0.1);
  expect(await edits(page)).toHaveLength(1);
  await page.keyboard.press('Control+z');
  expect(await edits(page)).toEqual([]);
  expect(apart(await rotations(page), before)).toBeLessThan(1e-6);

  await knot.focus();
  const value = Number(await knot.getAttribute('aria-valuenow'));
  await page.keyboard.press('Shift+ArrowUp');
  await expect(knot).toHaveAttribute('aria-valuenow', String(value + 10));
  await page.keyboard.press('ArrowRight');
  await expect(page.getByRole('slider', { name: 'Left shoulder Z, second inner knot' })).toBeFocused();

  // It is still there on the next visit, dance and all.
  const kept = await edits(page);
  const bent = await rotations(page);
  await saved(page, { dance: true });
  await reload(page);
  expect(await edits(page)).toEqual(kept);
  await expect.poll(async () => apart(await rotations(page), bent)).toBeLessThan(1e-6);

  // Other beats, the same music: the change stays with its key poses.
  await page.keyboard.press(']');
  expect(await edits(page)).toEqual(kept);
});

test('the engine is a choice of the Dance panel, and a model of another version is refused', async ({ page }) => {
  let asked = 0;
  await page.route('**/models/curves.json', async (route) => {
    asked += 1;
    const manifest = (await (await route.fetch()).json()) as object;
    await route.fulfill({ json: { ...manifest, specHash: '0'.repeat(64) } });
  });
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: 4 }));
  await page.evaluate(() => window.posebeat.generate());
  expect(asked).toBe(0);
  await page.getByRole('tab', { name: 'Dance' }).click();
  await page.getByRole('radio', { name: 'Editable curves' }).check();
  expect(await page.evaluate(() => window.posebeat.document().engine)).toBe('curves');
  expect(await rejection(page.evaluate(() => window.posebeat.generate()))).toMatch(/another version/);
  expect(asked).toBeGreaterThan(0);
  expect(await rejection(page.evaluate(() => window.posebeat.exportAs('curves')))).toMatch(/no curves/);
  await page.getByRole('radio', { name: 'Network frames' }).check();
  expect(await page.evaluate(() => 'engine' in window.posebeat.document())).toBe(false);
});
