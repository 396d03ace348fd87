import { describe, expect, it } from 'vitest';
import { freeName, newPoses, poseName, readPoseFile, writePoseFile } from '../../web/core/formats/pose-file';

const pose = (seed: number) => Array.from({ length: 72 }, (_, i) => Math.sin(seed + i));
const file = (poses: unknown, extra: object = {}) => ({ format: 'posebeat-poses', version: 1, poses, ...extra });

describe('pose files', () => {
  it('come back bit by bit', () => {
    const poses = [
      { name: 'Turn', rotations: pose(1) },
      { name: 'Émile’s kick 🕺', rotations: pose(2) },
    ];
    expect(readPoseFile(JSON.parse(writePoseFile(poses)))).toEqual({ poses, broken: 0 });
    expect(readPoseFile(JSON.parse(writePoseFile([])))).toEqual({ poses: [], broken: 0 });
  });
  it('lose only what is no pose', () => {
    const good = { name: 'Good', rotations: pose(1) };
    const read = readPoseFile(
      file([
        good,
        null,
        7,
        { name: 'short', rotations: [1] },
        { rotations: pose(1).fill(NaN) },
        { rotations: pose(2).fill(90) },
      ]),
    );
    expect(read).toEqual({ poses: [good], broken: 5 });
  });
  it.each<[string, unknown, RegExp]>([
    ['null', null, /holds no poses/],
    ['a list', [], /holds no poses/],
    ['a project', { format: 'posebeat', version: 2 }, /holds no poses/],
    ['no version', file([], { version: 'x' }), /no version/],
    ['a newer version', file([], { version: 2 }), /newer Posebeat/],
    ['no list', file({}), /no list/],
    ['only damage', file([{}]), /None of the poses/],
    ['too many', file(new Array(5001).fill(null)), /at most 5000/],
  ])('say what is wrong with %s', (_, raw, message) => expect(() => readPoseFile(raw)).toThrow(message));
  it('keep names short and plain', () => {
    expect(poseName('  a\u0000b\u202e  ')).toBe('a b');
    expect([...poseName('🕺'.repeat(200))]).toHaveLength(80);
    expect(readPoseFile(file([{ name: ' \n ', rotations: pose(1) }])).poses[0].name).toBe('Pose');
  });
});

describe('importing into a library', () => {
  const library = [{ name: 'Turn', rotations: pose(1) }];
  it('knows what is there already', () => {
    const incoming = [{ name: 'Turn', rotations: pose(1).map((value) => value + 1e-7) }];
    expect(newPoses(library, incoming)).toEqual({ added: [], duplicates: 1 });
  });
  it('gives another pose of the same name a number, once', () => {
    const incoming = [
      { name: 'Turn', rotations: pose(2) },
      { name: 'Turn', rotations: pose(3) },
      { name: 'Other', rotations: pose(1) },
    ];
    const first = newPoses(library, incoming);
    expect(first.added.map(({ name }) => name)).toEqual(['Turn 2', 'Turn 3', 'Other']);
    expect(first.duplicates).toBe(0);
    // Importing the same file again adds nothing.
    expect(newPoses([...library, ...first.added], incoming)).toEqual({ added: [], duplicates: 3 });
  });
  it('numbers names', () => {
    expect(freeName('A', new Set())).toBe('A');
    expect(freeName('A 2', new Set(['A', 'A 2']))).toBe('A 3');
  });
});
