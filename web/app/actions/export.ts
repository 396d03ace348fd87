/** The dance as a file for other programs. */
import type { TimeRange } from '../../core/document';
import { DEFAULT_LOOK, lookByte, type FigureLook } from '../../core/figure-look';
import type { GlbFigure } from '../../core/formats/glb-write';
import type { MotionNotes } from '../../core/formats/motion-json';
import { sliceMotion } from '../../core/motion';
import type { Motion } from '../../core/types';
import type { Dance } from '../state';
import { isAbort, messageOf, type Context } from '../context';
import { fileName, saveFile } from '../download';
import { extensionOf, FRAME_RATES, MOTION_FORMATS, MOTION_TYPES, type MotionFormat } from '../motion-formats';
import type { MotionFileWriter } from '../export-client';
import { originOf } from '../motion-origin';
import { trimFrames } from '../recipe';

/** How a motion file is made; everything may be left out. */
export interface MotionFileOptions {
  /** Frames per second: 24, 30 (as the dance is), 60 or 120; between frames rotations go by SLERP. */
  fps?: number;
  /** BVH: a unit is a metre or a centimetre. Without it, a centimetre, as most animation programs have it. */
  units?: 'm' | 'cm';
  /** GLB and FBX: with our figure (true, the default), or the skeleton alone. */
  figure?: boolean;
  /**
   * What of the dance: all of it, the part that the song is trimmed to, the selected stretch (the loop), or seconds of the song. Without
   * it, the trimmed part, or all where nothing is trimmed.
   */
  range?: 'all' | 'trim' | 'loop' | TimeRange;
}

/** Frames [from, to) of a dance. */
export interface Frames {
  from: number;
  to: number;
}

let figure: Promise<GlbFigure> | undefined;
let dressed: number | undefined;

/** Our figure for GLB files, made once for a look. */
export function loadGlbFigure(look: Readonly<FigureLook> = DEFAULT_LOOK): Promise<GlbFigure> {
  if (dressed !== lookByte(look)) figure = undefined;
  dressed = lookByte(look);
  figure ??= (async () => {
    const [{ loadFigure }, { figureForGlb }] = await Promise.all([
      import('../../scene/figure-asset'),
      import('../../scene/figure-glb'),
    ]);
    return figureForGlb(await loadFigure(), look);
  })();
  figure.catch(() => (figure = undefined));
  return figure;
}

const inWorker: MotionFileWriter = async (...call) => (await import('../export-client')).writeInWorker(...call);

