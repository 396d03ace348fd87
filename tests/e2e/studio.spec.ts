/** The whole way through the studio, once by mouse and once by keyboard alone: from a song to a dance, back to the start and on again. */
import { expect, test, type Page } from '@playwright/test';
import { collectErrors, open, reload, saved } from './support/page';
import { alongTheArm, figure, findJoint, newPose, poseAtRest } from './support/posing';
import { wav } from './support/songs';
import { tapAlong } from './support/taps';

// Without a graphics card every pixel of the stage costs.
test.use({ viewport: { width: 1200, height: 720 } });
test.setTimeout(300_000);

/** Nine whole bars wherever the first one begins. */
const SECONDS = 29;
/** The song's own tempo is heard twice as fast as it is tapped, beats per minute. */
const TEMPO = 168;
/** Seconds of a beat and of a bar after tapping. */
const BEAT = 120 / TEMPO;
const BAR = 4 * BEAT;
const song = () => ({ name: 'long road.wav', mimeType: 'audio/wav', buffer: wav({ seconds: SECONDS, tempo: TEMPO }) });

const project = (page: Page) => page.evaluate(() => window.posebeat.document());
const dance = (page: Page) =>
  page.evaluate(() => {
    const { rotations, root } = window.posebeat.motion();
    return [...rotations, ...root];
  });
const undoButton = (page: Page) => page.getByRole('banner').getByRole('button', { name: 'Undo' });
const redoButton = (page: Page) => page.getByRole('banner').getByRole('button', { name: 'Redo' });

/** Waits until nothing is being made and the dance is up to date. */
async function calm(page: Page): Promise<void> {
  await expect(page.locator('.generate.busy')).toHaveCount(0, { timeout: 90_000 });
  await expect(page.locator('.generate')).toHaveClass(/fresh/);
}

/** Eight taps on every second beat while the song plays: half of the tempo that was heard. By key, or by mouse. */
async function tap(page: Page, at?: { x: number; y: number }): Promise<void> {
  // The first only starts the song.
  if (at) await page.mouse.click(at.x, at.y);
  else await page.keyboard.press('t');
  await expect(page.getByRole('button', { name: 'Pause' })).toBeVisible();
  // A page that heard nothing for a second takes a tap for a later one: once more, then, as anybody would.
  for (let attempt = 0; attempt < 3; attempt++) {
    if (attempt > 0) await page.keyboard.press('Control+z');
    await tapAlong(page, 8, BEAT, at);
    await expect(page.locator('.tap-text')).toHaveText('Tap');
    if (Math.abs((await project(page)).grid!.tempo - TEMPO / 2) < 2) return;
  }
  throw new Error(`Three times eight even taps never gave ${TEMPO / 2} beats a minute.`);
}

/** All steps back and all steps on again: the same documents in between, to the last bit, and the same dance. */
async function thereAndBack(page: Page, undo: () => Promise<void>, redo: () => Promise<void>): Promise<void> {
  const last = await project(page);
  const danced = await dance(page);
  const before = [last];
  while (await undoButton(page).isEnabled()) {
    await undo();
    before.push(await project(page));
    expect(before.length, 'steps back').toBeLessThan(80);
  }
  expect(before.length).toBeGreaterThan(12);
  expect(before.at(-1)!.keyPoses.map(({ name }) => name)).not.toContain('Reach');
  for (let step = before.length - 2; step >= 0; step--) {
    await redo();
    expect(await project(page)).toEqual(before[step]);
  }
  await expect(redoButton(page)).toBeDisabled();
  await calm(page);
  expect(await dance(page)).toEqual(danced);

  // What was kept is there after a reload.
  await saved(page, { dance: true });
  await reload(page);
  expect(await project(page)).toEqual(last);
  await calm(page);
  expect(await dance(page)).toEqual(danced);
  await expect(page.getByRole('list', { name: 'My poses' }).locator('.pose-tile')).toHaveText(['Reach']);
}

/** Eight key poses on beats, the own one first, and two takes of bars 5 to 8. */
async function checkProject(page: Page): Promise<void> {
  const { keyPoses, grid, ranges } = await project(page);
  expect(keyPoses).toHaveLength(8);
  expect(keyPoses[0].name).toBe('Reach');
  for (const { time } of keyPoses)
    expect(Math.min(...grid!.beats.map((beat) => Math.abs(beat - time)))).toBeLessThan(0.02);
  expect(ranges).toHaveLength(1);
  expect(ranges[0].takes).toHaveLength(2);
  const [five, nine] = [grid!.downbeats[4], grid!.downbeats[8]];
  expect(ranges[0].start).toBeCloseTo(five, 1);
  expect(ranges[0].end).toBeCloseTo(nine, 1);
}

