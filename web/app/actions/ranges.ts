/** Ranges made anew and their takes. The document holds seeds only; the dance follows it. */
import {
  frameOf,
  MAX_RANGES,
  type ProjectDocument,
  type Take,
  type TakeRange,
  type TimeRange,
} from '../../core/document';
import { MAX_TAKES } from '../../core/document-schema';
import { FIRST_TAKE } from '../../core/filler';
import spec from '../../core/spec.json';
import type { Context } from '../context';
import { rangeName } from '../range-name';
import { SHORTEST_RANGE, trimFrames } from '../recipe';
import type { State } from '../state';
import type { DanceActions } from './dance';

/** Who asks for another take wants to see another dance: at least this much variation. */
const LEAST_VARIATION = 0.6;
const HIGHEST_SEED = 2 ** 31 - 1;

/** True when two ranges have the same ends, give or take a frame. */
function sameRange(a: TimeRange, b: TimeRange): boolean {
  return Math.abs(frameOf(a.start) - frameOf(b.start)) <= 1 && Math.abs(frameOf(a.end) - frameOf(b.end)) <= 1;
}

/** The range with takes that the visitor means: the selected one, else the topmost at the playhead. */
export function rangeInHand(state: State): TakeRange | null {
  const { ranges } = state.document.value;
  const loop = state.loop.value;
  if (loop) return ranges.findLast((range) => sameRange(range, loop)) ?? null;
  const now = state.time.value;
  return ranges.findLast(({ start, end }) => start <= now && now < end) ?? null;
}

/** The first id of the form t1, t2... (or with another letter) that none has. */
function nextId(letter: string, list: readonly { id: string }[]): string {
  const taken = new Set(list.map(({ id }) => id));
  let number = list.length + 1;
  while (taken.has(`${letter}${number}`)) number += 1;
  return `${letter}${number}`;
}

/** The take that comes next in a range: a seed that neither the dance nor a take of the range has. The same document gives the same. */
function nextTake({ dials }: ProjectDocument, takes: readonly Take[]): Take {
  const taken = new Set([FIRST_TAKE.seed, dials.seed, ...takes.map((take) => take.seed)]);
  let seed = Math.max(...taken) + 1;
  if (seed > HIGHEST_SEED) for (seed = 0; taken.has(seed);) seed += 1;
  return { id: nextId('t', takes), seed, variation: Math.max(LEAST_VARIATION, dials.variation) };
}

