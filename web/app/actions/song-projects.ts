/** Which project a song that comes in belongs to. */
import { createDocument, type ProjectDocument, type SongReference } from '../../core/document';
import type { Context } from '../context';
import { isHashOf } from '../hash';
import { offerFormer, offerSong, onSong } from './song-offers';

/** How a song comes in, as far as its project is concerned. */
export interface SongEntry {
  name: string;
  /** Play it and make a dance by itself: what a drop does and the automation API does not. */
  start: boolean;
  /** A document that this song belongs to; otherwise the song begins a new one, unless it is the same song. */
  document?: ProjectDocument;
  /** The document is what the page opens with: nothing before it can be brought back. */
  restore?: boolean;
  /** Leave the document and its history alone: undo brought us here. */
  keepHistory?: boolean;
}

/** What was there before the song. */
export interface FormerProject {
  document: ProjectDocument;
  /** There is work of the visitor's own in it, not only the demo. */
  touched: boolean;
}

/**
 * Puts projects under songs.
 * @param follow brings the sound of the document's song back
 */
export function songProjects(context: Context, follow: () => Promise<void>) {
  const { history } = context;
  /** A project whose song is not here yet. */
  let waiting: ProjectDocument | null = null;

  const offerOther = (name: string, project: ProjectDocument) =>
    offerSong(context, project, name, () => {
      if (waiting === project) waiting = null;
    });

  return {
    /** Opens this project as soon as its song is dropped; null = no longer. */
    awaitSong(document: ProjectDocument | null): void {
      waiting = document;
    },

    /** Whether these bytes are the song that a project waits for. */
    isAwaited: async (bytes: ArrayBuffer): Promise<boolean> =>
      waiting?.song ? isHashOf(waiting.song.hash, bytes) : false,

    /** Puts the project under a song: the one it was opened for, a new one, or the former one where it is the same song. */
    settle(reference: SongReference, former: FormerProject, awaited: boolean, entry: SongEntry): void {
      const given = entry.document ?? (awaited ? waiting : null);
      if (awaited) waiting = null;
      if (entry.keepHistory) return;
      const same = former.document.song?.hash === reference.hash;
      if (given) {
        const next = onSong(given, reference);
        if (entry.restore) history.reset(next);
        else history.push(next, 'Open project');
      } else if (!same) {
        // The view stays as the visitor turned it.
        const { dials, camera } = former.document;
        history.push({ ...createDocument(reference, dials), camera }, 'New song');
      }
      if (!entry.start || given) return;
      if (waiting) offerOther(entry.name, waiting);
      else if (!same && former.touched)
        offerFormer(context, former.document, `“${entry.name}” begins a new project.`, follow);
    },
  };
}
