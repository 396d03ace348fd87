import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { expect, test, type Page } from '@playwright/test';
import { loadSong, open, rejection } from './support/page';
import { wav } from './support/songs';

const fixture = (name: string) => readFileSync(join(import.meta.dirname, 'fixtures', name));

const FORMATS = [
  ['mp3', 'audio/mpeg'],
  ['ogg', 'audio/ogg'],
  ['flac', 'audio/flac'],
  ['m4a', 'audio/mp4'],
];

// One page for all of them: what a song leaves behind must not disturb the next.
test.describe.configure({ mode: 'serial' });
let page: Page;
test.beforeAll(async ({ browser }) => {
  page = await browser.newPage();
  await open(page);
});
test.afterAll(() => page.close());

for (const [extension, type] of FORMATS) {
  test(`${extension} songs are decoded and their beats found`, async () => {
    const song = await loadSong(page, fixture(`song.${extension}`), `song.${extension}`, type);
    expect(Math.abs(song.duration - 6)).toBeLessThan(0.2);
    expect(Math.abs(song.tempo - 120)).toBeLessThan(4);
    expect(song.downbeats.length).toBeGreaterThan(0);
  });
}

for (const [sampleRate, channels] of [
  [8000, 1],
  [22050, 2],
  [48000, 2],
  [96000, 1],
] as const) {
  test(`wav at ${sampleRate} Hz, ${channels} channel(s)`, async () => {
    const song = await loadSong(page, wav({ seconds: 6, sampleRate, channels }));
    expect(song.duration).toBeCloseTo(6, 1);
    expect(Math.abs(song.tempo - 120)).toBeLessThan(4);
  });
}

const BAD: [string, Buffer, string, RegExp][] = [
  ['a text file', Buffer.from('This is not a song at all. '.repeat(40)), 'notes.mp3', /audio|song/i],
  [
    'a picture',
    Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]), Buffer.alloc(500)]),
    'x.png',
    /audio|picture|image/i,
  ],
  ['an empty file', Buffer.alloc(0), 'empty.wav', /empty/i],
  ['a truncated file', fixture('song.m4a').subarray(0, 900), 'cut.m4a', /damaged|incomplete|truncated|cut/i],
  ['silence', wav({ seconds: 3, level: 0 }), 'silence.wav', /silen/i],
  ['0.2 s of sound', wav({ seconds: 0.2 }), 'blip.wav', /at least 1 second/i],
];

for (const [what, bytes, name, expected] of BAD) {
  test(`${what} gives a clear message and nothing is lost`, async () => {
    const before = await page.evaluate(() => JSON.stringify(window.posebeat.document()));
    expect(await rejection(loadSong(page, bytes, name))).toMatch(expected);
    expect(await page.evaluate(() => JSON.stringify(window.posebeat.document()))).toBe(before);
  });
}