/** Actions on ranges. */
export function rangeActions(context: Context, dances: DanceActions) {
  const { state, history } = context;
  /** The document whose dance is being made. */
  let pending: ProjectDocument | null = null;

  /** One step of undo, then its dance; a step whose dance is cancelled or fails is taken back. */
  async function change(label: string, edit: (document: ProjectDocument) => ProjectDocument): Promise<void> {
    const before = history.present;
    context.change(label, edit);
    const own = history.present;
    if (own === before) return;
    pending = own;
    const made = await dances.catchUp();
    if (!made && history.present === own) {
      history.abandon();
      context.sync();
    }
    if (pending === own) pending = null;
  }

  const find = (id: string) => state.document.value.ranges.find((range) => range.id === id);
  const withRange = (document: ProjectDocument, changed: TakeRange): ProjectDocument => ({
    ...document,
    ranges: document.ranges.map((range) => (range.id === changed.id ? changed : range)),
  });
  const called = (range: TimeRange) => rangeName(state.grid.value, range);

  /** The range inside the part that is danced; null with a notice when there is nothing to make anew. */
  function usable(range: TimeRange | null): TimeRange | null {
    if (!state.song.value || state.songJob.value) return null;
    if (!range) {
      context.notify('info', 'Select a range first: drag over the bar numbers on the timeline, or press L.');
      return null;
    }
    const frames = state.frames.value;
    const part = trimFrames(state.document.value.trim, frames) ?? { from: 0, to: frames };
    const [from, to] = [Math.max(part.from, frameOf(range.start)), Math.min(part.to, frameOf(range.end))];
    if (to - from < SHORTEST_RANGE) {
      context.notify('info', 'This range is too short, or outside the part that is danced: select a longer one.');
      return null;
    }
    const { start, end } = range;
    return { start: Math.max(start, part.from / spec.fps), end: Math.min(end, part.to / spec.fps) };
  }

  const actions = {
    /** Makes a range anew: another take of it, on stage as soon as it is made. Around it nothing changes. */
    async regenerateRange(wanted: TimeRange | null = state.loop.value): Promise<void> {
      const range = usable(wanted);
      if (!range) return;
      const { ranges } = state.document.value;
      const known = ranges.findLast((each) => sameRange(each, range));
      const busy = pending === history.present && state.generation.value.status !== 'idle';
      if (busy && known) return; // its next take is on the way
      if (known ? known.takes.length >= MAX_TAKES : ranges.length >= MAX_RANGES) {
        context.notify(
          'info',
          known ? 'This range has enough takes: delete some first.' : 'There are too many ranges.',
        );
        return;
      }
      await change(`Regenerate ${called(range)}`, (document) => {
        const take = nextTake(document, known?.takes ?? []);
        if (known) return withRange(document, { ...known, takes: [...known.takes, take], chosen: take.id });
        const made: TakeRange = { ...range, id: nextId('r', ranges), takes: [take], chosen: take.id };
        return { ...document, ranges: [...ranges, made] };
      });
    },

    /** Puts a take of a range on stage; null = the range as the whole dance has it. */
    async chooseTake(rangeId: string, takeId: string | null): Promise<void> {
      const range = find(rangeId);
      if (!range || range.chosen === takeId) return;
      const index = range.takes.findIndex(({ id }) => id === takeId);
      if (takeId !== null && index < 0) return;
      const name = takeId === null ? 'the whole dance' : `take ${index + 1} of ${range.takes.length}`;
      context.announce(`${called(range)}: ${name}.`);
      await change('Choose take', (document) => withRange(document, { ...range, chosen: takeId }));
    },

    /** The next (1) or previous (-1) take of the range in hand, the whole dance being one of them. */
    async stepTake(direction: -1 | 1, rangeId?: string): Promise<void> {
      const range = rangeId === undefined ? rangeInHand(state) : find(rangeId);
      if (!range) {
        context.notify('info', 'There are no takes here: select a range and regenerate it.');
        return;
      }
      const choices = [null, ...range.takes.map(({ id }) => id)];
      const next = (choices.indexOf(range.chosen) + direction + choices.length) % choices.length;
      await actions.chooseTake(range.id, choices[next]);
    },

    /** Deletes a take; the one before it takes its place on stage. The last take goes with its range. */
    async deleteTake(rangeId: string, takeId: string): Promise<void> {
      const range = find(rangeId);
      const index = range?.takes.findIndex(({ id }) => id === takeId) ?? -1;
      if (!range || index < 0) return;
      if (range.takes.length === 1) return actions.deleteRange(rangeId);
      const takes = range.takes.filter(({ id }) => id !== takeId);
      const chosen = range.chosen === takeId ? takes[Math.max(0, index - 1)].id : range.chosen;
      await change('Delete take', (document) => withRange(document, { ...range, takes, chosen }));
    },

    /** Deletes a range with all its takes: the whole dance is there again. */
    async deleteRange(rangeId: string): Promise<void> {
      const range = find(rangeId);
      if (!range) return;
      context.announce(`${called(range)}: back to the whole dance.`);
      await change('Delete range', (document) => ({
        ...document,
        ranges: document.ranges.filter(({ id }) => id !== rangeId),
      }));
    },

    /** Deletes all ranges with their takes. */
    async deleteRanges(): Promise<void> {
      if (state.document.value.ranges.length === 0) return;
      context.announce('Back to the whole dance.');
      await change('Delete all ranges', (document) => ({ ...document, ranges: [] }));
    },
  };
  return actions;
}
