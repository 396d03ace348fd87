/** What a new song means for the projects around it, and what is offered about that. */
import type { ProjectDocument, SongReference } from '../../core/document';
import { parseDocument } from '../../core/document-read';
import type { Context } from '../context';

/** A longer or shorter copy of a song is another sound, seconds. */
const SAME_LENGTH = 0.1;

/**
 * A project with the song that was opened for it. Its own words about the song stay, so that it is saved as it was opened; what lies
 * beyond the end of a shorter song is left out.
 */
export function onSong(document: ProjectDocument, reference: SongReference): ProjectDocument {
  const own = document.song;
  if (own && Math.abs(own.duration - reference.duration) < SAME_LENGTH) {
    return own.hash === reference.hash ? document : { ...document, song: { ...own, hash: reference.hash } };
  }
  return parseDocument({ ...document, song: reference }).document;
}

/** Something put a project away: it can be brought back, also when much came after it. */
export function offerFormer(
  { history, sync, notify }: Context,
  former: ProjectDocument,
  text: string,
  follow: () => Promise<void>,
): void {
  if (former.keyPoses.length === 0 || !former.song) return;
  notify('info', text, {
    label: 'Bring back the former one',
    run: () => {
      history.push(former, 'Bring back a project');
      sync();
      void follow();
    },
  });
}

/** The song that was dropped is not the one that a project waits for; another recording of it may do. */
export function offerSong(
  { state, history, sync, notify }: Context,
  project: ProjectDocument,
  name: string,
  taken: () => void,
): void {
  notify('info', `“${name}” is not “${project.song?.name ?? ''}”, the song of the project that you opened.`, {
    label: 'Use it for that project',
    run: () => {
      const reference = state.song.value?.reference;
      if (!reference) return;
      taken();
      history.push(onSong(project, reference), 'Open project');
      sync();
    },
  });
}
