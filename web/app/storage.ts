/** The visitor's work in this browser: one project and its dance in IndexedDB, the bytes of the last few songs in the private file system. */
import { openDB, type DBSchema, type IDBPDatabase } from 'idb';
import type { ProjectDocument } from '../core/document';
import { leavingNote } from './leaving-note';
import type { SavedDance, Storage } from './ports';
import { songFiles } from './song-files';

/** A song that is kept. */
interface KeptSong {
  hash: string;
  usedAt: number;
  /** Its bytes; missing where they lie in a file of their own. */
  song?: Blob;
  /** Bytes of that file, to tell a whole one from a torn one. */
  size?: number;
  type?: string;
}

interface Schema extends DBSchema {
  work: { key: 'document' | 'dance' | 'aside'; value: unknown };
  songs: { key: string; value: KeptSong };
}

/** Projects kept aside; the oldest go first. */
const MAX_ASIDE = 5;
/** Songs kept for undo and the next visit; the least recently used go first. */
const MAX_SONGS = 4;

/** True for the error of a full disk, wherever it comes from. */
export function isFull(error: unknown): boolean {
  return error instanceof DOMException && error.name === 'QuotaExceededError';
}

/**
 * Opens the storage lazily; every call rejects where the browser has none.
 * @param mayWrite - False while another tab has the project: then document and dance are left alone.
 */
export function createStorage(name = 'posebeat', mayWrite: () => boolean = () => true): Storage {
  let opening: Promise<IDBPDatabase<Schema>> | null = null;
  /** The database once it is open: a page that goes away cannot wait for it. */
  let ready: IDBPDatabase<Schema> | null = null;
  const files = songFiles(`${name}-songs`);
  const note = leavingNote(name);
  /** Noted by this page and not saved yet. */
  let noted: ProjectDocument | null = null;
  const database = () => {
    opening ??= openDB<Schema>(name, 1, {
      upgrade(db) {
        db.createObjectStore('work');
        db.createObjectStore('songs', { keyPath: 'hash' });
      },
      // The browser may close it (deleted site data, a full disk): the next call opens it anew.
      terminated: () => (opening = ready = null),
    });
    opening.then(
      (db) => (ready = db),
      () => (opening = null),
    );
    return opening;
  };

  /** Commits at once: a transaction that waits to commit by itself is undone when its page goes away. */
  async function putWork(key: 'document' | 'dance' | 'aside', value: unknown): Promise<void> {
    const transaction = (ready ?? (await database())).transaction('work', 'readwrite');
    const put = transaction.store.put(value, key);
    transaction.commit();
    await Promise.all([put, transaction.done]);
  }

  /** Projects that were put aside, the last one last. */
  async function aside(): Promise<unknown[]> {
    const list = await (await database()).get('work', 'aside');
    return Array.isArray(list) ? (list as unknown[]) : [];
  }

  /** Lets go of all songs but the `keep` most recently used. */
  async function forgetSongs(db: IDBPDatabase<Schema>, keep: number): Promise<void> {
    const all = await db.getAll('songs');
    const old = all.sort((a, b) => b.usedAt - a.usedAt).slice(keep);
    await Promise.all(old.flatMap(({ hash }) => [db.delete('songs', hash), files.remove(hash)]));
  }

  async function keepSong(db: IDBPDatabase<Schema>, hash: string, song: Blob): Promise<void> {
    const { size, type } = song;
    if (await files.write(hash, song)) {
      await db.put('songs', { hash, usedAt: Date.now(), size, type });
      return;
    }
    // A copy: a File only points at the disk and is unreadable once that file changes.
    const copy = new Blob([await song.arrayBuffer()], { type });
    await db.put('songs', { hash, usedAt: Date.now(), song: copy });
  }

  return {
    async saveDocument(document: ProjectDocument) {
      if (!mayWrite()) return;
      await putWork('document', document);
      // What another page had noted is older than this; what this page noted may be newer.
      if (noted !== null && noted !== document) return;
      noted = null;
      note.clear();
    },
    noteDocument(document) {
      if (!mayWrite()) return;
      noted = document;
      note.write(document);
    },
    async saveDance(dance: SavedDance) {
      if (mayWrite()) await putWork('dance', dance);
    },
    async saveSong(hash, song) {
      const db = await database();
      try {
        await keepSong(db, hash, song);
      } catch (error) {
        if (!isFull(error)) throw error;
        // Former songs make room for this one, once.
        await forgetSongs(db, 0);
        await keepSong(db, hash, song);
      }
      await forgetSongs(db, MAX_SONGS);
    },
    async loadSong(hash) {
      const db = await database();
      const kept = await db.get('songs', hash);
      if (!kept) return null;
      const song = kept.song ?? (await files.read(hash));
      if (!song || (kept.size !== undefined && song.size !== kept.size)) return null;
      await db.put('songs', { ...kept, usedAt: Date.now() }).catch(() => undefined);
      return song;
    },
    async load() {
      const db = await database();
      const document = note.read() ?? (await db.get('work', 'document'));
      if (document === undefined) return null;
      const dance = (await db.get('work', 'dance')) as SavedDance | undefined;
      return { document, dance: dance ?? null };
    },
    async setAside(document) {
      const list = [...(await aside()), document].slice(-MAX_ASIDE);
      await putWork('aside', list);
      return list.length;
    },
    async takeAside() {
      const list = await aside();
      if (list.length === 0) return null;
      await putWork('aside', list.slice(0, -1));
      return { document: list[list.length - 1], left: list.length - 1 };
    },
    countAside: async () => (await aside()).length,
    async persist() {
      const storage = navigator.storage as StorageManager | undefined;
      return (await storage?.persisted?.()) || ((await storage?.persist?.()) ?? false);
    },
  };
}
