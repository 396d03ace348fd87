import { expect, test } from '@playwright/test';
import { collectErrors, fourPoses, loadSong, open, rejection } from './support/page';
import { wav } from './support/songs';
import { serveTinyModel } from './support/tiny';

const SONG = { seconds: 12, tempo: 120 };
const TIMES = [1, 3, 6.5, 9];

test('a song and four key poses give a dance that hits them', async ({ page }) => {
  const errors = collectErrors(page);
  await open(page, '?backend=wasm');
  const song = await loadSong(page, wav(SONG));
  expect(song.duration).toBeCloseTo(12, 1);
  expect(song.tempo).toBeGreaterThan(117);
  expect(song.tempo).toBeLessThan(123);
  for (const beat of song.beats.slice(1, -1))
    expect(Math.abs(beat / 0.5 - Math.round(beat / 0.5)) * 0.5).toBeLessThan(0.07);

  const features = await page.evaluate(() => {
    const { fps, names, data } = window.posebeat.features();
    return { fps, names: [...names], length: data.length, finite: data.every(Number.isFinite) };
  });
  expect(features).toMatchObject({ fps: 30, length: 360 * 15, finite: true });
  expect(features.names).toHaveLength(15);

  const keys = fourPoses().map((rotations, i) => ({ time: TIMES[i], rotations }));
  const run = (keyStrength: number) =>
    page.evaluate(
      async ({ keys, keyStrength }) => {
        window.posebeat.setKeyPoses(keys);
        const result = await window.posebeat.generate({ keyStrength, seed: 1 });
        const motion = window.posebeat.motion();
        return {
          result,
          rotations: [...motion.rotations],
          root: [...motion.root],
          fps: motion.fps,
          report: window.posebeat.report(),
        };
      },
      { keys, keyStrength },
    );

  const exact = await run(1);
  expect(exact.result.frames).toBe(360);
  expect(exact.result.backend).toBe('wasm');
  expect(exact.result.windows).toBeGreaterThan(1);
  expect(exact.rotations).toHaveLength(360 * 72);
  for (const { time, rotations } of keys) {
    const frame = exact.rotations.slice(time * 30 * 72, (time * 30 + 1) * 72);
    rotations.forEach((angle, i) => expect(Math.abs(frame[i] - angle)).toBeLessThan(1e-3));
  }
  expect(exact.report.consistencyError).toBeLessThan(1e-6);

  const free = await run(0);
  expect(free.report.consistencyError).toBeGreaterThan(1e-6);
  expect(free.report.consistencyError).toBeLessThan(0.3);
  expect(errors).toEqual([]);
});

test('the same seed gives the same dance, another seed another', async ({ page }) => {
  await serveTinyModel(page);
  await open(page, '?backend=wasm');
  await loadSong(page, wav({ seconds: 8 }));
  const dance = (seed: number) =>
    page.evaluate(async (seed) => {
      window.posebeat.setKeyPoses([]);
      await window.posebeat.generate({ seed, variation: 0.5 });
      return [...window.posebeat.motion().rotations];
    }, seed);
  const first = await dance(3);
  const again = await dance(3);
  const other = await dance(4);
  expect(again).toEqual(first);
  const difference = first.reduce((sum, angle, i) => sum + Math.abs(angle - other[i]), 0) / first.length;
  expect(difference).toBeGreaterThan(0.01);
});

test('rejected input says why and leaves the document as it was', async ({ page }) => {
  await open(page);
  await loadSong(page, wav({ seconds: 4 }));
  const rotations = fourPoses()[0];
  await page.evaluate((rotations) => window.posebeat.setKeyPoses([{ time: 1, rotations }]), rotations);
  const before = await page.evaluate(() => JSON.stringify(window.posebeat.document()));
  const attempt = (keys: unknown) =>
    rejection(page.evaluate((keys) => window.posebeat.setKeyPoses(keys as never), keys));
  expect(await attempt([{ time: 1, rotations: [1, 2, 3] }])).toMatch(/72|24/);
  expect(await attempt([{ time: -1, rotations }])).toMatch(/time/i);
  expect(await attempt([{ time: 400, rotations }])).toMatch(/time|song/i);
  expect(await attempt([{ time: 1, rotations: rotations.map(() => 'x') }])).toMatch(/number/i);
  expect(await attempt('nothing')).toMatch(/array|list/i);
  expect(await page.evaluate(() => JSON.stringify(window.posebeat.document()))).toBe(before);
});

test('the demo’s own song can be loaded while the demo’s sound is still on its way', async ({ page }) => {
  await open(page);
  const { duration } = await page.evaluate(async () => {
    const file = new File([await (await fetch('demo/song.mp3')).blob()], 'again.mp3', { type: 'audio/mpeg' });
    return window.posebeat.loadSong(file);
  });
  expect(duration).toBeGreaterThan(55);
});

test('an engine or a format that does not exist is refused by name, and the document stays', async ({ page }) => {
  await open(page);
  const before = await page.evaluate(() => JSON.stringify(window.posebeat.document()));
  expect(await rejection(page.evaluate(() => window.posebeat.generate({ engine: 'magic' as never })))).toMatch(
    /no engine "magic": use "light" or "curves"/,
  );
  expect(await rejection(page.evaluate(() => window.posebeat.exportAs('obj' as never)))).toMatch(/"obj"/);
  expect(await page.evaluate(() => JSON.stringify(window.posebeat.document()))).toBe(before);
});
