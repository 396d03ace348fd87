/** The dance as a video: made through the page, then read by other programs. */
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import AxeBuilder from '@axe-core/playwright';
import { expect, test, type Page } from '@playwright/test';
import { ALL_FORMATS, BufferSource, EncodedPacketSink, Input } from 'mediabunny';
import { collectErrors, fourPoses, open, rejection } from './support/page';

// Without a graphics card every pixel costs.
test.use({ viewport: { width: 640, height: 640 } });
test.setTimeout(300_000);

const FPS = 30;
/** The part of the demo that is filmed: 2 seconds, in the middle of a bar and of a packet of sound. */
const PART = { start: 4.31, end: 6.31 };
const SONG = 'public/demo/song.mp3';

const has = (program: string) => spawnSync(program, ['-version']).status === 0;
const panel = (page: Page) => page.getByRole('dialog', { name: 'Save as a video' });
const bar = (page: Page) => page.getByRole('progressbar', { name: 'Making the video' });

/** The demo, standing still, with a part of it as the selected stretch and the panel open. */
async function openPanel(page: Page, part = PART): Promise<void> {
  await open(page);
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.evaluate(
    ([poses, times]) => window.posebeat.setKeyPoses(times.map((time, i) => ({ time, rotations: poses[i] }))),
    [fourPoses(), [part.start, part.end]] as const,
  );
  await page.keyboard.press('Control+a');
  await page.keyboard.press('l');
  await page.keyboard.press('Control+Shift+E');
  await expect(panel(page)).toBeVisible();
}

async function chooseSmall(page: Page): Promise<void> {
  await openPanel(page);
  await panel(page).getByLabel('Size').selectOption('180');
  await panel(page).getByText('Selected stretch').click();
}

/** What our own container library finds in a file: codecs, frames and when they begin and end, seconds. */
async function inside(bytes: Buffer) {
  const input = new Input({ source: new BufferSource(bytes), formats: ALL_FORMATS });
  const [video, audio] = [(await input.getPrimaryVideoTrack())!, (await input.getPrimaryAudioTrack())!];
  const times: number[] = [];
  for await (const packet of new EncodedPacketSink(video).packets()) times.push(packet.timestamp);
  return {
    size: [await video.getDisplayWidth(), await video.getDisplayHeight()],
    times: times.sort((a, b) => a - b),
    videoEnd: await video.computeDuration(),
    audioStart: await audio.getFirstTimestamp(),
    audioEnd: await audio.computeDuration(),
  };
}

/** The same by ffprobe. */
function probed(file: string) {
  const args = ['-v', 'error', '-count_frames', '-show_streams', '-show_format', '-of', 'json', file];
  const { streams, format } = JSON.parse(spawnSync('ffprobe', args, { encoding: 'utf8' }).stdout);
  const stream = (type: string) => streams.find((each: { codec_type: string }) => each.codec_type === type);
  return { video: stream('video'), audio: stream('audio'), duration: Number(format.duration) };
}

/** Seconds by which the sound of a file lags behind the song's own, by where the two are most alike. */
function lag(file: string, start: number): number {
  const rate = 16_000;
  const samples = (name: string) => {
    const args = ['-v', 'error', '-i', name, '-f', 'f32le', '-ac', '1', '-ar', String(rate), '-'];
    const { buffer, byteOffset, length } = spawnSync('ffmpeg', args, { maxBuffer: 2 ** 28 }).stdout;
    return new Float32Array(buffer.slice(byteOffset, byteOffset + length - (length % 4)));
  };
  const [film, song] = [samples(file), samples(SONG)];
  const [from, to, first] = [rate * 0.25, rate * 1.75, Math.round(start * rate)];
  let best = { score: -Infinity, shift: 0 };
  for (let shift = -rate / 20; shift <= rate / 20; shift++) {
    let score = 0;
    for (let i = from; i < to; i++) score += film[i] * song[first + i - shift];
    if (score > best.score) best = { score, shift };
  }
  return best.shift / rate;
}

