/** Songs as files in the origin private file system (OPFS): large bytes that IndexedDB would copy about. */

/** A folder of songs; all of it is silent where the browser has no such files. */
export interface SongFiles {
  /** @returns false when the browser cannot write such files here. */
  write(name: string, song: Blob): Promise<boolean>;
  read(name: string): Promise<Blob | null>;
  remove(name: string): Promise<void>;
}

/** Opens a folder of the private file system lazily. */
export function songFiles(folder: string): SongFiles {
  const open = async (): Promise<FileSystemDirectoryHandle | null> => {
    try {
      const root = await (navigator.storage as StorageManager | undefined)?.getDirectory?.();
      return (await root?.getDirectoryHandle(folder, { create: true })) ?? null;
    } catch {
      return null; // private window, insecure page, or switched off
    }
  };
  return {
    async write(name, song) {
      const directory = await open();
      if (!directory) return false;
      const file = await directory.getFileHandle(name, { create: true });
      // Older Safari writes such files in workers only: IndexedDB takes the song there.
      if (!('createWritable' in file)) {
        await directory.removeEntry(name).catch(() => undefined);
        return false;
      }
      // Nothing is in place before close(): a crash in between leaves no half song.
      const writable = await file.createWritable();
      try {
        await writable.write(song);
        await writable.close();
      } catch (error) {
        await writable.abort().catch(() => undefined);
        await directory.removeEntry(name).catch(() => undefined);
        throw error;
      }
      return true;
    },
    async read(name) {
      const directory = await open();
      const file = await directory?.getFileHandle(name).catch(() => null);
      return (await file?.getFile().catch(() => null)) ?? null;
    },
    async remove(name) {
      const directory = await open();
      await directory?.removeEntry(name).catch(() => undefined);
    },
  };
}
