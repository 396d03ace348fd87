import { describe, expect, it } from 'vitest';
import { checkKeyPoses, createDocument, nextKeyId, parseDocument, POSE_SIZE } from '../../web/core/document';

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
    ['a newer version', { format: 'posebeat', version: 2 }, /newer Posebeat/],
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

describe('nextKeyId', () => {
  it('is the first free number', () => {
    expect(nextKeyId([])).toBe('k1');
    expect(
      nextKeyId([
        { id: 'k7', time: 0, rotations: [] },
        { id: 'other', time: 0, rotations: [] },
      ]),
    ).toBe('k8');
  });
});
