/** The visitor's work in IndexedDB: one project, its dance, and the last few songs. */
import { openDB, type DBSchema, type IDBPDatabase } from 'idb';
import type { ProjectDocument } from '../core/document';
import type { SavedDance, Storage } from './ports';

interface Schema extends DBSchema {
  work: { key: 'document' | 'dance'; value: unknown };
  songs: { key: string; value: { hash: string; song: Blob; usedAt: number } };
}

/** Songs kept for undo and the next visit; the least recently used go first. */
const MAX_SONGS = 4;

/** Opens the storage lazily; every call rejects where the browser has none. */
export function createStorage(name = 'posebeat'): Storage {
  let opening: Promise<IDBPDatabase<Schema>> | null = null;
  const database = () => {
    opening ??= openDB<Schema>(name, 1, {
      upgrade(db) {
        db.createObjectStore('work');
        db.createObjectStore('songs', { keyPath: 'hash' });
      },
    });
    return opening;
  };

  return {
    async saveDocument(document: ProjectDocument) {
      await (await database()).put('work', document, 'document');
    },
    async saveDance(dance: SavedDance) {
      await (await database()).put('work', dance, 'dance');
    },
    async saveSong(hash, song) {
      const db = await database();
      // A copy: a File only points at the disk and is unreadable once that file changes.
      const copy = new Blob([await song.arrayBuffer()], { type: song.type });
      await db.put('songs', { hash, song: copy, usedAt: Date.now() });
      const all = await db.getAll('songs');
      const old = all.sort((a, b) => b.usedAt - a.usedAt).slice(MAX_SONGS);
      await Promise.all(old.map((each) => db.delete('songs', each.hash)));
    },
    async loadSong(hash) {
      return (await (await database()).get('songs', hash))?.song ?? null;
    },
    async load() {
      const db = await database();
      const document = await db.get('work', 'document');
      if (document === undefined) return null;
      const dance = (await db.get('work', 'dance')) as SavedDance | undefined;
      return { document, dance: dance ?? null };
    },
  };
}
