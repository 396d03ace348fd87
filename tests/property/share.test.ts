import fc from 'fast-check';
import { deflateSync, inflateSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { createStore } from '../../web/app/store';
import { Player } from '../../web/audio/player';
import { clipId } from '../../web/core/clip-id';
import { createDocument, frameOf, sortKeys, type ProjectDocument } from '../../web/core/document';
import { readProject, writeProject } from '../../web/core/formats/project-file';
import { isPlayed, sharedGrid } from '../../web/core/formats/share-grid';
import { POSE_STEP, readLink, writeLink } from '../../web/core/formats/share-link';
import { crc32 } from '../../web/core/formats/zip-read';
import { tidy } from '../../web/core/grid-edit';
import { angleBetween, axisAngleToQuaternion } from '../../web/core/rotation';
import type { BeatGrid } from '../../web/core/types';
import { fakeReporter, fakeServices } from '../unit/support/app';
import { documents, expectDocumentOrSentence, plain } from './support/documents';

/** What a link leaves out, left out; poses and starting clip apart. */
function withoutPoses({ song, keyPoses, camera, ownSeed, dials, ...rest }: ProjectDocument) {
  void camera;
  const seedClip = ownSeed?.id === dials.seedClip ? 'the own one' : dials.seedClip;
  const poseless = keyPoses.map(({ rotations, ...others }) => (void rotations, others));
  const { url, ...named } = song ?? { name: '', hash: '', duration: 0 };
  void url;
  return plain({ ...rest, dials: { ...dials, seedClip }, song: song && named, keyPoses: poseless } as never);
}

/** Largest angle between the joints of two lists of poses, radians. */
function farthest(a: readonly (readonly number[])[], b: readonly (readonly number[])[]): number {
  let most = 0;
  expect(b).toHaveLength(a.length);
  a.forEach((rotations, k) => {
    for (let i = 0; i < rotations.length; i += 3) {
      const [p, q] = [rotations, b[k]].map((r) => axisAngleToQuaternion(r.slice(i, i + 3)));
      most = Math.max(most, angleBetween(p, q));
    }
  });
  return most;
}

const poses = ({ keyPoses }: ProjectDocument) => keyPoses.map(({ rotations }) => rotations);

/** A link around any bytes, its checksum right. */
function sealed(packed: Uint8Array, version = 1): string {
  const sum = Buffer.alloc(4);
  sum.writeUInt32LE(crc32(packed));
  return `#d=${version}.${Buffer.concat([sum, packed]).toString('base64url')}`;
}

const unpacked = (link: string) => Buffer.from(link.slice(5), 'base64url').subarray(4);

/** A starting clip of the visitor's own comes along where the dance starts with it, rounded like the key poses. */
function expectSameStart({ ownSeed, dials }: ProjectDocument, read: ProjectDocument): void {
  if (ownSeed?.id !== dials.seedClip) return expect(read.ownSeed).toBeUndefined();
  const own = read.ownSeed!;
  const { name, description, beats, rate } = ownSeed;
  expect(own).toMatchObject({ name, description, beats, rate, id: read.dials.seedClip });
  expect(own.id).toBe(clipId(own.poses, own.root));
  expect(farthest(ownSeed.poses, own.poses)).toBeLessThan(POSE_STEP);
  const off = ownSeed.root.flatMap((place, t) => place.map((value, k) => Math.abs(value - own.root[t][k])));
  expect(Math.max(...off)).toBeLessThanOrEqual(0.0025 + 1e-9);
}

/** Beats as a person plays them: a pace that wanders, and hands that are early and late. */
const played = fc
  .record({
    gap: fc.double({ min: 0.25, max: 1, noNaN: true }),
    steps: fc.array(
      fc.tuple(fc.double({ min: -0.02, max: 0.02, noNaN: true }), fc.double({ min: -1, max: 1, noNaN: true })),
      {
        minLength: 17,
        maxLength: 200,
      },
    ),
    bars: fc.constantFrom(3 as const, 4 as const, null),
  })
  .map(({ gap, steps, bars }): BeatGrid => {
    let [time, pace] = [0.2, gap];
    const beats = steps.map(([bend, off]) => {
      pace += (gap - pace) * 0.05 + bend * gap;
      time += Math.max(0.15, pace);
      return tidy(time + off * 0.03);
    });
    const downbeats = beats.filter((_, i) => (bars ? i % bars === 1 : i % 7 === 2 || i % 5 === 0));
    return { tempo: 60 / gap, beatsPerBar: bars ?? 4, beats, downbeats };
  });

describe('a link', () => {
  it('brings every project back: rotations within the step, all else exactly', () => {
    fc.assert(
      fc.property(documents, (document) => {
        const read = readLink(writeLink(document, 'light (q6)'));
        expect(read.repairs).toEqual([]);
        expect(read.model).toBe('light (q6)');
        expect(withoutPoses(read.document)).toEqual(withoutPoses(document));
        // Half a step off in each of three numbers, and the fourth decimal.
        expect(farthest(poses(document), poses(read.document))).toBeLessThan((Math.sqrt(3) * POSE_STEP) / 2 + 1e-4);
        expect(farthest(poses(document), poses(read.document))).toBeLessThan(POSE_STEP);
        expectSameStart(document, read.document);
        expect(writeLink(read.document, 'light (q6)')).toBe(writeLink(document, 'light (q6)'));
      }),
      { numRuns: 100 },
    );
  });

  it('brings back turns beyond half a turn, and poses that come again', () => {
    const turn = fc.array(fc.double({ min: -12, max: 12, noNaN: true }), { minLength: 72, maxLength: 72 });
    fc.assert(
      fc.property(turn, (rotations) => {
        const keyPoses = [1, 2, 3].map((time) => ({ id: `k${time}`, time, rotations }));
        const document = { ...createDocument(), keyPoses };
        const read = readLink(writeLink(document)).document;
        expect(farthest(poses(document), poses(read))).toBeLessThan(POSE_STEP);
        expect(writeLink(read)).toBe(writeLink(document));
      }),
    );
  });

  it('has beats that a person played to a millisecond, the key poses on their frames, and is the same when it is shared again', () => {
    fc.assert(
      fc.property(played, fc.nat(), (grid, where) => {
        const rotations = new Array<number>(72).fill(0.5);
        const { beats } = grid;
        const half = (beats[where % (beats.length - 1)] + beats[(where % (beats.length - 1)) + 1]) / 2;
        const keyPoses = sortKeys([beats[3], beats[9], half].map((time, i) => ({ id: `k${i + 1}`, time, rotations })));
        const document = { ...createDocument(), grid, keyPoses };
        const link = writeLink(document);
        const read = readLink(link);
        expect(read.repairs).toEqual([]);
        const back = read.document.grid!;
        expect(back.tempo).toBe(grid.tempo);
        expect(back.beats).toHaveLength(beats.length);
        beats.forEach((time, i) => expect(Math.abs(back.beats[i] - time)).toBeLessThan(5.01e-4));
        expect(back.downbeats.map((time) => back.beats.indexOf(time))).toEqual(
          grid.downbeats.map((time) => beats.indexOf(time)),
        );
        expect(read.document.keyPoses.map(({ time }) => frameOf(time))).toEqual(
          keyPoses.map(({ time }) => frameOf(time)),
        );
        expect(readLink(writeLink(read.document)).document).toEqual(read.document);
      }),
    );
  });

  it('with grids of every other kind of time is exact', () => {
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
          const back = readLink(writeLink({ ...createDocument(), grid })).document.grid;
          expect(back).toEqual(sharedGrid(grid));
          if (!isPlayed(grid)) expect(back).toEqual(grid);
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
        for (const version of [1, 2]) expectDocumentOrSentence(() => readLink(sealed(deflateSync(bytes), version)));
      }),
      { numRuns: 300 },
    );
  });

  it('of real projects with bytes changed inside and the checksum made right give a sound document or a sentence', () => {
    fc.assert(
      fc.property(documents, fc.array(fc.tuple(fc.nat(), fc.nat(255)), { maxLength: 4 }), (document, changes) => {
        const link = writeLink(document);
        const packed = Uint8Array.from(unpacked(link));
        const parts = inflateSync(packed);
        for (const [index, byte] of changes) {
          packed[index % packed.length] = byte;
          parts[index % parts.length] = byte;
        }
        const version = Number(link[3]);
        expectDocumentOrSentence(() => readLink(sealed(packed, version)));
        expectDocumentOrSentence(() => readLink(sealed(deflateSync(parts), version)));
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

  it('links and project files leave the project that is open as it is, and say so', async () => {
    const store = createStore(fakeServices(new Player(() => ({}) as AudioContext)), fakeReporter());
    await store.start();
    await store.loadSong(new File(['song'], 'mine.mp3'));
    store.setKeyPoses([{ time: 2, rotations: new Array<number>(72).fill(0.2) }]);
    const open = store.state.document.value;
    const random = noise(17);
    const link = writeLink(document, 'light (q6)');
    const whole = writeProject(document);
    for (let i = 0; i < 1000; i += 1) {
      store.state.notices.value = [];
      if (i % 2) {
        const text = mutated(link, random);
        if (isWhole(() => readLink(text))) continue;
        expect(await store.openLink(text)).toBe(false);
      } else await store.openProject(new File([mutated<Uint8Array<ArrayBuffer>>(whole, random)], 'theirs.posebeat'));
      expect(store.state.notices.value.length).toBeGreaterThan(0);
      expect(store.state.document.value).toBe(open);
    }
  });
});

/** True for a link that was only added to. */
function isWhole(read: () => unknown): boolean {
  try {
    return Boolean(read());
  } catch {
    return false;
  }
}
