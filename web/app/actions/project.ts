/** Opening the page, saving and opening projects. */
import type { ProjectDocument } from '../../core/document';
import { parseDocument } from '../../core/document-read';
import { MAX_PROJECT_BYTES, readProject, writeProject, type SavedMotion } from '../../core/formats/project-file';
import { isAbort, messageOf, type Context } from '../context';
import { fileName, saveFile } from '../download';
import { isHashOf, motionHash } from '../hash';
import type { SavedDance } from '../ports';
import type { DanceActions } from './dance';
import type { DemoActions } from './demo';
import type { SongActions } from './song';
import { offerFormer, onSong } from './song-offers';

/** Of project files that are a zip: a type of our own, so that no browser unpacks them on its own. */
const ZIP_TYPE = 'application/x-posebeat';

/** Actions on whole projects. */
export function projectActions(context: Context, songs: SongActions, demo: DemoActions, dance: DanceActions) {
  const { state, services, history } = context;

  /** The camera is no part of what was made. */
  const sameWork = (a: ProjectDocument, b: ProjectDocument) =>
    JSON.stringify({ ...a, camera: null }) === JSON.stringify({ ...b, camera: null });

  /** Shows a dance that was kept, if it is of the song at hand. */
  function showKept(saved: SavedDance | null): void {
    dance.restoreDance(saved);
  }

  async function restore(): Promise<boolean> {
    const saved = await services.storage.load().catch(() => null);
    if (!saved) return false;
    let document: ProjectDocument;
    try {
      document = parseDocument(saved.document).document;
    } catch {
      return false; // what was saved is unreadable: better a working demo than a dead page
    }
    const { song } = document;
    if (!song) return false;
    const original = await demo.demoDocument();
    if (original?.song?.hash === song.hash) {
      if (sameWork(document, original)) {
        await demo.showDemo('first');
        history.reset({ ...history.present, camera: document.camera });
        context.sync();
      } else {
        await demo.showDemo({ document, step: null });
        showKept(saved.dance);
      }
      return true;
    }
    const blob = await services.storage.loadSong(song.hash).catch(() => null);
    if (blob) await songs.openSong(blob, { name: song.name, start: false, document, restore: true });
    else {
      history.reset(document);
      context.sync();
      songs.showSilent(song);
    }
    showKept(saved.dance);
    return true;
  }

  /**
   * Shows a document as one step that can be undone, with its song from `file`, the stage, the demo or this browser.
   * @returns false when its song is nowhere: then nothing has changed, and dropping the song opens it.
   */
  async function openDocument(document: ProjectDocument, file: Blob | null): Promise<boolean> {
    const here = state.song.value?.reference;
    const wanted = document.song;
    if (here && (wanted ? wanted.hash === here.hash : !file)) {
      history.push(onSong(document, here), 'Open project');
      context.sync();
      return true;
    }
    if (wanted && wanted.hash === (await demo.demoDocument())?.song?.hash) {
      await demo.showDemo({ document, step: 'Open project' });
      return true;
    }
    const blob = file ?? (wanted && (await services.storage.loadSong(wanted.hash).catch(() => null)));
    if (blob) {
      await songs.openSong(blob, { name: wanted?.name ?? 'song', start: false, document });
      return true;
    }
    if (wanted) {
      songs.awaitSong(document);
      return false;
    }
    history.push(document, 'Open project');
    context.sync();
    return true;
  }

  /** The bytes of a project file. */
  async function projectFile(withSong: boolean): Promise<Blob> {
    const document = state.document.value;
    const made = await savedMotion();
    if (!withSong || !document.song)
      return new Blob([writeProject(document, null, made)], { type: 'application/json' });
    const missing = `The file of “${document.song.name}” is no longer at hand: drop the song again, then save.`;
    const song = await songs.songFile();
    const bytes = await song?.arrayBuffer().catch(() => null);
    if (!bytes || !(await isHashOf(document.song.hash, bytes))) throw new Error(missing);
    return new Blob([writeProject(document, new Uint8Array(bytes), made)], { type: ZIP_TYPE });
  }

  /** The dance on stage, as a file tells of it; null where it is not that of the document. */
  async function savedMotion(): Promise<SavedMotion | null> {
    const shown = state.dance.value;
    if (shown?.kind !== 'generated' || !shown.byDials || state.stale.value) return null;
    const { model = '', backend = '' } = shown.result ?? {};
    return { motionHash: await motionHash(shown.motion), model, backend };
  }

  songs.onMissing(async (wanted) => {
    if ((await demo.demoDocument())?.song?.hash !== wanted.hash) return false;
    await demo.showDemo('follow');
    return true;
  });

  return {
    /**
     * Opens the page: the visitor's last work, else the demo.
     * @param instead - Opens something else (a link) where it can; resolves with whether it did.
     */
    async start(instead?: () => Promise<boolean>): Promise<void> {
      const [poses, seeds] = await Promise.allSettled([
        services.assets.poses(),
        services.assets.seeds(),
        services.tabs?.start(),
      ]);
      if (poses.status === 'fulfilled') state.poses.value = poses.value;
      if (seeds.status === 'fulfilled') state.seeds.value = seeds.value;
      if (poses.status === 'rejected' || seeds.status === 'rejected') {
        context.notify('error', 'The pose library could not be loaded. Reload the page to try again.');
      }
      try {
        if (!(await instead?.()) && !(await restore())) await demo.showDemo('first');
      } catch (error) {
        context.notify('info', `The demo could not be shown (${messageOf(error)}). Drop a song to start.`);
      }
      state.ready.value = true;
    },

    openDocument,
    showKept,
    sameWork,
    projectFile,

    /** Saves the project as a file, with the song inside or without; what is wrong becomes a notice. */
    async saveProject(withSong: boolean): Promise<void> {
      try {
        const blob = await projectFile(withSong);
        saveFile(blob, fileName(state.document.value.song?.name ?? 'dance', 'posebeat'));
      } catch (error) {
        context.notify('error', messageOf(error));
      }
    },

    /** Opens a project file; a wrong one becomes a notice and changes nothing. */
    async openProject(file: Blob): Promise<void> {
      const former = history.present;
      const touched = !state.song.value?.demo || history.undoLabel !== null;
      try {
        if (file.size > MAX_PROJECT_BYTES) throw new Error('This file is too large for a Posebeat project.');
        const { document, repairs, song } = readProject(new Uint8Array(await file.arrayBuffer()));
        const bytes = song?.slice().buffer;
        if (bytes && document.song && !(await isHashOf(document.song.hash, bytes))) {
          throw new Error('The song inside this file is not the song of its project: the file is damaged.');
        }
        const name = document.song?.name ?? '';
        const opened = await openDocument(document, bytes ? new Blob([bytes]) : null);
        if (repairs.length > 0) context.notify('info', `Opened with repairs. ${repairs.join(' ')}`);
        if (!opened) {
          context.notify('info', `Now drop “${name}”, the song of this project.`);
          return;
        }
        context.announce(name ? `Project of ${name} opened.` : 'Project opened.');
        const replaced = former.song?.hash !== history.present.song?.hash;
        if (replaced && touched) offerFormer(context, former, 'The project is open.', songs.followDocument);
        // A project holds what its dance is made from, not the dance.
        if (state.stale.value && state.song.value?.buffer) void dance.generateForPage();
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },
  };
}

/** Actions on whole projects. */
export type ProjectActions = ReturnType<typeof projectActions>;
