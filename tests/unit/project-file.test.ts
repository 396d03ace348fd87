import { deflateSync, inflateSync, zipSync, type Zippable } from 'fflate';
import { describe, expect, it } from 'vitest';
import { createDocument, POSE_SIZE } from '../../web/core/document';
import { readProject, writeProject } from '../../web/core/formats/project-file';
import { crc32, zipEntries } from '../../web/core/formats/zip-read';

const song = { name: 'My Song.MP3', hash: 'ab', duration: 10 };
const rotations = Array.from({ length: POSE_SIZE }, (_, i) => Math.sin(i) / 3);
const document = { ...createDocument(song), keyPoses: [{ id: 'k1', time: 1, rotations, name: 'Étoile' }] };
/** As if it were music: nothing in it repeats. */
const noise = (size: number) => {
  let state = 1;
  return Uint8Array.from({ length: size }, () => (state = (state * 48271) % 2147483647) & 255);
};
const text = (value: unknown) => new TextEncoder().encode(JSON.stringify(value));
const zip = (files: Zippable) => zipSync(files);
/** A changed copy. */
const patched = (bytes: Uint8Array, change: (view: DataView) => void) => {
  const copy = bytes.slice();
  change(new DataView(copy.buffer));
  return copy;
};
/** Where the first central directory entry begins. */
const directory = (bytes: Uint8Array) => new DataView(bytes.buffer).getUint32(bytes.length - 22 + 16, true);

describe('a project file', () => {
  it('without its song is readable JSON', () => {
    const bytes = writeProject(document);
    expect(JSON.parse(new TextDecoder().decode(bytes))).toEqual(document);
    expect(readProject(bytes)).toEqual({ document, repairs: [], motion: null, song: null });
  });

  it('says which dance it had, and does not believe nonsense about that', () => {
    const motion = { motionHash: 'ab'.repeat(32), model: 'light (q6)', backend: 'wasm' };
    for (const song of [null, noise(100)]) {
      const read = readProject(writeProject(document, song, motion));
      expect(read.motion).toEqual(motion);
      expect(read.document).toEqual(document);
    }
    for (const wrong of [5, null, {}, { ...motion, motionHash: 'x'.repeat(500) }, { ...motion, model: 3 }]) {
      expect(readProject(text({ ...document, motion: wrong }))).toMatchObject({ document, motion: null, repairs: [] });
    }
  });

  it('with its song brings both back, the song’s bytes untouched and unpacked', () => {
    const bytes = noise(50_000);
    const file = writeProject(document, bytes);
    const read = readProject(file);
    expect(read.document).toEqual(document);
    expect(read.repairs).toEqual([]);
    expect(read.song).toEqual(bytes);
    expect(zipEntries(file).map((entry) => entry.name)).toEqual(['project.json', 'song.mp3']);
    expect(file.length).toBeLessThan(bytes.length + 3000);
  });

  it('is the same bytes whenever it is saved', () => {
    expect(writeProject(document, noise(100))).toEqual(writeProject(document, noise(100)));
  });

  it('of version 1 opens, packed again by another program or not', () => {
    const { format, grid, keyPoses, dials } = document;
    const first = { format, version: 1, song, grid, keyPoses, dials };
    expect(readProject(text(first)).document).toEqual(document);
    const other = zip({
      'song.mp3': [noise(999), { level: 9 }],
      'project.json': text(first),
      'notes/readme.txt': text('hi'),
    });
    expect(readProject(other)).toEqual({ document, repairs: [], motion: null, song: noise(999) });
  });

  it('does not care for names that lead elsewhere', () => {
    const file = zip({ '../../project.json': text({}), '/song.mp3': noise(5), 'project.json': text(document) });
    expect(readProject(file)).toEqual({ document, repairs: [], motion: null, song: null });
  });

  it('keeps hostile keys out of every prototype', () => {
    const json = JSON.stringify(document).replace(
      '"keyPoses":[{',
      '"__proto__":{"polluted":1},"constructor":{"prototype":{"polluted":1}},"keyPoses":[{"__proto__":{"locked":true},',
    );
    const read = readProject(new TextEncoder().encode(json)).document;
    expect(({} as Record<string, unknown>).polluted).toBeUndefined();
    expect(Object.getPrototypeOf(read)).toBe(Object.prototype);
    expect(read.keyPoses[0].locked).toBeUndefined();
    expect(Object.keys(read)).toEqual(Object.keys(document));
  });
});

