import { describe, expect, it } from 'vitest';
import { checkKeyPoses, createDocument, nextKeyId, POSE_SIZE } from '../../web/core/document';
import { parseDocument } from '../../web/core/document-read';

const pose = (value = 0.1) => new Array<number>(POSE_SIZE).fill(value);
const song = { name: 'a.mp3', hash: 'ab', duration: 10 };

describe('checkKeyPoses', () => {
  it('sorts, copies and gives ids', () => {
    const rotations = pose();
    const keys = checkKeyPoses(
      [
        { time: 2, rotations },
        { time: 1, rotations: Float32Array.from(pose(0.2)) },
      ],
      10,
    );
    expect(keys.map((key) => key.time)).toEqual([1, 2]);
    expect(new Set(keys.map((key) => key.id)).size).toBe(2);
    rotations[0] = 9;
    expect(keys[1].rotations[0]).toBe(0.1);
  });

  it.each([
    ['no list', {}, /must be a list/],
    ['a time outside the song', [{ time: 11, rotations: pose() }], /outside the song \(0 to 10\.00 s\)/],
    ['a negative time', [{ time: -1, rotations: pose() }], /outside the song/],
    ['no time', [{ rotations: pose() }], /time must be a number/],
    ['71 numbers', [{ time: 1, rotations: pose().slice(1) }], /72 numbers/],
    ['NaN', [{ time: 1, rotations: [...pose().slice(1), NaN] }], /Key pose 1: rotations/],
    ['degrees', [{ time: 1, rotations: pose(45) }], /degrees/],
    [
      'two on one frame',
      [
        { time: 1, rotations: pose() },
        { time: 1.01, rotations: pose() },
      ],
      /share the frame at 1\.01/,
    ],
    ['null', [null], /must be an object/],
  ])('rejects %s', (_name, input, message) => {
    expect(() => checkKeyPoses(input, 10)).toThrow(message);
  });
});

describe('parseDocument', () => {
  it('reads back what JSON wrote, without repairs', () => {
    const document = { ...createDocument(song), keyPoses: [{ id: 'k1', time: 1, rotations: pose(), name: 'Star' }] };
    const { document: read, repairs } = parseDocument(JSON.parse(JSON.stringify(document)));
    expect(repairs).toEqual([]);
    expect(read).toEqual(document);
  });

  it.each([
    ['a number', 3, /not a Posebeat project/],
    ['another format', { format: 'x', version: 1 }, /not a Posebeat project/],
    ['a newer version', { format: 'posebeat', version: 3 }, /newer Posebeat/],
    ['no version', { format: 'posebeat' }, /damaged/],
    ['a hostile number of keys', { format: 'posebeat', version: 1, keyPoses: new Array(6000).fill(0) }, /at most 5000/],
  ])('refuses %s', (_name, input, message) => {
    expect(() => parseDocument(input)).toThrow(message);
  });

  it('repairs what it can and says so', () => {
    const { document, repairs } = parseDocument({
      format: 'posebeat',
      version: 1,
      song,
      grid: { tempo: 120, beatsPerBar: 4, beats: [1, 0.5], downbeats: [] },
      keyPoses: [
        { id: 'k1', time: 3, rotations: pose() },
        { id: 'k1', time: 1, rotations: pose() },
        { time: 5, rotations: pose() },
        { id: 'x', time: 12, rotations: pose() },
        { id: 'y', time: 2, rotations: [1] },
      ],
      dials: { keyStrength: 7, variation: 0.5, seed: 3, seedClip: 'sway' },
    });
    expect(document.keyPoses.map((key) => key.time)).toEqual([1, 3, 5]);
    expect(new Set(document.keyPoses.map((key) => key.id)).size).toBe(3);
    expect(document.grid).toBeNull();
    expect(document.dials).toEqual({ keyStrength: 1, variation: 0.5, seed: 3, seedClip: 'sway' });
    expect(repairs).toHaveLength(3);
    expect(repairs.join(' ')).toMatch(/2 damaged key poses/);
  });
});

describe('a key pose', () => {
  it('with a damaged name, lock or strength keeps its pose', () => {
    const damaged = { id: 'k1', time: 1, rotations: pose(), name: 5, locked: false, strength: 3 };
    const { document, repairs } = parseDocument({ ...createDocument(song), keyPoses: [damaged] });
    expect(document.keyPoses).toEqual([{ id: 'k1', time: 1, rotations: pose() }]);
    expect(repairs).toEqual(['The name, lock or strength of 1 key pose was damaged and left out.']);
  });
});

describe('nextKeyId', () => {
  it('is the first free number', () => {
    expect(nextKeyId([])).toBe('k1');
    expect(nextKeyId([{ id: 'k7' }, { id: 'other' }])).toBe('k8');
  });
});

describe('a project of version 1', () => {
  it('opens as version 2 with nothing repaired', () => {
    const { format, grid, keyPoses, dials } = createDocument(song);
    expect(parseDocument({ format, version: 1, song, grid, keyPoses, dials })).toEqual({
      document: createDocument(song),
      repairs: [],
    });
  });
});

describe('ranges, trim and camera', () => {
  const range = { id: 'r1', start: 2, end: 4, takes: [{ id: 't1', seed: 3, variation: 0.5 }], chosen: 't1' };
  it('come back as they were', () => {
    const document = {
      ...createDocument(song),
      trim: { start: 1, end: 9 },
      ranges: [range],
      camera: {
        follows: false,
        position: [1, 2, 3] as [number, number, number],
        target: [0, 1, 0] as [number, number, number],
      },
      keyPoses: [{ id: 'k1', time: 1, rotations: pose(), locked: true as const, strength: 0.25 }],
    };
    expect(parseDocument(JSON.parse(JSON.stringify(document)))).toEqual({ document, repairs: [] });
  });
  it.each([
    ['a trim past the end', { trim: { start: 1, end: 11 } }, /whole song/],
    ['a trim the wrong way round', { trim: { start: 3, end: 2 } }, /whole song/],
    ['a range whose take is missing', { ranges: [{ ...range, chosen: 't9' }] }, /ranges/],
    ['two ranges of one name', { ranges: [range, range] }, /ranges/],
    ['two takes of one name', { ranges: [{ ...range, takes: [...range.takes, ...range.takes] }] }, /ranges/],
    ['beats at no time', { grid: { tempo: 120, beatsPerBar: 4, beats: [], downbeats: [] } }, /song’s own beats/],
    [
      'beats on top of each other',
      { grid: { tempo: 120, beatsPerBar: 4, beats: [1, 1.0001], downbeats: [] } },
      /own beats/,
    ],
    ['a bar between beats', { grid: { tempo: 120, beatsPerBar: 4, beats: [1, 2], downbeats: [1, 1.5] } }, /bars/],
    ['a figure that is no name', { avatar: 7 }, /figure/],
    ['a camera at no place', { camera: { follows: true, position: [NaN, 0, 0], target: [0, 0, 0] } }, /camera/],
  ])('repair %s with a word', (_name, damage, message) => {
    const { repairs } = parseDocument({ ...createDocument(song), ...damage });
    expect(repairs).toHaveLength(1);
    expect(repairs[0]).toMatch(message);
  });
});
