import { readFileSync } from 'node:fs';
import { expect, test, type BrowserContext, type Page } from '@playwright/test';
import { strToU8, zipSync } from 'fflate';
import { fourPoses, loadSong, open, reload, saved } from './support/page';
import { wav } from './support/songs';

const SONG = wav({ seconds: 6 });
const poses = fourPoses();

const json = (page: Page) => page.evaluate(() => JSON.stringify(window.posebeat.document()));
const keyCount = (page: Page) => page.evaluate(() => window.posebeat.document().keyPoses.length);
const place = (page: Page, times: number[]) =>
  page.evaluate(
    ({ times, poses }) => window.posebeat.setKeyPoses(times.map((time, i) => ({ time, rotations: poses[i] }))),
    { times, poses },
  );
/** Makes the page save what it has not, as it would when it is left; where it may not, this changes nothing. */
const asIfLeft = (page: Page) => page.evaluate(() => void window.dispatchEvent(new Event('pagehide')));
/** Two more tabs of one visitor share what is kept; a context of its own is another visitor. */
const another = async (context: BrowserContext) => {
  const page = await context.newPage();
  await open(page);
  return page;
};
/** Choosers are caught from here on; catching only the awaited one would begin too late for a key that is pressed at once. */
const catchChoosers = async (page: Page) => {
  page.on('filechooser', () => undefined);
  // The browser answers in order: after this it knows.
  await page.evaluate(() => undefined);
};
const openFile = async (page: Page, name: string, buffer: Buffer) => {
  const chooser = page.waitForEvent('filechooser');
  await page.keyboard.press('Control+o');
  await (await chooser).setFiles({ name, mimeType: 'application/octet-stream', buffer });
};
const download = async (page: Page, act: () => Promise<void>) => {
  const [file] = await Promise.all([page.waitForEvent('download'), act()]);
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
};

test('a project saved with its song opens in another browser: the same document, and the song plays', async ({
  page,
  browser,
}) => {
  await open(page, '?backend=wasm');
  await loadSong(page, SONG, 'My song.wav');
  await place(page, [1, 2.5, 4]);
  const before = await json(page);
  const file = await download(page, () => page.keyboard.press('Control+s'));
  expect(file.name).toBe('My song.posebeat');
  expect(file.bytes.subarray(0, 2).toString()).toBe('PK');
  expect(file.bytes.includes(SONG)).toBe(true);

  const context = await browser.newContext();
  const other = await context.newPage();
  await open(other, '?backend=wasm');
  await catchChoosers(other);
  await openFile(other, file.name, file.bytes);
  await expect.poll(() => json(other)).toBe(before);
  await expect(other.locator('.song-title')).toContainText('My song.wav');
  const clock = other.locator('.readout-time');
  const first = await clock.innerText();
  await other.getByRole('button', { name: 'Play', exact: true }).click();
  await expect(clock).not.toHaveText(first);
  // The dance is made from the project by itself.
  const frames = () => other.evaluate(() => window.posebeat.motion().rotations.length / 72).catch(() => 0);
  await expect.poll(frames, { timeout: 60_000 }).toBe(180);
  // What was there before is one step of undo away.
  await other.keyboard.press('Control+z');
  await expect(other.locator('.song-title')).toContainText('demo');
  await other.keyboard.press('Control+Shift+z');
  await expect.poll(() => json(other)).toBe(before);
  await context.close();
});

test('without its song it is readable JSON that asks for the song by name and knows it', async ({ page, browser }) => {
  await open(page);
  await loadSong(page, SONG, 'My song.wav');
  await place(page, [1, 3]);
  const before = await json(page);
  const file = await download(page, async () => {
    await page.getByRole('button', { name: 'Save the project' }).click();
    await page.getByRole('button', { name: /without the song/ }).click();
  });
  expect(JSON.parse(file.bytes.toString())).toEqual(JSON.parse(before));
  const same = await page.evaluate(async () => (await window.posebeat.exportAs('project')).text());
  expect(JSON.parse(same)).toEqual(JSON.parse(before));

  const context = await browser.newContext();
  const other = await context.newPage();
  await open(other);
  await catchChoosers(other);
  const demo = await json(other);
  await openFile(other, file.name, file.bytes);
  await expect(other.getByText('Now drop “My song.wav”, the song of this project.')).toBeVisible();
  expect(await json(other)).toBe(demo);
  const drop = async (name: string, buffer: Buffer) => {
    const chooser = other.waitForEvent('filechooser');
    await other.getByRole('button', { name: /new song/i }).click();
    await (await chooser).setFiles({ name, mimeType: 'audio/wav', buffer });
  };
  await drop('other.wav', wav({ seconds: 5, tempo: 100 }));
  await expect(other.getByText('“other.wav” is not “My song.wav”')).toBeVisible();
  await drop('renamed.wav', SONG);
  await expect.poll(() => json(other)).toBe(before);
  await context.close();
});