describe('no project file', () => {
  const whole = writeProject(document, noise(4000));
  const bomb = text({ ...document, padding: 'a'.repeat(5_000_000) });
  it.each<[string, Uint8Array, RegExp]>([
    ['an empty file', new Uint8Array(), /empty/],
    ['a song', noise(5000), /damaged or of another kind/],
    ['text', new TextEncoder().encode('hello'), /damaged or of another kind/],
    ['a list', text([]), /not a Posebeat project/],
    ['other JSON', text({ name: 'x' }), /not a Posebeat project/],
    ['a newer one', text({ ...document, version: 3 }), /newer Posebeat/],
    ['a newer one in a zip', zip({ 'project.json': text({ ...document, version: 3 }) }), /newer Posebeat/],
    ['one without a version', text({ format: 'posebeat' }), /no version/],
    ['another zip', zip({ 'word/document.xml': text('x') }), /holds no Posebeat project/],
    ['a zip with two songs', zip({ 'project.json': text(document), song: noise(3), 'song.ogg': noise(3) }), /two/],
    ['a zip of damaged JSON', zip({ 'project.json': new TextEncoder().encode('{"format":') }), /damaged/],
    ['a zip cut in the middle', whole.slice(0, 2500), /damaged or was not copied/],
    ['a zip without its last byte', whole.slice(0, -1), /damaged or was not copied/],
    [
      'a zip with a bad byte in the song',
      patched(whole, (view) => view.setUint8(3000, view.getUint8(3000) ^ 1)),
      /damaged/,
    ],
    [
      'a zip whose directory points nowhere',
      patched(whole, (view) => view.setUint32(whole.length - 6, 9, true)),
      /damaged/,
    ],
    [
      'a zip of very many files',
      patched(whole, (view) => view.setUint16(whole.length - 12, 60_000, true)),
      /60000 parts/,
    ],
    [
      'a way of packing we do not know',
      patched(whole, (view) => view.setUint16(directory(whole) + 10, 14, true)),
      /plain zip/,
    ],
    [
      'a bomb that says how large it is',
      patched(whole, (view) => view.setUint32(directory(whole) + 24, 4e9, true)),
      /larger than 50 MB/,
    ],
    [
      'a bomb that lies about its size',
      patched(zip({ 'project.json': bomb }), (view) =>
        view.setUint32(directory(zip({ 'project.json': bomb })) + 24, 1000, true),
      ),
      /damaged/,
    ],
  ])('%s is refused in a sentence', (_name, bytes, message) => {
    expect(() => readProject(bytes)).toThrow(message);
    try {
      readProject(bytes);
    } catch (error) {
      expect((error as Error).message).toMatch(/^[A-Z].*[.!]$/);
    }
  });

  it('is not inflated beyond what it claims: 100 MB of zeros cost next to nothing', () => {
    const packed = deflateSync(new Uint8Array(100e6));
    const template = zip({ 'project.json': [new Uint8Array(0), { level: 0 }] });
    const local = 30 + 'project.json'.length;
    const file = new Uint8Array(template.length + packed.length);
    file.set(template.subarray(0, local));
    file.set(packed, local);
    file.set(template.subarray(local), local + packed.length);
    const view = new DataView(file.buffer);
    const start = local + packed.length;
    view.setUint16(start + 10, 8, true);
    view.setUint32(start + 20, packed.length, true);
    view.setUint32(start + 24, 2000, true);
    view.setUint32(file.length - 6, start, true);
    const took = (run: () => unknown) => {
      const before = performance.now();
      run();
      return performance.now() - before;
    };
    const refused = took(() => expect(() => readProject(file)).toThrow(/damaged/));
    expect(refused).toBeLessThan(took(() => inflateSync(packed)) / 2);
  });
});

describe('crc32', () => {
  it('is the check value of the standard', () => {
    expect(crc32(new TextEncoder().encode('123456789'))).toBe(0xcbf43926);
  });
});