test('a video of the selected stretch has every frame and its sound, and begins with both', async ({ page }) => {
  const errors = collectErrors(page);
  const scripts: string[] = [];
  page.on('request', (request) => scripts.push(request.url()));
  await page.addInitScript(() => Reflect.deleteProperty(window, 'showSaveFilePicker'));
  await open(page);
  expect(scripts.filter((url) => /video/.test(url))).toEqual([]);
  await chooseSmall(page);
  await expect(panel(page)).toContainText('320 × 180, 60 frames');
  await panel(page).getByText('Beat cuts').click();
  const before = await page.evaluate(() => JSON.stringify(window.posebeat.document()));
  const [download] = await Promise.all([
    page.waitForEvent('download', { timeout: 240_000 }),
    panel(page).getByRole('button', { name: 'Save MP4' }).click(),
  ]);
  expect(download.suggestedFilename()).toMatch(/\.mp4$/);
  const file = test.info().outputPath('dance.mp4');
  await download.saveAs(file);
  await expect(page.getByText(/\.mp4 is saved/)).toBeVisible();
  expect(await page.evaluate(() => JSON.stringify(window.posebeat.document()))).toBe(before);

  const found = await inside(readFileSync(file));
  expect(found.size).toEqual([320, 180]);
  expect(found.times).toHaveLength(60);
  found.times.forEach((time, i) => expect(time).toBeCloseTo(i / FPS, 3));
  expect(found.videoEnd).toBeCloseTo(2, 2);
  expect(Math.abs(found.audioStart)).toBeLessThan(1 / FPS);
  expect(Math.abs(found.audioEnd - 2)).toBeLessThan(1 / FPS);
  expect(errors).toEqual([]);

  await test.step('ffprobe and ffmpeg agree', () => {
    if (!has('ffprobe') || !has('ffmpeg')) {
      const description = 'ffprobe and ffmpeg are not installed: only our own reader looked at the file';
      test.info().annotations.push({ type: 'left out', description });
      console.log(`      ${description}`);
      return;
    }
    const { video, audio, duration } = probed(file);
    expect(Number(video.nb_read_frames)).toBe(60);
    expect([video.width, video.height, video.r_frame_rate]).toEqual([320, 180, '30/1']);
    expect(Math.abs(duration - 2)).toBeLessThan(1 / FPS);
    expect(Math.abs(Number(video.start_time) - Number(audio.start_time))).toBeLessThan(1 / FPS);
    // MP3 readers differ by some milliseconds themselves.
    expect(Math.abs(lag(file, PART.start))).toBeLessThan(1 / FPS / 2);
  });
});

test('a video goes straight to the disk; a cancelled one leaves nothing there', async ({ page }) => {
  await page.addInitScript(() => {
    const ask = async (options: { suggestedName: string }) => {
      const folder = await navigator.storage.getDirectory();
      return folder.getFileHandle(options.suggestedName, { create: true });
    };
    Object.assign(window, { showSaveFilePicker: ask });
  });
  await chooseSmall(page);
  const bytes = () =>
    page.evaluate(async () => {
      const folder = await navigator.storage.getDirectory();
      const files: Record<string, string> = {};
      for await (const [name, handle] of folder.entries()) {
        const buffer = await (await (handle as FileSystemFileHandle).getFile()).arrayBuffer();
        files[name] = Array.from(new Uint8Array(buffer), (byte) => String.fromCharCode(byte)).join('');
      }
      return files;
    });
  const save = panel(page).getByRole('button', { name: /^Save (MP4|WebM)$/ });

  await save.click();
  await expect(bar(page)).toHaveAttribute('aria-valuenow', /^[1-9]/);
  // The keyboard goes where the pressed button was.
  await expect(panel(page).getByRole('button', { name: 'Cancel the video' })).toBeFocused();
  await page.keyboard.press('Enter');
  await expect(save).toBeEnabled();
  expect(Object.values(await bytes())).toEqual(['']);

  await panel(page).getByText('WebM', { exact: true }).click();
  await save.click();
  // The panel may be closed meanwhile: what is being done stays in sight.
  await page.keyboard.press('Escape');
  await expect(page.locator('.video-chip')).toContainText('Making the video');
  expect((await page.locator('.video-chip').boundingBox())!.height).toBeLessThan(64);
  await expect(page.getByText(/\.webm is saved/)).toBeVisible({ timeout: 240_000 });
  const [, file] = Object.entries(await bytes()).find(([name]) => name.endsWith('.webm'))!;
  const found = await inside(Buffer.from(file, 'latin1'));
  expect(found.times).toHaveLength(60);
  expect(Math.abs(found.audioStart)).toBeLessThan(1 / FPS);
  expect(Math.abs(found.audioEnd - 2)).toBeLessThan(1 / FPS);
});

