/** From a file to a song that can be danced to. */
import type { SongReference } from '../../core/document';
import { seedMotion } from '../../core/seed';
import type { BeatGrid, Features } from '../../core/types';
import { isAbort, messageOf, type Context } from '../context';
import { hashBytes } from '../hash';
import { measureSince } from '../marks';
import type { Dance, Song } from '../state';
import { previewDance } from '../preview';
import type { DanceActions } from './dance';
import { fetchSong, songBytes } from './song-bytes';
import { songProjects, type FormerProject, type SongEntry } from './song-projects';
import { songShelf } from './song-shelf';

/** What was there before a song came in. */
interface Before extends FormerProject {
  song: Song | null;
  dance: Dance | null;
}

/** How a song comes in. */
export interface OpenOptions extends SongEntry {
  url?: string;
}

/** Actions on songs. */
export function songActions(context: Context, dance: DanceActions) {
  const { state, services, history } = context;
  const { player } = services;
  const bytesOf = songBytes(context);
  const shelf = songShelf(state);
  const projects = songProjects(context, follow);
  let job: AbortController | null = null;
  let fetchMissing: (wanted: SongReference) => Promise<boolean> = () => Promise.resolve(false);

  const show = (song: Song, shown: Dance | null) => {
    dance.cancel();
    player.load(song.reference.duration, song.buffer);
    state.song.value = song;
    state.dance.value = shown;
    state.report.value = null;
    state.loop.value = null;
    state.time.value = 0;
    state.view.value = { start: 0, pixelsPerSecond: 0 };
  };

  const update = (change: Partial<Song>) => {
    if (state.song.value) state.song.value = { ...state.song.value, ...change };
  };

  const isGenerated = () => state.dance.value?.kind === 'generated';

  /** The starting clip on the beats so far: something dances from the first second. */
  const preview = async (grid: BeatGrid, frames: number, signal: AbortSignal) => {
    const clip = state.seedClip.value;
    if (!clip || isGenerated()) return;
    const motion = await previewDance(
      (count, startTime) => seedMotion(clip, grid, count, { startTime }),
      frames,
      signal,
    );
    if (motion && !signal.aborted && !isGenerated()) {
      state.dance.value = { motion, kind: 'preview', inputs: null, result: null };
    }
  };

  const failed = (error: unknown, name: string): Error => {
    if (isAbort(error)) return error as Error;
    return new Error(`“${name}” could not be used. ${messageOf(error)}`);
  };

  async function open(file: Blob, options: OpenOptions): Promise<Song> {
    job?.abort(new DOMException('Another song was opened.', 'AbortError'));
    const own = (job = new AbortController());
    const { signal } = own;
    const opened = performance.now();
    const before: Before = {
      song: state.song.value,
      dance: state.dance.value,
      document: history.present,
      touched: !state.song.value?.demo || history.undoLabel !== null,
    };
    let shown = false;
    state.songJob.value = { name: options.name, stage: 'reading', fraction: 0 };
    context.announce(`Reading ${options.name}.`);
    try {
      if (file.size === 0) throw new Error('The file is empty: choose another one.');
      const bytes = await file.arrayBuffer();
      const hash = await hashBytes(bytes);
      const awaited = await projects.isAwaited(bytes);
      signal.throwIfAborted();
      state.songJob.value = { name: options.name, stage: 'decoding', fraction: 0 };
      const decoding = performance.now();
      const { buffer, duration } = await services.listener.decode(bytes, signal);
      measureSince('decode', decoding);
      signal.throwIfAborted();

      const reference = { name: options.name, hash, duration, ...(options.url ? { url: options.url } : {}) };
      const fresh: Song = {
        reference,
        buffer,
        waveform: null,
        features: null,
        grid: null,
        complete: false,
        demo: false,
      };
      const same = before.document.song?.hash === hash;
      shelf.keep();
      show(fresh, same ? before.dance : null);
      shown = true;
      // Before the analysis, not after it: the page may be left at any time.
      if (!options.restore) bytesOf.keep(hash, file, options.name);
      state.songJob.value = { name: options.name, stage: 'analysing', fraction: 0 };
      if (options.start) void dance.loadModel(undefined, state.document.value.engine).catch(() => undefined);

      let started = false;
      const begin = () => {
        if (started) return;
        started = true;
        projects.settle(reference, before, awaited, options);
        context.sync();
        if (!options.start) return;
        measureSince('first-dance', opened);
        player.setMuted(false);
        player.play();
      };
      let lastPreview: Promise<void> = Promise.resolve();
      const onHead = (features: Features, grid: BeatGrid) => {
        if (signal.aborted) return;
        update({ features, grid });
        lastPreview = preview(grid, Math.min(state.frames.value, features.frames), signal);
        void lastPreview.then(() => {
          if (!signal.aborted) begin();
        });
      };
      const analysis = await services.listener.analyse(
        buffer,
        {
          onProgress: (fraction, waveform) => {
            if (signal.aborted) return;
            state.songJob.value = { name: options.name, stage: 'analysing', fraction };
            if (waveform) update({ waveform });
          },
          onHead,
        },
        signal,
      );
      signal.throwIfAborted();
      measureSince('analyse', performance.now() - analysis.milliseconds);
      update({ features: analysis.features, grid: analysis.grid, waveform: analysis.waveform, complete: true });
      await lastPreview;
      await preview(analysis.grid, state.frames.value, signal);
      signal.throwIfAborted();
      begin();
      state.songJob.value = null;
      context.announce(`${options.name}: ${Math.round(analysis.grid.tempo)} beats per minute.`);
      bytesOf.remember(hash, file);
      return state.song.value!;
    } catch (error) {
      if (job === own) {
        state.songJob.value = null;
        if (shown) rollBack(before);
      }
      throw failed(error, options.name);
    }
  }

  function rollBack(before: Before): void {
    if (before.song) show(before.song, before.dance);
    if (history.present !== before.document) {
      if (history.undoLabel === 'New song' || history.undoLabel === 'Open project') history.abandon();
      if (history.present !== before.document) history.push(before.document, 'Back to the former song');
    }
    context.sync();
  }

  /** A song whose bytes are gone: the project can be looked at, and dropping the song brings the sound. */
  function showSilent(reference: SongReference): void {
    const { grid } = history.present;
    show({ reference, buffer: null, waveform: null, features: null, grid, complete: false, demo: false }, null);
    context.notify(
      'info',
      `Drop “${reference.name}” again to hear it and to dance to it: it is not kept in this browser.`,
    );
  }

  async function follow(): Promise<void> {
    const wanted = history.present.song;
    if (state.songJob.value || !wanted || wanted.hash === state.song.value?.reference.hash) return;
    const kept = shelf.get(wanted.hash);
    shelf.keep();
    if (kept) {
      show(kept.song, kept.dance);
      return;
    }
    if (await fetchMissing(wanted)) return;
    const blob = await services.storage.loadSong(wanted.hash).catch(() => null);
    if (!blob) {
      showSilent(wanted);
      return;
    }
    await open(blob, { name: wanted.name, start: false, keepHistory: true }).catch((error: unknown) => {
      if (!isAbort(error)) context.notify('error', messageOf(error));
    });
  }

  return {
    /** Opens a song and rejects with a clear message when that fails; what was there before stays. */
    openSong: open,

    /** What a drop or the file chooser does: opens the song, plays it and makes a dance; errors become notices. */
    async dropSong(file: File): Promise<void> {
      const dropped = performance.now();
      try {
        await open(file, { name: file.name, start: true });
        await dance.generateForPage();
        if (isGenerated()) measureSince('whole-dance', dropped);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },

    /** Loads a song for the automation API. */
    async loadSong(source: File | Blob | string): Promise<Song> {
      if (typeof source === 'string') {
        const file = await fetchSong(source);
        const name = decodeURIComponent(new URL(source, location.href).pathname.split('/').pop() || 'song');
        return open(file, { name, url: source, start: false });
      }
      if (!(source instanceof Blob)) throw new Error('loadSong needs a File, a Blob or an address.');
      return open(source, { name: source instanceof File ? source.name : 'song', start: false });
    },

    /** Stops reading a song and goes back to the former one. */
    cancelSong(): void {
      job?.abort(new DOMException('Cancelled.', 'AbortError'));
    },

    /** After undo or redo across songs: brings the sound of the document's song back. */
    followDocument: follow,

    /** Another way to get a song that is not kept here: the demo's. */
    onMissing(fetch: (wanted: SongReference) => Promise<boolean>): void {
      fetchMissing = fetch;
    },

    awaitSong: projects.awaitSong,

    /** The bytes of the song at hand as its file had them, or null when they are gone. */
    songFile: bytesOf.songFile,

    showSilent,

    /** Puts a song on stage that comes with its dance (the demo, a restored project). */
    showSong: show,
    updateSong: update,
    fetchSong,
  };
}

/** Actions on songs. */
export type SongActions = ReturnType<typeof songActions>;
