/** The last songs with their dances, in memory, so that undo across songs need not listen to them again. */
import type { Dance, Song, State } from '../state';
import { SHELF_SIZE } from './song-bytes';

/** A song and the dance that goes with it. */
export interface Shelved {
  song: Song;
  dance: Dance | null;
}

/** An empty shelf. */
export function songShelf(state: State) {
  const shelf = new Map<string, Shelved>();
  return {
    /** Puts the song at hand there, where it is wholly known. */
    keep(): void {
      const song = state.song.value;
      if (!song?.complete) return;
      shelf.delete(song.reference.hash);
      shelf.set(song.reference.hash, { song, dance: state.dance.value });
      for (const hash of [...shelf.keys()].slice(0, -SHELF_SIZE)) shelf.delete(hash);
    },

    /** A song by the hash of its file. */
    get: (hash: string): Shelved | undefined => shelf.get(hash),
  };
}