test('by mouse', async ({ page }) => {
  const errors = collectErrors(page);
  await open(page, '?backend=wasm');

  const { name, mimeType, buffer } = song();
  const transfer = await page.evaluateHandle(
    ({ name, mimeType, base64 }) => {
      const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
      const data = new DataTransfer();
      data.items.add(new File([bytes], name, { type: mimeType }));
      return data;
    },
    { name, mimeType, base64: buffer.toString('base64') },
  );
  for (const type of ['dragenter', 'dragover', 'drop'])
    await page.locator('.stage').dispatchEvent(type, { dataTransfer: transfer });
  await expect(page.locator('.song-title')).toContainText('long road.wav');
  await expect(page.getByRole('button', { name: 'Beats', exact: true })).toBeEnabled({ timeout: 60_000 });

  const tapButton = (await page.locator('.bar-button.tap').boundingBox())!;
  await tap(page, { x: tapButton.x + 20, y: tapButton.y + tapButton.height / 2 });
  await page.getByRole('button', { name: 'Pause' }).click();

  await newPose(page);
  await page.getByRole('button', { name: 'Move joints' }).click();
  const wrist = await findJoint(page, 'Left wrist', alongTheArm('right'));
  await page.mouse.down();
  await page.mouse.move(wrist.x - 40, wrist.y - 60, { steps: 6 });
  await page.mouse.move(wrist.x - 70, wrist.y - 120, { steps: 6 });
  await poseAtRest(page);
  await page.mouse.up();
  await page.getByRole('button', { name: 'Turn joints' }).click();
  const elbow = await findJoint(page, 'Right elbow', alongTheArm('left'));
  await page.mouse.click(elbow.x, elbow.y);
  const radius = (await figure(page).boundingBox())!.height * 0.0736;
  await page.mouse.move(elbow.x, elbow.y - radius);
  await page.mouse.down();
  await page.mouse.move(elbow.x - radius * 0.5, elbow.y - radius * 0.9, { steps: 4 });
  await page.mouse.move(elbow.x - radius * 0.9, elbow.y - radius * 0.5, { steps: 4 });
  await page.mouse.up();
  await page.getByRole('button', { name: 'Mirror', exact: true }).first().click();
  await page.getByLabel('Name of the pose').click();
  await page.keyboard.type('Reach');
  await page.getByRole('button', { name: 'Save', exact: true }).click();
  await page.getByRole('toolbar', { name: 'Pose editor' }).getByRole('button', { name: 'Cancel' }).click();
  const own = page.getByRole('list', { name: 'My poses' }).locator('.pose-tile');
  await expect(own).toHaveText(['Reach']);

  await page.getByRole('button', { name: 'Show the whole song' }).click();
  const lane = (await page.locator('.key-lane').boundingBox())!;
  for (let bar = 0; bar < 8; bar++) {
    const tile = bar === 0 ? own : page.locator('.pose-sections .pose-tile').nth(bar * 5);
    await tile.scrollIntoViewIfNeeded();
    const from = (await tile.boundingBox())!;
    await page.mouse.move(from.x + from.width / 2, from.y + 30);
    await page.mouse.down();
    await page.mouse.move(from.x, from.y + 60, { steps: 3 });
    await page.mouse.move(lane.x + lane.width * ((bar * BAR + 2.2 * BEAT) / SECONDS), lane.y + lane.height / 2, {
      steps: 6,
    });
    await page.mouse.up();
    expect((await project(page)).keyPoses).toHaveLength(bar + 1);
  }

  await page.locator('.generate').click();
  await calm(page);

  const { grid } = await project(page);
  const x = (time: number) => lane.x + 30 + (time / SECONDS) * (lane.width - 60);
  const ruler = (await page.locator('.timeline-surface').boundingBox())!.y + 10;
  // The playhead stands where the tapping ended; on bar 5 it would be what is dragged.
  await page.mouse.click(x(0.5), ruler);
  await page.mouse.move(x(grid!.downbeats[4]), ruler);
  await page.mouse.down();
  await page.mouse.move(x(grid!.downbeats[6]), ruler, { steps: 4 });
  await page.mouse.move(x(grid!.downbeats[8]), ruler, { steps: 4 });
  await page.mouse.up();
  const tools = page.getByRole('group', { name: 'Selected range, bars 5–8' });
  const chip = page.locator('.range-chip');
  await tools.getByRole('button', { name: 'Regenerate 5–8' }).click();
  await expect(chip).toHaveText('1/1');
  await calm(page);
  await tools.getByRole('button', { name: 'Regenerate 5–8' }).click();
  await expect(chip).toHaveText('2/2');
  await calm(page);
  await tools.getByRole('button', { name: 'Previous take of the range' }).click();
  await expect(chip).toHaveText('1/2');
  await calm(page);
  await checkProject(page);

  await thereAndBack(
    page,
    () => undoButton(page).click(),
    () => redoButton(page).click(),
  );
  expect(errors).toEqual([]);
});

