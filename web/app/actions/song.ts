/** From a file to a song that can be danced to. */
import { createDocument, type ProjectDocument, type SongReference } from '../../core/document';
import { seedMotion } from '../../core/seed';
import type { BeatGrid, Features } from '../../core/types';
import { isAbort, messageOf, type Context } from '../context';
import { hashBytes, isHashOf } from '../hash';
import { measureSince } from '../marks';
import type { Song } from '../state';
import { previewDance } from '../preview';
import type { DanceActions } from './dance';
import { fetchSong, SHELF_SIZE, songBytes } from './song-bytes';
import { offerFormer, offerSong, onSong } from './song-offers';

/** A song and the dance that goes with it, kept for undo across songs. */
interface Shelf {
  song: Song;
  dance: Context['state']['dance']['value'];
}

/** How a song comes in. */
export interface OpenOptions {
  name: string;
  url?: string;
  /** Play it and make a dance by itself: what a drop does and the automation API does not. */
  start: boolean;
  /** A document that this song belongs to; otherwise the song begins a new one, unless it is the same song. */
  document?: ProjectDocument;
  /** The document is what the page opens with: nothing before it can be brought back. */
  restore?: boolean;
  /** Leave the document and its history alone: undo brought us here. */
  keepHistory?: boolean;
}

/** Actions on songs. */
export function songActions(context: Context, dance: DanceActions) {
  const { state, services, history } = context;
  const { player } = services;
  const bytesOf = songBytes(context);
  const shelf = new Map<string, Shelf>();
  let job: AbortController | null = null;
  /** A project whose song is not here yet. */
  let waiting: ProjectDocument | null = null;
  let fetchMissing: (wanted: SongReference) => Promise<boolean> = () => Promise.resolve(false);
  const keepOnShelf = () => {
    const song = state.song.value;
    if (!song?.complete) return;
    shelf.delete(song.reference.hash);
    shelf.set(song.reference.hash, { song, dance: state.dance.value });
    for (const hash of [...shelf.keys()].slice(0, -SHELF_SIZE)) shelf.delete(hash);
  };

  const show = (song: Song, shown: Shelf['dance']) => {
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

  const offerOther = (name: string, project: ProjectDocument) =>
    offerSong(context, project, name, () => {
      if (waiting === project) waiting = null;
    });

  async function open(file: Blob, options: OpenOptions): Promise<Song> {
    job?.abort(new DOMException('Another song was opened.', 'AbortError'));
    const own = (job = new AbortController());
    const { signal } = own;
    const opened = performance.now();
    const before = {
      song: state.song.value,
      dance: state.dance.value,
      document: history.present,
      /** There is work of the visitor's own, not only the demo. */
      touched: !state.song.value?.demo || history.undoLabel !== null,
    };
    let shown = false;
    state.songJob.value = { name: options.name, stage: 'reading', fraction: 0 };
    context.announce(`Reading ${options.name}.`);
    try {
      if (file.size === 0) throw new Error('The file is empty: choose another one.');
      const bytes = await file.arrayBuffer();
      const hash = await hashBytes(bytes);
      const awaited = waiting?.song ? await isHashOf(waiting.song.hash, bytes) : false;
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
      keepOnShelf();
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
        const given = options.document ?? (awaited ? waiting : null);
        if (awaited) waiting = null;
        if (!options.keepHistory) {
          const former = before.document;
          if (given) {
            const next = onSong(given, reference);
            if (options.restore) history.reset(next);
            else history.push(next, 'Open project');
          } else if (!same) {
            // The view stays as the visitor turned it.
            history.push({ ...createDocument(reference, former.dials), camera: former.camera }, 'New song');
          }
          if (options.start && !given && waiting) offerOther(options.name, waiting);
          else if (options.start && !given && !same && before.touched)
            offerFormer(context, former, `“${options.name}” begins a new project.`, follow);
        }
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

  function rollBack(before: { song: Song | null; dance: Shelf['dance']; document: ProjectDocument }): void {
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
    keepOnShelf();
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

    /** Opens this project as soon as its song is dropped; null = no longer. */
    awaitSong(document: ProjectDocument | null): void {
      waiting = document;
    },

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
