import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { createDocument } from '../../web/core/document';
import { parseDocument } from '../../web/core/document-read';
import { readProject, writeProject } from '../../web/core/formats/project-file';
import { documents, expectDocumentOrSentence, key, plain } from './support/documents';

/** Every place of a JSON value, as the keys that lead there. */
function places(value: unknown, path: string[] = []): string[][] {
  if (typeof value !== 'object' || value === null) return [path];
  return [path, ...Object.entries(value).flatMap(([name, inner]) => places(inner, [...path, name]))];
}

/** A copy with something else at a place, or with that place missing. */
function replaced(value: unknown, path: readonly string[], by: unknown, remove: boolean): unknown {
  const [name, ...rest] = path;
  if (name === undefined) return by;
  const copy = (Array.isArray(value) ? [...(value as unknown[])] : { ...(value as object) }) as Record<string, unknown>;
  if (rest.length === 0 && remove) return Object.fromEntries(Object.entries(copy).filter(([each]) => each !== name));
  copy[name] = replaced(copy[name], rest, by, remove);
  return copy;
}

const junk = fc.oneof(
  fc.jsonValue(),
  fc.constantFrom<unknown>(null, '', -1, 0, 1e300, 1e-300, 0.5, [], {}, true, 'x'.repeat(3000), { __proto__: null }, [
    [],
  ]),
);

describe('parseDocument', () => {
  it('gives back every project as it was written, with nothing to repair', () => {
    fc.assert(
      fc.property(documents, (document) => {
        expect(parseDocument(plain(document))).toEqual({ document: plain(document), repairs: [] });
        expect(readProject(writeProject(document)).document).toEqual(plain(document));
      }),
      { numRuns: 60 },
    );
  });

  it('makes a document of any JSON, or refuses it in a sentence', () => {
    fc.assert(fc.property(fc.jsonValue(), (value) => expectDocumentOrSentence(() => parseDocument(value))));
    const names = ['song', 'trim', 'grid', 'keyPoses', 'ranges', 'dials', 'avatar', 'camera'];
    const shaped = fc.record(Object.fromEntries(names.map((name) => [name, junk])), { requiredKeys: [] });
    fc.assert(
      fc.property(shaped, fc.constantFrom(1, 2), (parts, version) => {
        expect(parseDocument({ format: 'posebeat', version, ...parts }).document.format).toBe('posebeat');
        expectDocumentOrSentence(() => parseDocument({ format: 'posebeat', version, ...parts }));
      }),
    );
  });

  it('survives real projects with anything anywhere', () => {
    const damage = fc.array(fc.tuple(fc.nat(), junk, fc.boolean()), { minLength: 1, maxLength: 4 });
    fc.assert(
      fc.property(documents, damage, (document, changes) => {
        const damaged = changes.reduce<unknown>((value, [index, by, remove]) => {
          const all = places(value);
          return replaced(value, all[index % all.length], by, remove);
        }, plain(document));
        expectDocumentOrSentence(() => parseDocument(damaged));
      }),
      { numRuns: 300 },
    );
  });

  it('never loses a pose to a damaged name, lock or strength', () => {
    fc.assert(
      fc.property(key, junk, junk, junk, ({ rotations }, name, locked, strength) => {
        const document = { ...createDocument(), keyPoses: [{ id: 'k1', time: 1, rotations, name, locked, strength }] };
        expect(parseDocument(JSON.parse(JSON.stringify(document))).document.keyPoses[0].rotations).toEqual(
          JSON.parse(JSON.stringify(rotations)),
        );
      }),
    );
  });
});

describe('readProject', () => {
  it('makes a document of any bytes, or refuses them in a sentence', () => {
    fc.assert(
      fc.property(fc.uint8Array({ maxLength: 400 }), (bytes) => expectDocumentOrSentence(() => readProject(bytes))),
    );
    const head = [0x50, 0x4b, 3, 4];
    fc.assert(
      fc.property(fc.uint8Array({ maxLength: 400 }), (bytes) =>
        expectDocumentOrSentence(() => readProject(Uint8Array.from([...head, ...bytes]))),
      ),
    );
  });

  it('survives real files with bytes changed or cut off', () => {
    const song = Uint8Array.from({ length: 300 }, (_, i) => i);
    fc.assert(
      fc.property(
        documents,
        fc.array(fc.tuple(fc.nat(), fc.nat(255)), { maxLength: 5 }),
        fc.option(fc.nat(), { nil: null }),
        (document, changes, cut) => {
          const file = writeProject(document, song);
          for (const [index, byte] of changes) file[index % file.length] = byte;
          expectDocumentOrSentence(() => readProject(cut === null ? file : file.slice(0, cut % file.length)));
        },
      ),
      { numRuns: 150 },
    );
  });
});
