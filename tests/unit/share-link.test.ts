import { readFileSync } from 'node:fs';
import { deflateSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { createDocument, type ProjectDocument } from '../../web/core/document';
import { isLink, readLink, writeLink } from '../../web/core/formats/share-link';
import { crc32 } from '../../web/core/formats/zip-read';
import type { LibraryPose } from '../../web/core/types';

const library = (
  JSON.parse(readFileSync(new URL('../../public/library/poses.json', import.meta.url), 'utf8')) as {
    poses: LibraryPose[];
  }
).poses;

/** A three-minute song of the visitor's own with an edited grid and this many poses from all over the library, all different. */
function project(poses: number): ProjectDocument {
  const beats = Array.from({ length: 380 }, (_, i) => Math.round((0.213 + (i * 60) / 127.3) * 1e6) / 1e6);
  const chosen = Array.from({ length: poses }, (_, i) => library[Math.floor((i * library.length) / poses)]);
  return {
    ...createDocument({
      name: 'Some Artist - A Song With a Long Name.mp3',
      hash: '21c5'.repeat(16),
      duration: 183.4567891,
    }),
    trim: { start: 1.5, end: 100.25 },
    grid: { tempo: 127.3, beatsPerBar: 4, beats, downbeats: beats.filter((_, i) => i % 4 === 2) },
    keyPoses: chosen.map(({ name, rotations }, i) => ({ id: `k${i + 1}`, time: beats[4 + i * 8], name, rotations })),
    ranges: [
      {
        id: 'r1',
        start: 10,
        end: 20,
        takes: [
          { id: 't1', seed: 123456, variation: 0.3 },
          { id: 't2', seed: 99999999, variation: 0.7 },
        ],
        chosen: 't2',
      },
    ],
  };
}

/** A link around bytes, its checksum right. */
function sealed(packed: Uint8Array): string {
  const sum = Buffer.alloc(4);
  sum.writeUInt32LE(crc32(packed));
  return `#d=1.${Buffer.concat([sum, packed]).toString('base64url')}`;
}

describe('a link', () => {
  it('with 16 varied poses of the library and an edited grid stays under 2,000 characters', () => {
    const link = writeLink(project(16), 'light (q6)');
    expect(link.length).toBeLessThan(2000);
    expect(link).toMatch(/^#d=1\.[A-Za-z0-9_-]+$/);
    const read = readLink(link);
    expect(read.repairs).toEqual([]);
    expect(read.document.keyPoses.map(({ name, time }) => [name, time])).toEqual(
      project(16).keyPoses.map(({ name, time }) => [name, time]),
    );
    expect(read.document.grid).toEqual(project(16).grid);
  });

  it('holds the beats of a regular grid in next to nothing', () => {
    const without = writeLink({ ...project(0), grid: null }).length;
    expect(writeLink(project(0)).length - without).toBeLessThan(60);
  });

  it('does not grow by a pose that comes again', () => {
    const [first] = project(16).keyPoses;
    const often = Array.from({ length: 16 }, (_, i) => ({ ...first, id: `k${i + 1}`, time: i }));
    const once = writeLink({ ...project(16), keyPoses: [first] }).length;
    expect(writeLink({ ...project(16), keyPoses: often }).length).toBeLessThan(once + 50);
  });

  it('leaves out where the song came from and the camera', () => {
    const document = project(2);
    const camera = { follows: true, position: [1, 2, 3], target: [0, 1, 0] } as const;
    const song = { ...document.song!, url: 'https://example.org/secret?token=1' };
    const read = readLink(writeLink({ ...document, song, camera: structuredClone(camera) as never })).document;
    expect(read.song).toEqual(document.song);
    expect(read.camera).toBeNull();
  });

  it('opens with marks that a message put after it', () => {
    const link = writeLink(project(3));
    for (const after of ['.', ')', ').', '"', '>', ' ', '&utm_source=x', '%20']) {
      expect(readLink(link + after).document.keyPoses).toHaveLength(3);
    }
    expect(readLink(link.slice(1)).document.keyPoses).toHaveLength(3);
  });

  it('keeps changed curves, the engine and the figure', () => {
    const curveEdits = [{ from: 'k1', to: 4.25, track: 'left_elbow', tension: 0.3 }];
    const document = { ...project(2), engine: 'curves' as const, curveEdits, avatar: 'someone' };
    expect(readLink(writeLink(document)).document).toMatchObject({ engine: 'curves', curveEdits, avatar: 'someone' });
  });
});

describe('what is no link', () => {
  const damaged = 'This link is damaged or was not copied completely: copy it again, whole.';

  it('is told from one', () => {
    expect(['#d=1.abc', '#d=', 'd=2.'].map(isLink)).toEqual([true, true, true]);
    expect(['', '#', '#help', '#dance=1'].map(isLink)).toEqual([false, false, false, false]);
  });

  it('cut off, changed or empty is refused', () => {
    const link = writeLink(project(3));
    for (const text of [
      '#d=',
      '#d=1',
      '#d=1.',
      '#d=1.A',
      '#d=0.AAAA',
      link.slice(0, -1),
      link.slice(0, 60),
      `${link}A`,
    ]) {
      expect(() => readLink(text)).toThrow(damaged);
    }
    expect(() => readLink(link.replace(/.{3}$/, 'xyz'))).toThrow(damaged);
  });

  it('of a newer version says so', () => {
    expect(() => readLink('#d=2.AAAA')).toThrow('newer Posebeat: reload the page');
  });

  it('that is endless, or unpacks without end, costs neither time nor memory', () => {
    expect(() => readLink(`#d=1.${'A'.repeat(5_000_000)}`)).toThrow('too long');
    const bomb = sealed(deflateSync(new Uint8Array(50_000_000), { level: 9 }));
    expect(bomb.length).toBeLessThan(100_000);
    const began = performance.now();
    expect(() => readLink(bomb)).toThrow(damaged);
    expect(performance.now() - began).toBeLessThan(2000);
  });

  it('with claims beyond its end is refused', () => {
    // No song, no model, dials, then 4000 key poses that are not there.
    const claims = [0, 0, 0, 0, 0, 0, 1, 0, 160, 31, 0];
    expect(() => readLink(sealed(deflateSync(Uint8Array.from(claims))))).toThrow(damaged);
  });
});