/** Actions on motion files. */
export function exportActions(context: Context) {
  const { state, services } = context;
  const write = services.writeMotionFile ?? inWorker;
  let running: AbortController | null = null;

  const dance = (): Dance => {
    const shown = state.onStage.value;
    if (!shown || shown.kind === 'preview') {
      throw new Error('There is no dance yet: drop a song and press Generate, then export it.');
    }
    return shown;
  };

  /** The frames that a wish for a part means. */
  const framesOf = (motion: Motion, wish: MotionFileOptions['range']): Frames => {
    const all = { from: 0, to: motion.frames };
    const trim = trimFrames(state.document.value.trim, motion.frames);
    if (wish === undefined) return trim ?? all;
    if (wish === 'all') return all;
    if (wish === 'trim') {
      if (!trim) throw new Error('The song is not trimmed: export all of the dance.');
      return trim;
    }
    const range = wish === 'loop' ? state.loop.value : wish;
    if (!range) throw new Error('No stretch is selected: drag one on the timeline’s beats first.');
    const from = Math.round(range.start * motion.fps);
    // The end's own frame is part of it: two seconds are two seconds.
    const to = Math.min(motion.frames, Math.round(range.end * motion.fps) + 1);
    if (!(range.start >= 0 && range.end > range.start && from < motion.frames - 1)) {
      const length = (motion.frames / motion.fps).toFixed(2);
      throw new Error(`range must be {start, end} in seconds inside the dance (0 to ${length}).`);
    }
    return { from, to };
  };

  const notesOf = (motion: Motion, { from, to }: Frames): MotionNotes => {
    const { song, keyPoses } = state.document.value;
    const [start, end] = [from / motion.fps, (to - 1) / motion.fps];
    const inside = (time: number) => time >= start - 1e-6 && time <= end + 1e-6;
    const shifted = (time: number) => Number((time - start).toFixed(4));
    const grid = state.grid.value;
    const keys = state.onStage.value?.inputs?.keyPoses ?? keyPoses;
    return {
      ...(song && grid
        ? {
            song: {
              name: song.name,
              start,
              tempo: grid.tempo,
              beatsPerBar: grid.beatsPerBar,
              beats: grid.beats.filter(inside).map(shifted),
              downbeats: grid.downbeats.filter(inside).map(shifted),
            },
          }
        : {}),
      keyPoses: keys
        .filter(({ time }) => inside(time))
        .map(({ time, name }) => ({ time: shifted(time), ...(name ? { name } : {}) })),
    };
  };

  /**
   * The dance on stage as a file.
   * @throws Error with what is wrong and what to do: no dance, an unknown option, a stretch that is not there
   */
  async function exportMotion(format: MotionFormat, options: MotionFileOptions = {}): Promise<Blob> {
    if (!MOTION_FORMATS.includes(format)) throw new Error(`There is no motion format "${String(format)}".`);
    const { fps = 30, units = 'cm', figure: withFigure = true } = options;
    if (!(FRAME_RATES as readonly number[]).includes(fps)) {
      throw new Error(`fps must be one of ${FRAME_RATES.join(', ')}.`);
    }
    if (units !== 'm' && units !== 'cm') throw new Error('units must be "m" or "cm".');
    const shown = dance();
    const { motion } = shown;
    const avatar = format === 'avatar' ? state.avatar.value?.source : undefined;
    if (format === 'avatar' && !avatar) {
      throw new Error('There is no character of your own on the stage: choose one first.');
    }
    const part = framesOf(motion, options.range);
    running?.abort(new DOMException('Another file was asked for.', 'AbortError'));
    const own = (running = new AbortController());
    const job = (fraction: number) => {
      if (running === own) state.exportJob.value = { format, fraction };
    };
    job(0);
    try {
      const name = state.document.value.song?.name ?? 'dance';
      const notes = notesOf(motion, part);
      const dressed = withFigure && (format === 'glb' || format === 'fbx');
      const [origin, figure] = await Promise.all([
        originOf(state, shown, part),
        dressed ? loadGlbFigure(state.document.value.look) : undefined,
      ]);
      own.signal.throwIfAborted();
      const bytes = await write(
        {
          format,
          motion: sliceMotion(motion, part.from, part.to),
          fps,
          units,
          name,
          notes: { ...notes, origin },
          ...(figure ? { figure } : {}),
          ...(avatar ? { avatar } : {}),
        },
        job,
        own.signal,
      );
      return new Blob([bytes], { type: MOTION_TYPES[format] });
    } finally {
      if (running === own) {
        running = null;
        state.exportJob.value = null;
      }
    }
  }

  return {
    exportMotion,

    /** How many frames of the dance on stage an export would take; null when there is no dance or no such part. */
    exportFrames(range: MotionFileOptions['range']): number | null {
      try {
        const { from, to } = framesOf(dance().motion, range);
        return to - from;
      } catch {
        return null;
      }
    },

    /** Saves the dance as a file for the visitor to keep; what is wrong becomes a notice. */
    async saveMotion(format: MotionFormat, options: MotionFileOptions = {}): Promise<void> {
      try {
        const blob = await exportMotion(format, options);
        const name = fileName(state.document.value.song?.name ?? 'dance', extensionOf(format));
        saveFile(blob, name);
        context.announce(`${name} is saved.`);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },

    /** Stops writing a file. */
    cancelExport(): void {
      running?.abort(new DOMException('Cancelled.', 'AbortError'));
    },

    /** Opens or closes the export panel. */
    toggleExport(open = !state.exportOpen.value): void {
      state.exportOpen.value = open;
    },
  };
}