/** A PNG that the page made: its size, how much of it is drawn on, and how bright that is, all of it 0..1. */
async function looked(page: Page, call: string) {
  return page.evaluate(async (source) => {
    const blob = (await new Function(`return window.posebeat.${source}`)()) as Blob;
    const picture = await createImageBitmap(blob);
    const canvas = new OffscreenCanvas(picture.width, picture.height);
    const brush = canvas.getContext('2d')!;
    brush.drawImage(picture, 0, 0);
    const { data } = brush.getImageData(0, 0, picture.width, picture.height);
    let [drawn, light] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] < 128) continue;
      drawn++;
      light += (data[i] + data[i + 1] + data[i + 2]) / 765;
    }
    const size = [picture.width, picture.height];
    return { type: blob.type, size, corner: data[3], drawn: drawn / (data.length / 4), light: light / drawn };
  }, call);
}

/** A picture drawn in strips beside the same drawn at once: largest difference of 255 levels, and the share of pixels with more than one. */
const inStrips = (page: Page, background: string) =>
  page.evaluate(async (background) => {
    const { postMessage } = Worker.prototype;
    const pixels = async (rows: number, onProgress?: (done: number) => void) => {
      Worker.prototype.postMessage = function (this: Worker, message: object, ...rest: never[]) {
        postMessage.call(this, 'request' in message ? { ...message, rows } : message, ...rest);
      };
      const blob = await window.posebeat.exportPicture({ size: 180, background, onProgress });
      Worker.prototype.postMessage = postMessage;
      const image = await createImageBitmap(blob);
      const brush = new OffscreenCanvas(image.width, image.height).getContext('2d')!;
      brush.drawImage(image, 0, 0);
      return brush.getImageData(0, 0, image.width, image.height).data;
    };
    const progress: number[] = [];
    const strips = await pixels(34, (done) => progress.push(done));
    const whole = await pixels(180);
    const apart = whole.map((value, i) => Math.abs(value - strips[i]));
    const differ = apart.reduce((count, value) => count + Number(value > 1), 0);
    return {
      bytes: [strips.length, whole.length],
      most: apart.reduce((a, b) => Math.max(a, b)),
      share: differ / apart.length,
      progress,
    };
  }, background);

/**
 * What the browser itself finds in a GIF; and how far its first and its last picture are from the same moment as a still, and from the
 * other's, levels of 255.
 */
