/** The visitor's own poses in IndexedDB: a database of its own, one entry per pose, so that two tabs do not overwrite each other. */
import { openDB, type DBSchema, type IDBPDatabase } from 'idb';
import * as v from 'valibot';
import { rotationsSchema } from '../core/document-schema';
import { poseName } from '../core/formats/pose-file';
import type { LibraryPose } from '../core/types';

/** Name of the group that the visitor's own poses are in. */
export const OWN_GROUP = 'My poses';

/** A pose of the visitor's. */
export interface OwnPose extends LibraryPose {
  /** Milliseconds since 1970; the newest are shown first. */
  savedAt: number;
}

/** Where own poses are kept; every method rejects where the browser keeps nothing. */
export interface PoseStore {
  /** All readable poses, newest first. */
  load(): Promise<OwnPose[]>;
  put(poses: readonly OwnPose[]): Promise<void>;
  remove(id: string): Promise<void>;
}

interface Schema extends DBSchema {
  poses: { key: string; value: unknown };
}

const saved = v.object({
  id: v.pipe(v.string(), v.nonEmpty()),
  name: v.string(),
  rotations: rotationsSchema,
  savedAt: v.number(),
});

/** Opens the database lazily. */
export function createPoseStore(name = 'posebeat-poses'): PoseStore {
  let opening: Promise<IDBPDatabase<Schema>> | null = null;
  const database = () => {
    // A failed attempt is not kept: the next one may be allowed.
    opening ??= openDB<Schema>(name, 1, {
      upgrade: (db) => void db.createObjectStore('poses', { keyPath: 'id' }),
    }).catch((error: unknown) => {
      opening = null;
      throw error;
    });
    return opening;
  };
  return {
    async load() {
      const entries = await (await database()).getAll('poses');
      const poses = entries.flatMap((entry) => {
        const parsed = v.safeParse(saved, entry);
        if (!parsed.success) return [];
        return [{ ...parsed.output, name: poseName(parsed.output.name) || 'Pose', group: OWN_GROUP }];
      });
      return poses.sort((a, b) => b.savedAt - a.savedAt);
    },
    async put(poses) {
      const transaction = (await database()).transaction('poses', 'readwrite');
      const writes = poses.map(({ id, name, rotations, savedAt }) =>
        transaction.store.put({ id, name, rotations: [...rotations], savedAt }),
      );
      await Promise.all([...writes, transaction.done]);
    },
    async remove(id) {
      await (await database()).delete('poses', id);
    },
  };
}
