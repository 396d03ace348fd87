import { readFileSync } from 'node:fs';
import { deflateSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { clipId } from '../../web/core/clip-id';
import { createDocument, frameOf, type ProjectDocument } from '../../web/core/document';
import { ByteWriter } from '../../web/core/formats/byte-pack';
import { isLink, readLink, writeLink } from '../../web/core/formats/share-link';
import { writeParts } from '../../web/core/formats/share-parts';
import { crc32 } from '../../web/core/formats/zip-read';
import { tidy } from '../../web/core/grid-edit';
import type { LibraryPose } from '../../web/core/types';
import { noise } from './support/wild-motion';

const library = (
  JSON.parse(readFileSync(new URL('../../public/library/poses.json', import.meta.url), 'utf8')) as {
    poses: LibraryPose[];
  }
).poses;

/** Written before there was a version 2. */
const OLD =
  '#d=1.4Qwcp2vlyslMzyhR0Cg002T3z0nRyy0wZuQnABh_MTJ8YGTh4XvBrr_rxaLuuHoHMVE5fjZlAVl2YwYgYGJk02QpLk-sZGJk4GFgZGJhSSzKLWZgYARJyoAIFDBwIgA';
const EVEN = Array.from({ length: 380 }, (_, i) => tidy(0.213 + (i * 60) / 127.3));
/** Three minutes as played by hand: the pace wanders, and every beat is early or late by some 20 ms. */
function byHand(): number[] {
  const random = noise(7);
  const about = () => random() + random() + random() + random() - 2;
  let [time, gap] = [0.213, 60 / 127.3];
  return Array.from({ length: 380 }, () => {
    gap += about() * 0.005 + (60 / 127.3 - gap) * 0.02;
    time += gap;
    return tidy(time + about() * 0.035);
  });
}

/** A three-minute song of the visitor's own with an edited grid and this many poses from all over the library, all different. */
function project(poses: number, beats: readonly number[] = EVEN): ProjectDocument {
  const chosen = Array.from({ length: poses }, (_, i) => library[Math.floor((i * library.length) / poses)]);
  return {
    ...createDocument({
      name: 'Some Artist - A Song With a Long Name.mp3',
      hash: '21c5'.repeat(16),
      duration: 183.4567891,
    }),
    trim: { start: 1.5, end: 100.25 },
    grid: { tempo: 127.3, beatsPerBar: 4, beats: [...beats], downbeats: beats.filter((_, i) => i % 4 === 2) },
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
function sealed(packed: Uint8Array, version = 1): string {
  const sum = Buffer.alloc(4);
  sum.writeUInt32LE(crc32(packed));
  return `#d=${version}.${Buffer.concat([sum, packed]).toString('base64url')}`;
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

  it('with a grid played by hand for three minutes and 16 poses stays under 2,000 characters too', () => {
    const beats = byHand();
    const document = project(16, beats);
    const link = writeLink(document, 'light (q6)');
    expect(link.length).toBeLessThan(2000);
    expect(link).toMatch(/^#d=2\./);
    const read = readLink(link);
    expect(read.repairs).toEqual([]);
    const back = read.document.grid!.beats;
    beats.forEach((time, i) => expect(Math.abs(back[i] - time)).toBeLessThan(5.01e-4));
    expect(read.document.keyPoses.map(({ time }) => frameOf(time))).toEqual(
      document.keyPoses.map(({ time }) => frameOf(time)),
    );
  });

  it('has every part of a project that its dance is made from', () => {
    const [pose, other] = project(2).keyPoses.map(({ rotations }) => rotations);
    const poses = [pose, other];
    const root: [number, number, number][] = [
      [0, 0.9, 0],
      [0.1, 0.95, 0.05],
    ];
    const ownSeed = { id: clipId(poses, root), name: 'mine', description: '', beats: 2, rate: 1, poses, root };
    // Required: a part that projects get later must be added here, and to links or to what they leave out.
    const whole: Required<ProjectDocument> = {
      ...project(3),
      ownSeed,
      dials: { keyStrength: 0.7, variation: 0.4, seed: 99, seedClip: ownSeed.id },
      engine: 'curves',
      curveEdits: [{ from: 'k1', to: 4.25, track: 'left_elbow', tension: 0.3 }],
      avatar: 'someone',
      look: { style: 'neon', colours: 'sea' },
      camera: { follows: true, position: [1, 2, 3], target: [0, 1, 0] },
    };
    const { document, repairs } = readLink(writeLink(whole));
    expect(repairs).toEqual([]);
    const { rotations: rounded } = readLink(
      writeLink({ ...project(0), keyPoses: [{ id: 'k1', time: 0, rotations: pose }] }),
    ).document.keyPoses[0];
    expect(document.ownSeed).toMatchObject({ name: 'mine', beats: 2, root, id: document.dials.seedClip });
    expect(document.ownSeed!.poses[0]).toEqual(rounded);
    for (const name of Object.keys(whole) as (keyof ProjectDocument)[]) {
      if (name === 'camera') expect(document.camera).toBeNull();
      else if (name === 'dials') expect(document.dials).toEqual({ ...whole.dials, seedClip: document.ownSeed!.id });
      else if (name !== 'ownSeed' && name !== 'keyPoses') expect(document[name], name).toEqual(whole[name]);
    }
    // A clip that is not chosen has no part in the dance.
    expect(
      readLink(writeLink({ ...whole, dials: { ...whole.dials, seedClip: 'sway' } })).document.ownSeed,
    ).toBeUndefined();
  });

  it('of version 1 still opens', () => {
    const { document, repairs, model } = readLink(OLD);
    expect(repairs).toEqual([]);
    expect([model, document.song?.name, document.grid?.beats.length, document.dials.seed]).toEqual([
      'light (q6)',
      'Old.mp3',
      12,
      41,
    ]);
    expect(document.keyPoses.map(({ time, name }) => [time, name])).toEqual([
      [0.5, 'arms'],
      [2.021, undefined],
    ]);
  });

  it('opens what it knows of a newer page’s link, and says so', () => {
    const parts = new ByteWriter();
    const further = new ByteWriter();
    further.text('something new');
    writeParts(parts, project(2), '', false, [[77, further]]);
    const read = readLink(sealed(deflateSync(Uint8Array.from(parts.bytes)), 2));
    expect(read.document.keyPoses).toHaveLength(2);
    expect(read.repairs).toEqual([expect.stringContaining('A newer Posebeat')]);
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
    expect(() => readLink('#d=3.AAAA')).toThrow('newer Posebeat: reload the page');
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