test('broken, newer and hostile files are refused in a sentence and change nothing', async ({ page }) => {
  await open(page);
  await loadSong(page, SONG, 'My song.wav');
  await place(page, [1, 3]);
  const before = await json(page);
  await catchChoosers(page);
  const whole = await page.evaluate(async () => {
    const blob = await window.posebeat.exportAs('project', { song: true });
    return [...new Uint8Array(await blob.arrayBuffer())];
  });
  const swapped = zipSync({ 'project.json': strToU8(before), 'song.wav': wav({ seconds: 1 }) });
  const files: [string, Uint8Array | string, RegExp][] = [
    ['empty.posebeat', '', /empty/],
    ['notes.posebeat', 'hello', /damaged or of another kind/],
    ['other.json', '{"a":1}', /not a Posebeat project/],
    ['newer.posebeat', before.replace('"version":2', '"version":99'), /newer Posebeat/],
    ['many.posebeat', `{"format":"posebeat","version":2,"keyPoses":[${'0,'.repeat(5001)}0]}`, /at most 5000/],
    ['cut.posebeat', Uint8Array.from(whole.slice(0, whole.length / 2)), /damaged or was not copied/],
    ['swapped.posebeat', swapped, /not the song of its project/],
    ['zip.posebeat', zipSync({ 'a.txt': strToU8('a') }), /holds no Posebeat project/],
  ];
  for (const [name, content, message] of files) {
    await openFile(page, name, Buffer.from(content));
    const alert = page.getByRole('alert').filter({ hasText: message });
    await expect(alert).toBeVisible();
    expect(await json(page)).toBe(before);
    await alert.getByRole('button', { name: 'Dismiss' }).click();
  }
  await openFile(
    page,
    'half.posebeat',
    Buffer.from(before.replace('"variation":', '"__proto__":{"x":1},"variation":7,"v":')),
  );
  await expect(page.getByText(/Opened with repairs\. The setting “variation”/)).toBeVisible();
  expect(await page.evaluate(() => ({}) as { x?: number })).toEqual({});
  await page.keyboard.press('Control+z');
  expect(await json(page)).toBe(before);
});

test('a reload and a crash in the middle of editing lose nothing that was saved', async ({ page, context }) => {
  await open(page);
  await loadSong(page, SONG, 'My song.wav');
  await saved(page);
  // No write comes to its end any more, as where a page goes away too quickly: what was done at the last moment is there all the same.
  await page.evaluate(() => {
    IDBTransaction.prototype.commit = function () {
      this.abort();
    };
  });
  await place(page, [1, 3]);
  const first = await json(page);
  await reload(page);
  expect(await json(page)).toBe(first);
  await expect(page.locator('.song-title')).toContainText('My song.wav');

  await place(page, [1, 2, 3]);
  await saved(page);
  const second = await json(page);
  const client = await context.newCDPSession(page);
  const crashed = page.waitForEvent('crash');
  // A page that crashes never answers.
  client.send('Page.crash').catch(() => undefined);
  await crashed;
  const again = await another(context);
  expect(await json(again)).toBe(second);
  await expect(again.locator('.song-title')).toContainText('My song.wav');
  const clock = again.locator('.readout-time');
  const still = await clock.innerText();
  await again.getByRole('button', { name: 'Play', exact: true }).click();
  await expect(clock).not.toHaveText(still);
});

test('songs kept by IndexedDB alone, as in older browsers and by older versions, are found', async ({ page }) => {
  await page.addInitScript(() => {
    Object.defineProperty(StorageManager.prototype, 'getDirectory', { value: undefined });
  });
  await open(page);
  await loadSong(page, SONG, 'Old.wav');
  await place(page, [2]);
  await saved(page);
  await reload(page);
  await expect(page.locator('.song-title')).toContainText('Old.wav');
  expect(await keyCount(page)).toBe(1);
});

test('a full disk is told once, with what to do', async ({ page }) => {
  await page.addInitScript(() => {
    const put = IDBObjectStore.prototype.put;
    IDBObjectStore.prototype.put = function (...given) {
      if (this.name === 'work') throw new DOMException('full', 'QuotaExceededError');
      return put.apply(this, given);
    };
  });
  await open(page);
  await loadSong(page, SONG);
  for (const times of [[1], [1, 2], [1, 2, 3]]) {
    await place(page, times);
    await asIfLeft(page);
  }
  const alert = page.getByRole('alert').filter({ hasText: 'The disk is full' });
  await expect(alert).toHaveCount(1);
  const file = await download(page, () => alert.getByRole('button', { name: 'Save the project' }).click());
  expect(file.name).toMatch(/\.posebeat$/);
});

test('a second tab reads, works here when asked, and neither overwrites the other', async ({ page, context }) => {
  const word = 'This project is open in another tab';
  await open(page);
  await loadSong(page, SONG, 'My song.wav');
  await place(page, [1]);
  await saved(page);
  const second = await another(context);
  await expect(second.getByText(word)).toBeVisible();
  expect(await keyCount(second)).toBe(1);

  // The first goes on; the second takes over and gets what the first had only just done.
  await place(page, [1, 2]);
  await second.getByRole('button', { name: 'Work here' }).click();
  await expect(second.getByText(word)).toBeHidden();
  await expect(page.getByText(word)).toBeVisible();
  await expect.poll(() => keyCount(second)).toBe(2);
  await place(second, [1, 2, 3]);
  await saved(second);

  // Work on both sides: the one that is asked shows its own, the other's lies one step behind.
  await place(page, [4]);
  await asIfLeft(page);
  await saved(second);
  await page.getByRole('button', { name: 'Work here' }).click();
  await expect(page.getByText('Both tabs had changes')).toBeVisible();
  expect(await keyCount(page)).toBe(1);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await expect.poll(() => keyCount(page)).toBe(1);
  await page.keyboard.press('Control+Shift+z');
  expect(await keyCount(page)).toBe(3);
  await saved(page);

  // The one that writes is closed: the other goes on by itself.
  await page.close();
  await expect(second.getByText(word)).toBeHidden();
  await expect.poll(() => keyCount(second)).toBe(3);
});
