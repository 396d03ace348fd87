/** The part of the song to dance to. */
import { effect } from '@preact/signals';
import type { ProjectDocument, TimeRange } from '../../core/document';
import type { Context } from '../context';

/** The shortest part, seconds. */
export const MIN_TRIM = 2;
/** An end this near to the song's own is the song's own, seconds. */
const WHOLE = 0.02;

/** Actions on the trim. */
export function trimActions(context: Context) {
  const { state, services, history } = context;
  let origin: ProjectDocument | null = null;

  effect(() => {
    void state.song.value; // a new song in the player starts without bounds
    services.player.setBounds(state.document.value.trim);
  });

  /** Inside the song and long enough; null = all of it. */
  const checked = (range: TimeRange | null): TimeRange | null => {
    const duration = state.duration.value;
    if (!range || duration < MIN_TRIM) return null;
    const start = Math.min(Math.max(range.start, 0), duration - MIN_TRIM);
    const end = Math.min(Math.max(range.end, start + MIN_TRIM), duration);
    return start <= WHOLE && end >= duration - WHOLE
      ? null
      : { start: start <= WHOLE ? 0 : start, end: end >= duration - WHOLE ? duration : end };
  };
  const same = (a: TimeRange | null, b: TimeRange | null) => a?.start === b?.start && a?.end === b?.end;
  const withTrim = (document: ProjectDocument, range: TimeRange | null): ProjectDocument => {
    const trim = checked(range);
    return same(document.trim, trim) ? document : { ...document, trim };
  };
  /** The part in force. */
  const part = (document: ProjectDocument): TimeRange => document.trim ?? { start: 0, end: state.duration.value };
  /** One end somewhere else; the other one stays, however far the first is pulled. */
  const moved = (document: ProjectDocument, end: keyof TimeRange, time: number): ProjectDocument => {
    const now = part(document);
    const limited = end === 'start' ? Math.min(time, now.end - MIN_TRIM) : Math.max(time, now.start + MIN_TRIM);
    return withTrim(document, { ...now, [end]: limited });
  };
  const say = () => {
    const { trim } = state.document.value;
    context.announce(
      trim ? `Dances from ${trim.start.toFixed(1)} to ${trim.end.toFixed(1)} seconds.` : 'Dances to the whole song.',
    );
  };
  const setTrim = (range: TimeRange | null): void => {
    context.change(checked(range) ? 'Trim song' : 'Whole song', (document) => withTrim(document, range));
    say();
  };

  return {
    /** Dances to a part of the song, at least two seconds, or with null to all of it: one step of undo. */
    setTrim,

    /** The looped stretch becomes the part to dance to; the loop has done its work and ends. */
    trimToLoop(): void {
      const { loop } = services.player;
      if (!loop) return;
      services.player.setLoop(null);
      setTrim(loop);
    },

    /** Moves one end to a time: one step of undo. */
    moveTrim(end: 'start' | 'end', time: number): void {
      context.change('Trim song', (document) => moved(document, end, time));
      say();
    },

    /** A drag of one end begins. */
    beginTrimDrag(): void {
      origin = history.present;
      history.capture();
    },

    /** One end at a time, seconds, while it is dragged. */
    previewTrimDrag(end: 'start' | 'end', time: number): void {
      if (!origin || !history.capturing) return;
      history.preview(moved(origin, end, time));
      context.sync();
    },

    /** The drag ends where it is: one step of undo. */
    commitTrimDrag(): void {
      if (!origin) return;
      if (same(origin.trim, history.present.trim)) history.discard();
      else history.commit('Trim song');
      origin = null;
      context.sync();
      say();
    },

    /** The drag never happened. */
    discardTrimDrag(): void {
      if (!origin) return;
      origin = null;
      history.discard();
      context.sync();
    },
  };
}