const inGif = (page: Page, bytes: Buffer, start: number) =>
  page.evaluate(
    async ({ base64, start }) => {
      const data = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
      const decoder = new ImageDecoder({ data, type: 'image/gif' });
      await Promise.all([decoder.completed, decoder.tracks.ready]);
      const { frameCount, repetitionCount } = decoder.tracks.selectedTrack!;
      const brush = new OffscreenCanvas(96, 96).getContext('2d', { willReadFrequently: true })!;
      const small = (image: CanvasImageSource) => {
        brush.drawImage(image, 0, 0, 96, 96);
        return brush.getImageData(0, 0, 96, 96).data;
      };
      const sizes = new Set<string>();
      const delays = new Set<number>();
      const pictures: Uint8ClampedArray[] = [];
      for (let frameIndex = 0; frameIndex < frameCount; frameIndex++) {
        const { image } = await decoder.decode({ frameIndex });
        sizes.add(`${image.displayWidth} x ${image.displayHeight}`);
        delays.add(image.duration! / 1000);
        pictures.push(small(image));
        image.close();
      }
      const stills: Uint8ClampedArray[] = [];
      for (const frame of [0, frameCount - 1]) {
        const options = { size: 360, aspect: '1:1', camera: 'follow', time: start + frame * 0.06 } as const;
        stills.push(small(await createImageBitmap(await window.posebeat.exportPicture(options))));
      }
      const apart = (a: Uint8ClampedArray, b: Uint8ClampedArray) =>
        a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;
      return {
        frameCount,
        endless: repetitionCount === Infinity,
        sizes: [...sizes],
        delays: [...delays],
        apart: [
          [apart(pictures[0], stills[0]), apart(pictures[0], stills[1])],
          [apart(pictures[frameCount - 1], stills[1]), apart(pictures[frameCount - 1], stills[0])],
        ],
      };
    },
    { base64: bytes.toString('base64'), start },
  );

test('pictures: the stage, transparent, in another style, and all key poses on a sheet', async ({ page }) => {
  const errors = collectErrors(page);
  const part = { start: 4.3, end: 4.6 };
  await openPanel(page, part);
  await page.keyboard.press('Escape');
  const stage = await inStrips(page, 'stage');
  expect(stage.bytes).toEqual([320 * 180 * 4, 320 * 180 * 4]);
  // The grain of soft shadows falls otherwise.
  expect(stage.share).toBeLessThan(0.005);
  const { progress } = stage;
  expect(progress.length).toBeGreaterThan(6);
  expect(progress).toEqual([...new Set(progress)].sort((a, b) => a - b));
  expect(progress.at(-1)).toBe(1);

  const cutOut = `exportPicture({ size: 180, aspect: '9:16', background: 'none', camera: 'front' })`;
  const studio = await looked(page, cutOut);
  expect(studio).toMatchObject({ type: 'image/png', size: [180, 320], corner: 0 });
  expect(studio.drawn).toBeGreaterThan(0.05);
  expect(studio.drawn).toBeLessThan(0.6);

  await page.getByRole('tab', { name: 'Dance' }).click();
  await page.locator('.figure-fold summary').click();
  // By keyboard, as radio buttons go: the last style is before the first.
  await page.getByRole('radio', { name: 'Studio' }).focus();
  await page.keyboard.press('ArrowLeft');
  await expect(page.getByRole('radio', { name: 'Neon' })).toBeChecked();
  expect(await page.evaluate(() => window.posebeat.document().look)).toEqual({ style: 'neon', colours: 'sky' });
  const neon = await looked(page, cutOut);
  expect(Math.abs(neon.drawn - studio.drawn)).toBeLessThan(0.02);
  expect(neon.light).toBeLessThan(studio.light * 0.8);
  // In this style nothing has shadows: all of it is the same, the edges too.
  expect((await inStrips(page, '#00b140')).most).toBeLessThanOrEqual(1);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.getByRole('radio', { name: 'Studio' })).toBeChecked();

  await page.keyboard.press('Control+Shift+E');
  await page.getByRole('radio', { name: 'Video', exact: true }).focus();
  await page.keyboard.press('ArrowRight');
  const still = page.getByRole('dialog', { name: 'Save a picture' });
  await expect(still.getByRole('img')).toBeVisible({ timeout: 60_000 });
  await page.keyboard.press('ArrowRight');
  const sheet = page.getByRole('dialog', { name: 'Key poses as a picture' });
  await expect(sheet.getByRole('img', { name: 'Contact sheet of 2 key poses' })).toBeVisible({ timeout: 60_000 });
  const { violations } = await new AxeBuilder({ page }).include('.video-panel').analyze();
  expect(violations.map(({ id }) => id)).toEqual([]);
  const [download] = await Promise.all([
    page.waitForEvent('download', { timeout: 120_000 }),
    sheet.getByRole('button', { name: 'Save PNG' }).click(),
  ]);
  expect(download.suggestedFilename()).toMatch(/ key poses\.png$/);
  const file = readFileSync(await download.path());
  // Width and height stand in the first chunk of a PNG.
  expect([file.readUInt32BE(16), file.readUInt32BE(20) > 500]).toEqual([2400, true]);

  const loop = page.evaluate(() => window.posebeat.exportLoop({ signal: AbortSignal.timeout(300) }));
  expect(await rejection(loop)).toMatch(/abort|time/i);
  const large = page.evaluate(() => {
    const stop = new AbortController();
    const onProgress = (done: number) => done > 0.1 && stop.abort(new Error(`Stopped at ${done < 0.3}`));
    return window.posebeat.exportPicture({ size: 2160, onProgress, signal: stop.signal });
  });
  expect(await rejection(large)).toContain('Stopped at true');
  await page.evaluate(() => window.posebeat.setKeyPoses([]));
  await expect(sheet).toContainText('There are no key poses yet');

  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Save the project' }).click();
  await page.getByRole('button', { name: /Share as a link/ }).click();
  const [moving] = await Promise.all([
    page.waitForEvent('download', { timeout: 120_000 }),
    page.getByRole('button', { name: 'Save a moving preview' }).click(),
  ]);
  expect(moving.suggestedFilename()).toMatch(/\.gif$/);
  const gif = await inGif(page, readFileSync(await moving.path()), part.start);
  expect(gif).toMatchObject({ frameCount: 5, endless: true, sizes: ['480 x 480'], delays: [60] });
  for (const [own, other] of gif.apart) {
    expect(own).toBeLessThan(6);
    expect(own).toBeLessThan(0.8 * other);
  }
  expect(errors).toEqual([]);
});

