/** Opening the page, saving and opening projects. */
import type { ProjectDocument } from '../../core/document';
import { parseDocument } from '../../core/document-read';
import { isAbort, messageOf, type Context } from '../context';
import type { Song } from '../state';
import type { DanceActions } from './dance';
import type { SongActions } from './song';

/** Actions on whole projects. */
export function projectActions(context: Context, songs: SongActions, dance: DanceActions) {
  const { state, services, history } = context;
  const { player } = services;

  /** The demo's song arrives after its dance: the timer already runs, the sound joins in. */
  async function bringSound(song: Song, url: string): Promise<void> {
    const { signal } = new AbortController();
    const bytes = await (await songs.fetchSong(url)).arrayBuffer();
    const { buffer } = await services.listener.decode(bytes, signal);
    if (state.song.value?.reference.hash !== song.reference.hash) return;
    songs.updateSong({ buffer });
    player.attach(buffer);
    const analysis = await services.listener.analyse(
      buffer,
      { onProgress: (_, waveform) => waveform && isCurrent(song) && songs.updateSong({ waveform }) },
      signal,
    );
    if (!isCurrent(song)) return;
    songs.updateSong({
      features: analysis.features,
      grid: analysis.grid,
      waveform: analysis.waveform,
      complete: true,
    });
    void dance.measureShown();
  }

  const isCurrent = (song: Song) => state.song.value?.reference.hash === song.reference.hash;

  async function openDemo(own?: ProjectDocument): Promise<void> {
    const demo = await services.assets.demo();
    const document = own ?? demo.document;
    if (!demo.document.song) throw new Error('The demo has no song.');
    const song: Song = {
      reference: demo.document.song,
      buffer: null,
      waveform: null,
      features: null,
      grid: demo.document.grid,
      complete: false,
      demo: true,
    };
    history.reset(document);
    context.sync();
    const inputs = { keyPoses: demo.document.keyPoses, grid: document.grid, dials: document.dials };
    songs.showSong(song, { motion: demo.motion, kind: 'demo', inputs, result: null });
    if (!own) {
      player.setMuted(true);
      player.play();
    }
    bringSound(song, demo.songUrl).catch((error: unknown) => {
      if (!isAbort(error)) context.notify('error', `The demo’s song could not be played. ${messageOf(error)}`);
    });
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
    if (!document.song) return false;
    const demo = await services.assets.demo().catch(() => null);
    if (demo?.document.song?.hash === document.song.hash) {
      const untouched = JSON.stringify(document) === JSON.stringify(demo.document);
      await openDemo(untouched ? undefined : document);
      return true;
    }
    const blob = await services.storage.loadSong(document.song.hash).catch(() => null);
    if (!blob) return false;
    const song = document.song;
    await songs.openSong(blob, { name: song.name, start: false, document });
    if (saved.dance?.hash === song.hash && saved.dance.motion.frames === state.frames.value) {
      const { motion, uncorrected, keyStrength } = saved.dance;
      const { keyPoses, grid, dials } = state.document.value;
      const inputs = { keyPoses, grid, dials };
      state.dance.value = { motion, kind: 'generated', inputs, result: null, uncorrected, keyStrength };
      void dance.measureShown();
    }
    return true;
  }

  return {
    /** Opens the page: the visitor's last work, else the demo. */
    async start(): Promise<void> {
      const [poses, seeds] = await Promise.allSettled([services.assets.poses(), services.assets.seeds()]);
      if (poses.status === 'fulfilled') state.poses.value = poses.value;
      if (seeds.status === 'fulfilled') state.seeds.value = seeds.value;
      if (poses.status === 'rejected' || seeds.status === 'rejected') {
        context.notify('error', 'The pose library could not be loaded. Reload the page to try again.');
      }
      try {
        if (!(await restore())) await openDemo();
      } catch (error) {
        context.notify('info', `The demo could not be shown (${messageOf(error)}). Drop a song to start.`);
      }
      state.ready.value = true;
    },

    openDemo,

    /** The project as a file. */
    projectBlob(): Blob {
      return new Blob([JSON.stringify(state.document.value)], { type: 'application/json' });
    },

    /** Opens a saved project; a wrong file becomes a notice and changes nothing. */
    async openProject(file: File): Promise<void> {
      try {
        if (file.size > 50e6) throw new Error('This file is too large for a Posebeat project.');
        let raw: unknown;
        try {
          raw = JSON.parse(await file.text());
        } catch {
          throw new Error('This file is no Posebeat project: it is damaged or of another kind.');
        }
        const { document, repairs } = parseDocument(raw);
        if (repairs.length > 0) context.notify('info', `Opened with repairs. ${repairs.join(' ')}`);
        const hash = document.song?.hash;
        if (!hash || hash === state.song.value?.reference.hash) {
          history.push({ ...document, song: state.document.value.song }, 'Open project');
          context.sync();
          return;
        }
        const blob = await services.storage.loadSong(hash).catch(() => null);
        if (blob) {
          await songs.openSong(blob, { name: document.song!.name, start: false, document });
          return;
        }
        songs.awaitSong(document);
        context.notify('info', `Now drop “${document.song!.name}”, the song of this project.`);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },
  };
}