test('by keyboard alone', async ({ page }) => {
  const errors = collectErrors(page);
  const press = (keys: string, times = 1) =>
    Array.from({ length: times }).reduce<Promise<void>>(
      (before) => before.then(() => page.keyboard.press(keys)),
      Promise.resolve(),
    );
  /** Goes on with Tab, or back, until the focus is on what a selector finds. */
  const tabTo = async (selector: string, back = false) => {
    for (let i = 0; i < 150; i++) {
      if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return;
      await press(back ? 'Shift+Tab' : 'Tab');
    }
    throw new Error(`Tab never reached ${selector}.`);
  };
  await open(page, '?backend=wasm');
  // Long before the key is pressed: the browser must know that choosers are caught here.
  const chooser = page.waitForEvent('filechooser', { timeout: 120_000 });
  await tabTo('.drop-target');
  await press('Enter');
  await (await chooser).setFiles(song());
  await expect(page.locator('.song-title')).toContainText('long road.wav');
  await expect(page.getByRole('button', { name: 'Beats', exact: true })).toBeEnabled({ timeout: 60_000 });

  await tap(page);
  await tabTo('.transport .play');
  await press('Enter');
  await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible();

  await tabTo('[role=tab][aria-selected=true]');
  await tabTo('.pose-actions button');
  await press('Enter');
  await expect(figure(page)).toBeVisible();
  await tabTo('[role=application]', true);
  // From the hips up the spine to the chest, out to the left arm and down to the wrist.
  await press('ArrowDown');
  for (const key of ['ArrowDown', 'ArrowDown', 'ArrowDown', 'ArrowRight', 'ArrowDown', 'ArrowDown', 'ArrowDown'])
    await press(`Control+${key}`);
  const joint = page.getByLabel('Joint', { exact: true });
  await expect(joint).toHaveValue('20');
  await press('w');
  await press('ArrowUp', 12);
  await poseAtRest(page);
  await press('e');
  await press('Control+ArrowUp');
  await expect(joint).toHaveValue('18');
  await press('ArrowLeft', 4);
  await press('m');
  await tabTo('.save-draft input');
  await page.keyboard.type('Reach');
  await press('Enter');
  await press('Escape');
  await press('Escape');
  await expect(figure(page)).toHaveCount(0);

  await press('0');
  const toBar = async (bar: number) => {
    await press('Home');
    await press('PageDown', bar);
    await press('ArrowRight', 2);
  };
  for (let bar = 0; bar < 3; bar++) {
    await tabTo('[role=slider].playhead-grip', bar > 0);
    await toBar(bar);
    await tabTo('.pose-tile[tabindex="0"]');
    // From the own pose into the library, and on in it.
    if (bar > 0) await press(bar === 1 ? 'ArrowDown' : 'ArrowRight');
    await press('Enter');
    expect((await project(page)).keyPoses).toHaveLength(bar + 1);
  }
  await press('Control+c');
  await tabTo('[role=slider].playhead-grip', true);
  for (let bar = 3; bar < 8; bar++) {
    await toBar(bar);
    await press('Control+v');
    expect((await project(page)).keyPoses).toHaveLength(bar + 1);
  }
  await press('Escape');

  await press('g');
  await calm(page);
  await tabTo('[role=slider].playhead-grip', true);
  await press('Home');
  const five = (await project(page)).grid!.downbeats[4];
  for (let i = 0; i < 60; i++) {
    const now = Number(await page.locator('.playhead-grip').getAttribute('aria-valuenow'));
    if (now > five - BEAT / 6) break;
    await press('ArrowRight');
  }
  await press('l');
  await press('Shift+G');
  const chip = page.locator('.range-chip');
  await expect(chip).toHaveText('1/1');
  await calm(page);
  await press('Shift+G');
  await expect(chip).toHaveText('2/2');
  await calm(page);
  await press('Alt+ArrowLeft');
  await expect(chip).toHaveText('1/2');
  await calm(page);
  await checkProject(page);

  await thereAndBack(
    page,
    () => press('Control+z'),
    () => press('Control+Shift+z'),
  );
  expect(errors).toEqual([]);
});