test.describe('a browser without', () => {
  /** The worker's script with a line before it. */
  const without = async (page: Page, line: string) => {
    await page.route(/video\.worker.*\.js/, async (route) => {
      const response = await route.fetch();
      await route.fulfill({ response, body: `${line}\n${await response.text()}` });
    });
    await openPanel(page);
  };

  test('video encoders says so and offers other files', async ({ page }) => {
    await without(page, 'self.VideoEncoder = undefined; delete self.VideoEncoder;');
    await expect(panel(page)).toContainText('has no video encoder');
    const call = page.evaluate(() => window.posebeat.exportVideo({ range: { start: 4, end: 4.1 }, size: 180 }));
    expect(await rejection(call)).toContain('has no video encoder');
    await panel(page).getByRole('button', { name: 'Other files' }).click();
    await expect(page.getByRole('dialog', { name: 'Export the dance' })).toBeVisible();
  });

  test('sound encoders says that the video is silent; wrong options are refused', async ({ page }) => {
    await without(page, 'self.AudioEncoder = undefined; delete self.AudioEncoder;');
    await expect(panel(page)).toContainText('has no sound encoder, so the video is silent');
    await expect(panel(page).getByRole('button', { name: 'Save MP4' })).toBeEnabled();
    const { violations } = await new AxeBuilder({ page }).include('.video-panel').analyze();
    expect(violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target).join(', ')}`)).toEqual([]);
    const refused = (options: object) => rejection(page.evaluate((each) => window.posebeat.exportVideo(each), options));
    expect(await refused({ size: 700 })).toContain('size must be one of');
    expect(await refused({ range: { start: 70, end: 80 } })).toContain('inside the dance');
    expect(await refused({ range: 'trim' })).toContain('not trimmed');
  });
});
