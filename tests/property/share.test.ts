import fc from 'fast-check';
import { deflateSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { createDocument, type ProjectDocument } from '../../web/core/document';
import { readProject, writeProject } from '../../web/core/formats/project-file';
import { POSE_STEP, readLink, writeLink } from '../../web/core/formats/share-link';
import { crc32 } from '../../web/core/formats/zip-read';
import { angleBetween, axisAngleToQuaternion } from '../../web/core/rotation';
import { documents, expectDocumentOrSentence, plain } from './support/documents';

/** What a link leaves out, left out; poses apart. */
function withoutPoses({ song, keyPoses, camera, ...rest }: ProjectDocument) {
  void camera;
  const poseless = keyPoses.map(({ rotations, ...others }) => (void rotations, others));
  const { url, ...named } = song ?? { name: '', hash: '', duration: 0 };
  void url;
  return plain({ ...rest, song: song && named, keyPoses: poseless } as never);
}

/** Largest angle between the joints of two documents' key poses, radians. */
function farthest(a: ProjectDocument, b: ProjectDocument): number {
  let most = 0;
  a.keyPoses.forEach(({ rotations }, k) => {
    for (let i = 0; i < rotations.length; i += 3) {
      const [p, q] = [rotations, b.keyPoses[k].rotations].map((r) => axisAngleToQuaternion(r.slice(i, i + 3)));
      most = Math.max(most, angleBetween(p, q));
    }
  });
  return most;
}

/** A link around any bytes, its checksum right. */
function sealed(packed: Uint8Array): string {
  const sum = Buffer.alloc(4);
  sum.writeUInt32LE(crc32(packed));
  return `#d=1.${Buffer.concat([sum, packed]).toString('base64url')}`;
}

const unpacked = (link: string) => Buffer.from(link.slice(5), 'base64url').subarray(4);

describe('a link', () => {
  it('brings every project back: rotations within the step, all else exactly', () => {
    fc.assert(
      fc.property(documents, (document) => {
        const read = readLink(writeLink(document, 'light (q6)'));
        expect(read.repairs).toEqual([]);
        expect(read.model).toBe('light (q6)');
        expect(withoutPoses(read.document)).toEqual(withoutPoses(document));
        // Half a step off in each of three numbers, and the fourth decimal.
        expect(farthest(document, read.document)).toBeLessThan((Math.sqrt(3) * POSE_STEP) / 2 + 1e-4);
        expect(farthest(document, read.document)).toBeLessThan(POSE_STEP);
        expect(writeLink(read.document, 'light (q6)')).toBe(writeLink(document, 'light (q6)'));
      }),
      { numRuns: 150 },
    );
  });

  it('brings back turns beyond half a turn, and poses that come again', () => {
    const turn = fc.array(fc.double({ min: -12, max: 12, noNaN: true }), { minLength: 72, maxLength: 72 });
    fc.assert(
      fc.property(turn, (rotations) => {
        const keyPoses = [1, 2, 3].map((time) => ({ id: `k${time}`, time, rotations }));
        const document = { ...createDocument(), keyPoses };
        const read = readLink(writeLink(document)).document;
        expect(farthest(document, read)).toBeLessThan(POSE_STEP);
        expect(writeLink(read)).toBe(writeLink(document));
      }),
    );
  });

  it('with grids of every kind of time is exact', () => {
    const pace = fc.tuple(fc.double({ min: 0.2, max: 1, noNaN: true }), fc.constantFrom(1, 2, 30, 1000, 1e6, 0));
    fc.assert(
      fc.property(
        pace,
        fc.array(fc.double({ min: 0, max: 0.1, noNaN: true }), { minLength: 1 }),
        ([step, parts], off) => {
          const beats = off.map((by, i) => {
            const time = i * Math.max(step, 1.5 / (parts || 1e9)) + by;
            return parts ? Math.round(time * parts) / parts : time;
          });
          const apart = beats.filter((time, i) => i === 0 || time - beats[i - 1] >= 0.02);
          const rising = apart.filter((time, i) => apart.slice(0, i).every((other) => other < time - 0.01));
          const grid = { tempo: 60 / step, beatsPerBar: 3 as const, beats: rising, downbeats: rising.slice(0, 5) };
          expect(readLink(writeLink({ ...createDocument(), grid })).document.grid).toEqual(grid);
        },
      ),
    );
  });
});

describe('hostile links', () => {
  it('of any text are refused in a sentence', () => {
    fc.assert(
      fc.property(fc.string({ unit: 'binary' }), (text) => expectDocumentOrSentence(() => readLink(`#d=${text}`))),
    );
    fc.assert(
      fc.property(fc.base64String({ maxLength: 400 }), (text) =>
        expectDocumentOrSentence(() => readLink(`#d=1.${text}`)),
      ),
    );
  });

  it('of any bytes with a right checksum give a sound document or a sentence', () => {
    fc.assert(
      fc.property(fc.uint8Array({ maxLength: 300 }), (bytes) => {
        expectDocumentOrSentence(() => readLink(sealed(bytes)));
        expectDocumentOrSentence(() => readLink(sealed(deflateSync(bytes))));
      }),
      { numRuns: 300 },
    );
  });

  it('of real projects with bytes changed inside and the checksum made right give a sound document or a sentence', () => {
    fc.assert(
      fc.property(documents, fc.array(fc.tuple(fc.nat(), fc.nat(255)), { maxLength: 4 }), (document, changes) => {
        const packed = Uint8Array.from(unpacked(writeLink(document)));
        for (const [index, byte] of changes) packed[index % packed.length] = byte;
        expectDocumentOrSentence(() => readLink(sealed(packed)));
      }),
      { numRuns: 300 },
    );
  });
});

/** The same noise every time. */
function* noise(seed: number): Generator<number, never> {
  for (let state = seed; ;) yield (state = (state * 48271) % 2147483647);
}

/** A copy with a few characters changed, put in, taken out, or the end cut off. */
function mutated<T extends string | Uint8Array>(whole: T, random: Generator<number, never>): T {
  const next = (below: number) => random.next().value % below;
  const list: (string | number)[] = [...(whole as Iterable<string | number>)];
  const piece = (): string | number => (typeof whole === 'string' ? String.fromCharCode(33 + next(94)) : next(256));
  for (let i = next(4); i >= 0; i -= 1) {
    const at = next(list.length);
    const way = next(5);
    if (way === 0) list.splice(at, 1 + next(8));
    else if (way === 1) list.splice(at, 0, piece());
    else if (way === 2) list.length = Math.max(1, at);
    else list[at] = piece();
  }
  return (typeof whole === 'string' ? list.join('') : Uint8Array.from(list as number[])) as T;
}

describe('1,000 damaged', () => {
  const [document] = fc.sample(documents, { numRuns: 20, seed: 7 }).filter(({ keyPoses }) => keyPoses.length > 3);

  it('links give no other dance, each within a blink', () => {
    const link = writeLink(document, 'light (q6)');
    const random = noise(11);
    let refused = 0;
    for (let i = 0; i < 1000; i += 1) {
      const text = mutated(link, random);
      const began = performance.now();
      try {
        expect(readLink(text).document).toEqual(readLink(link).document);
      } catch (error) {
        expect((error as Error).message).toMatch(/^This link [^\n]+\.$/);
        refused += 1;
      }
      expect(performance.now() - began).toBeLessThan(2000);
    }
    // The others are whole: only what stands after the link was touched.
    expect(refused).toBeGreaterThan(950);
  });

  it('project files give a sound document or a sentence, each within a blink', () => {
    const random = noise(13);
    const song = Uint8Array.from({ length: 2000 }, (_, i) => (i * i) % 251);
    for (let i = 0; i < 1000; i += 1) {
      const file = mutated<Uint8Array>(writeProject(document, i % 2 ? song : undefined), random);
      const began = performance.now();
      expectDocumentOrSentence(() => readProject(file));
      expect(performance.now() - began).toBeLessThan(2000);
    }
  });
});
