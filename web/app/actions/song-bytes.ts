/** The bytes of songs: fetched, kept for the next visit, and given back for a project with its song inside. */
import { MAX_SONG_BYTES } from '../../core/formats/project-file';
import type { Context } from '../context';

/** Songs kept in memory beside the current one. */
export const SHELF_SIZE = 2;

/** The files of songs. */
export function songBytes(context: Context) {
  const { state, services } = context;
  let toldNotKept = false;
  /** The files of the songs of this visit, for saving a project with its song inside. */
  const files = new Map<string, Blob>();

  return {
    /** Holds a song's file as long as its song may be asked for. */
    remember(hash: string, file: Blob): void {
      files.delete(hash);
      files.set(hash, file);
      for (const old of [...files.keys()].slice(0, -1 - SHELF_SIZE)) files.delete(old);
    },

    /** Keeps a song in this browser; says so, once, where that fails. */
    keep(hash: string, file: Blob, name: string): void {
      const complain = () => {
        if (toldNotKept) return;
        toldNotKept = true;
        context.notify(
          'info',
          `“${name}” could not be kept in this browser: after a reload you would have to drop it again. Save the project with the song inside to be safe.`,
        );
      };
      if (file.size > MAX_SONG_BYTES) complain();
      else services.storage.saveSong(hash, file).catch(complain);
    },

    /** The bytes of the song at hand as its file had them, or null when they are gone. */
    async songFile(): Promise<Blob | null> {
      const reference = state.song.value?.reference;
      if (!reference) return null;
      const kept = await services.storage.loadSong(reference.hash).catch(() => null);
      if (kept) return kept;
      const file = files.get(reference.hash) ?? null;
      if (file || !reference.url) return file;
      return fetchSong(reference.url).catch(() => null);
    },
  };
}

/** Fetches a song; rejects with what to do. */
export async function fetchSong(address: string): Promise<Blob> {
  let response: Response;
  try {
    response = await fetch(address);
  } catch {
    throw new Error(
      `The song at ${address} could not be fetched: the address is wrong, or its server does not allow it.`,
    );
  }
  if (!response.ok) throw new Error(`The song at ${address} could not be fetched (${response.status}).`);
  return response.blob();
}
