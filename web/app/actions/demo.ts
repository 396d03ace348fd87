/** The opening demo: a dance that is there at once, whose song follows. */
import type { ProjectDocument } from '../../core/document';
import { isAbort, messageOf, type Context } from '../context';
import type { Demo } from '../ports';
import { inputsOf } from '../recipe';
import type { Song } from '../state';
import type { DanceActions } from './dance';
import type { SongActions } from './song';

/** How the demo opens. */
export type DemoOpening =
  /** As it comes: silent and dancing. */
  | 'first'
  /** Undo brought it back: only song and dance. */
  | 'follow'
  /** With this document; where a step is named, it is one that can be undone. */
  | { document?: ProjectDocument; step: string | null };

/** Actions on the demo. */
export function demoActions(context: Context, songs: SongActions, dance: DanceActions) {
  const { state, services, history } = context;
  const { player } = services;

  // The visitor may have dropped the same file meanwhile: that is another song then.
  const isCurrent = ({ reference }: Song) => {
    const now = state.song.value;
    return now !== null && now.demo && now.reference.hash === reference.hash;
  };

  /** The demo's song arrives after its dance: the timer already runs, the sound joins in. */
  async function bringSound(song: Song, url: string): Promise<void> {
    const { signal } = new AbortController();
    const bytes = await (await songs.fetchSong(url)).arrayBuffer();
    const { buffer } = await services.listener.decode(bytes, signal);
    if (!isCurrent(song)) return;
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

  function show(demo: Demo, opening: DemoOpening): void {
    if (!demo.document.song) throw new Error('The demo has no song.');
    const song: Song = {
      reference: { ...demo.document.song, url: demo.songUrl },
      buffer: null,
      waveform: null,
      features: null,
      grid: demo.document.grid,
      complete: false,
      demo: true,
    };
    if (opening === 'first') history.reset(demo.document);
    else if (opening !== 'follow') {
      const next = opening.document ?? { ...demo.document, camera: history.present.camera };
      if (opening.step === null) history.reset(next);
      else history.push(next, opening.step);
    }
    context.sync();
    const { grid, dials } = history.present;
    const inputs = { ...inputsOf(demo.document), grid, dials };
    songs.showSong(song, { motion: demo.motion, kind: 'demo', inputs, result: null });
    // Whoever asked for less motion starts it by hand, and then it is heard.
    if (opening === 'first' && !globalThis.matchMedia?.('(prefers-reduced-motion: reduce)').matches) {
      player.setMuted(true);
      player.play();
    }
    bringSound(song, demo.songUrl).catch((error: unknown) => {
      if (!isAbort(error)) context.notify('error', `The demo’s song could not be played. ${messageOf(error)}`);
    });
  }

  return {
    /** Opens the demo once more, as one step that can be undone; errors become notices. */
    async openDemo(): Promise<void> {
      try {
        show(await services.assets.demo(), { step: 'Show the demo' });
      } catch (error) {
        context.notify('error', `The demo could not be shown. ${messageOf(error)}`);
      }
    },

    /** Shows the demo one way or another; throws when it cannot. */
    showDemo: async (opening: DemoOpening) => show(await services.assets.demo(), opening),

    /** The demo as it comes, or null where it cannot be loaded. */
    demoDocument: () =>
      services.assets.demo().then(
        (demo) => demo.document,
        () => null,
      ),
  };
}

/** Actions on the demo. */
export type DemoActions = ReturnType<typeof demoActions>;
