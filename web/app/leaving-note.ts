/** What a page that goes away writes down at once: it cannot wait for IndexedDB, and an unfinished write is undone. */
import type { ProjectDocument } from '../core/document';

/** One document, noted until it is saved for good. Silent where the browser has no such storage or no room in it. */
export interface LeavingNote {
  /** Takes the place of an earlier note. */
  write(document: ProjectDocument): void;
  /** What was noted; undefined where there is nothing, or nothing that can be read. */
  read(): unknown;
  clear(): void;
}

/**
 * A note in the local storage, which takes it before the call returns.
 * @param name - Of the project's place in this browser.
 */
export function leavingNote(name: string): LeavingNote {
  const key = `${name}.leaving`;
  const clear = () => {
    try {
      localStorage.removeItem(key);
    } catch {
      // private window, or switched off
    }
  };
  return {
    write(document) {
      // An old note must not outlive a new one that finds no room.
      clear();
      try {
        localStorage.setItem(key, JSON.stringify(document));
      } catch {
        // too long, full, private window: IndexedDB is on its way all the same
      }
    },
    read() {
      try {
        return (JSON.parse(localStorage.getItem(key) ?? 'null') as unknown) ?? undefined;
      } catch {
        return undefined;
      }
    },
    clear,
  };
}
