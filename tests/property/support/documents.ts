/** Projects as people make them, and what must be true of whatever is read from outside. */
import fc from 'fast-check';
import { expect } from 'vitest';
import { clipId } from '../../../web/core/clip-id';
import { createDocument, type ProjectDocument } from '../../../web/core/document';
import { parseDocument } from '../../../web/core/document-read';
import { FIGURE_COLOURS, FIGURE_STYLES } from '../../../web/core/figure-look';

const unit = fc.double({ min: 0, max: 1, noNaN: true });
const text = (maxLength: number) => fc.string({ unit: 'grapheme', minLength: 1, maxLength });
const metres = fc.double({ min: -50, max: 50, noNaN: true });
const triple = fc.tuple(metres, metres, metres);
const seed = fc.nat();
/** Ascending times on frames of their own, inside ten seconds. */
const frames = (maxLength: number) =>
  fc
    .uniqueArray(fc.integer({ min: 0, max: 299 }), { maxLength })
    .map((list) => list.sort((a, b) => a - b).map((f) => f / 30));

/** A key pose without id and time. */
export const key = fc.record(
  {
    rotations: fc.array(fc.double({ min: -3, max: 3, noNaN: true }), { minLength: 72, maxLength: 72 }),
    name: text(20),
    locked: fc.constant(true as const),
    strength: unit,
    suggested: fc.constant(true as const),
  },
  { requiredKeys: ['rotations'] },
);
const take = (id: string) => fc.record({ id: fc.constant(id), seed, variation: unit });
const range = fc
  .record({
    start: unit,
    length: unit,
    takes: fc.tuple(take('t1'), take('t2')),
    chosen: fc.constantFrom(null, 't1', 't2'),
  })
  .map(({ start, length, takes, chosen }) => ({ start: start * 4, end: start * 4 + 0.1 + length * 5, takes, chosen }));

/** A starting clip of the visitor's own, one or two beats long. */
const ownSeed = fc
  .record({ beats: fc.integer({ min: 1, max: 2 }), rate: fc.integer({ min: 1, max: 3 }), name: text(9) })
  .chain(({ beats, rate, name }) => {
    const length = { minLength: beats * rate, maxLength: beats * rate };
    const pose = fc.array(fc.double({ min: -3, max: 3, noNaN: true }), { minLength: 72, maxLength: 72 });
    return fc.record({ poses: fc.array(pose, length), root: fc.array(triple, length) }).map(({ poses, root }) => {
      const id = clipId(poses, root);
      return { id, name, description: `Some beats of “${name}”.`, beats, rate, poses, root };
    });
  });
const look = fc.record({
  style: fc.constantFrom(...FIGURE_STYLES),
  colours: fc.constantFrom(...FIGURE_COLOURS.map(({ id }) => id)),
});
const bend = fc.record({
  from: fc.constantFrom('k1', 4.25),
  to: fc.constantFrom('k2', 8),
  track: fc.constantFrom('root', 'left_elbow'),
  tension: fc.double({ min: 0.1, max: 1, noNaN: true }),
});
const maybe = <T>(value: fc.Arbitrary<T>) => fc.option(value, { nil: undefined });

/** Any project that a person could have made. */
export const documents: fc.Arbitrary<ProjectDocument> = fc
  .record({
    url: fc.option(fc.webUrl(), { nil: undefined }),
    trim: fc.constantFrom(null, { start: 1, end: 9 }),
    beats: fc.option(frames(40), { nil: null }),
    times: frames(6),
    keys: fc.array(key, { minLength: 6, maxLength: 6 }),
    ranges: fc.array(range, { maxLength: 3 }),
    dials: fc.record({ keyStrength: unit, variation: unit, seed, seedClip: text(9) }),
    avatar: text(9),
    camera: fc.option(fc.record({ follows: fc.boolean(), position: triple, target: triple }), { nil: null }),
    name: text(30),
    own: maybe(fc.record({ ownSeed, chosen: fc.boolean() })),
    engine: maybe(fc.constantFrom('light' as const, 'curves' as const)),
    curveEdits: maybe(bend.map((edit) => [edit])),
    look: maybe(look),
  })
  .map((given) => ({
    ...createDocument({ name: given.name, hash: 'ab', duration: 10, ...(given.url ? { url: given.url } : {}) }),
    trim: given.trim,
    grid:
      given.beats && given.beats.length > 0
        ? {
            tempo: 120,
            beatsPerBar: 4 as const,
            beats: given.beats,
            downbeats: given.beats.filter((_, i) => i % 4 === 0),
          }
        : null,
    keyPoses: given.times.map((time, i) => ({ id: `k${i + 1}`, time, ...given.keys[i] })),
    ranges: given.ranges.map((each, i) => ({ id: `r${i + 1}`, ...each })),
    dials: given.own?.chosen ? { ...given.dials, seedClip: given.own.ownSeed.id } : given.dials,
    ...(given.own ? { ownSeed: given.own.ownSeed } : {}),
    ...(given.engine ? { engine: given.engine } : {}),
    ...(given.curveEdits ? { curveEdits: given.curveEdits } : {}),
    ...(given.look ? { look: given.look } : {}),
    avatar: given.avatar,
    camera: given.camera,
  }));

/** As it comes out of a file. */
export const plain = (document: ProjectDocument) => JSON.parse(JSON.stringify(document)) as unknown;
/** What is read is a document that needs no further repair; what is refused is refused in a sentence. */
export function expectDocumentOrSentence(read: () => { document: ProjectDocument }): void {
  let document: ProjectDocument;
  try {
    document = read().document;
  } catch (error) {
    expect(Object.getPrototypeOf(error)).toBe(Error.prototype);
    expect((error as Error).message).toMatch(/^[A-Z].{10,}[.!]$/);
    return;
  }
  expect(parseDocument(JSON.parse(JSON.stringify(document)))).toEqual({ document, repairs: [] });
}
