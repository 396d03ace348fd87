/** The visitor's own characters in IndexedDB, in a database of its own: what they are in one store, their bytes in another. */
import { openDB, type DBSchema, type IDBPDatabase } from 'idb';
import * as v from 'valibot';
import { JOINT_COUNT } from '../core/skeleton';

/** Larger files are refused before they are read, bytes. */
export const MAX_AVATAR_BYTES = 100e6;
/** Characters that are kept; the one that was used least recently goes first. */
export const MAX_AVATARS = 12;

/** A character, without its bytes. */
export interface KeptAvatar {
  id: string;
  name: string;
  /** For each of our 24 joints the node of the file; -1 = none. */
  map: readonly number[];
  /** Bytes of the file. */
  size: number;
  /** Milliseconds since 1970. */
  usedAt: number;
}

/** Where characters are kept; every method rejects where the browser keeps nothing. */
export interface AvatarStore {
  /** All readable characters, in the order of their names, and the one in use; null = our own figure. */
  load(): Promise<{ avatars: KeptAvatar[]; chosen: string | null }>;
  /** Null where they are lost. */
  bytes(id: string): Promise<Uint8Array | null>;
  /** Keeps a character; without bytes, only what is known of it. Resolves with the ids of those that had to go. */
  put(avatar: KeptAvatar, bytes?: Uint8Array): Promise<string[]>;
  remove(id: string): Promise<void>;
  choose(id: string | null): Promise<void>;
}

interface Schema extends DBSchema {
  avatars: { key: string; value: unknown };
  files: { key: string; value: Uint8Array };
  settings: { key: string; value: unknown };
}

const saved = v.object({
  id: v.pipe(v.string(), v.nonEmpty()),
  name: v.string(),
  map: v.pipe(v.array(v.pipe(v.number(), v.integer(), v.minValue(-1))), v.length(JOINT_COUNT)),
  size: v.number(),
  usedAt: v.number(),
});

/** Opens the database lazily. */
export function createAvatarStore(name = 'posebeat-avatars'): AvatarStore {
  let opening: Promise<IDBPDatabase<Schema>> | null = null;
  const database = () => {
    opening ??= openDB<Schema>(name, 1, {
      upgrade: (db) => {
        db.createObjectStore('avatars', { keyPath: 'id' });
        db.createObjectStore('files');
        db.createObjectStore('settings');
      },
    }).catch((error: unknown) => {
      // A failed attempt is not kept: the next one may be allowed.
      opening = null;
      throw error;
    });
    return opening;
  };
  const all = async (db: IDBPDatabase<Schema>): Promise<KeptAvatar[]> =>
    (await db.getAll('avatars')).flatMap((entry) => {
      const parsed = v.safeParse(saved, entry);
      return parsed.success ? [parsed.output] : [];
    });
  const remove = async (db: IDBPDatabase<Schema>, ids: readonly string[]): Promise<void> => {
    const transaction = db.transaction(['avatars', 'files'], 'readwrite');
    const gone = ids.flatMap((id) => [
      transaction.objectStore('avatars').delete(id),
      transaction.objectStore('files').delete(id),
    ]);
    await Promise.all([...gone, transaction.done]);
  };
  return {
    async load() {
      const db = await database();
      const avatars = (await all(db)).sort((a, b) => a.name.localeCompare(b.name));
      const chosen = await db.get('settings', 'chosen');
      return { avatars, chosen: avatars.some(({ id }) => id === chosen) ? (chosen as string) : null };
    },
    async bytes(id) {
      const bytes: unknown = await (await database()).get('files', id);
      return bytes instanceof Uint8Array ? bytes : null;
    },
    async put(avatar, bytes) {
      const db = await database();
      const others = (await all(db)).filter(({ id }) => id !== avatar.id).sort((a, b) => b.usedAt - a.usedAt);
      const leaving = others.slice(MAX_AVATARS - 1).map(({ id }) => id);
      if (leaving.length > 0) await remove(db, leaving);
      const transaction = db.transaction(['avatars', 'files'], 'readwrite');
      const writes: Promise<unknown>[] = [
        transaction.objectStore('avatars').put({ ...avatar, map: [...avatar.map] }),
        ...(bytes ? [transaction.objectStore('files').put(bytes, avatar.id)] : []),
      ];
      await Promise.all([...writes, transaction.done]);
      return leaving;
    },
    remove: async (id) => remove(await database(), [id]),
    async choose(id) {
      await (await database()).put('settings', id, 'chosen');
    },
  };
}

/** Keeps nothing. */
export function noAvatarStore(): AvatarStore {
  const refuse = () => Promise.reject(new Error('Characters are not kept here.'));
  return { load: refuse, bytes: refuse, put: refuse, remove: refuse, choose: refuse };
}
