/** Suggesting key poses: a whole timeline, a range or the gaps; and other poses for one of them. */
import { nextKeyId, type TimeRange } from '../../core/document';
import { lastKeyTime, settleKeys } from '../../core/key-ops';
import { spec } from '../../core/spec';
import {
  keysThatStay,
  suggestionRange,
  type Density,
  type SuggestedPose,
  type SuggestRequest,
} from '../../core/suggest';
import type { KeyPose } from '../../core/types';
import { isAbort, messageOf, onGrid, type Context } from '../context';
import { trimFrames } from '../recipe';
import { idsOnStage, withOwnCurves } from './curves';
import type { SuggestChoice } from '../suggester';

/** What the API can ask for; what is left out is as in the menu's first state. */
export interface SuggestCall {
  density?: Density;
  /** Seconds; without it all that is danced. */
  range?: TimeRange;
  /** Only between own key poses. */
  gaps?: boolean;
  /** 0..1. */
  variation?: number;
  /** Whole number; the same seed gives the same poses. */
  seed?: number;
  /** One of the model's styles. */
  style?: string;
}

const DENSITIES: readonly Density[] = ['beat', 'half', 'bar'];
const LABEL = 'Suggest key poses';
/** What the notice of a suggestion offers. */
const NEXT = 'Generate';
/** Suggestions of this many key poses are remembered with their alternates. */
const KEPT_ALTERNATES = 500;

const samePose = (a: readonly number[], b: readonly number[]) => a.every((value, i) => Math.abs(value - b[i]) < 1e-9);

/** Actions on suggested key poses. */
export function suggestActions(context: Context, generate: () => Promise<void>) {
  const { state, services, history } = context;
  let running: AbortController | null = null;
  /** Each press of the button gives other poses. */
  let presses = 0;
  let finding: { id: string; controller: AbortController; promise: Promise<void> } | null = null;

  const suggester = () => {
    if (!services.suggester) throw new Error('Suggesting key poses is not available here.');
    return services.suggester;
  };

  const cancel = () => {
    running?.abort();
    running = null;
    state.suggestion.value = { status: 'idle' };
  };

  /** All that is danced. */
  const danced = (): TimeRange => {
    const part = trimFrames(state.document.value.trim, state.frames.value);
    const end = lastKeyTime(state.duration.value);
    return part ? { start: part.from / spec.fps, end: Math.min(end, part.to / spec.fps) } : { start: 0, end };
  };

  /** The part of a stretch that is danced. */
  const inside = ({ start, end }: TimeRange): TimeRange => {
    const all = danced();
    return { start: Math.max(all.start, start), end: Math.min(all.end, end) };
  };

  function check({ density, range, variation, seed, style }: SuggestCall): void {
    if (!state.song.value) throw new Error('There is no song yet: drop one, or call loadSong first.');
    if (density !== undefined && !DENSITIES.includes(density)) {
      throw new Error(`There is no density "${String(density)}": use "beat", "half" or "bar".`);
    }
    if (range !== undefined && !(range.start >= 0 && range.end > range.start && range.start < state.duration.value)) {
      const last = state.duration.value.toFixed(2);
      throw new Error(`range must be {start, end} in seconds inside the song (0 to ${last}).`);
    }
    if (variation !== undefined && !(typeof variation === 'number' && variation >= 0 && variation <= 1)) {
      throw new Error('variation must be a number from 0 to 1.');
    }
    if (seed !== undefined && !(Number.isInteger(seed) && seed >= 0 && seed < 2 ** 31)) {
      throw new Error('seed must be a whole number from 0 to 2147483647.');
    }
    const { styles } = spec.danceformer;
    if (style !== undefined && !styles.includes(style)) {
      throw new Error(`There is no style "${String(style)}": use one of ${styles.join(', ')}, or none.`);
    }
  }

  /** What the worker needs to know, whatever it is asked. */
  async function ground() {
    const { features, grid } = onGrid(await context.analysed(), state.document.value.grid);
    return { features, grid };
  }

  /**
   * Puts suggested poses on the timeline as they come; all of them are one step of undo. What the visitor does in between ends it.
   * @returns the key poses that were suggested
   */
  async function suggestKeyPoses(call: SuggestCall = {}): Promise<KeyPose[]> {
    check(call);
    const worker = suggester();
    cancel();
    const own = (running = new AbortController());
    const { signal } = own;
    const range = call.range ? inside(call.range) : danced();
    let shown: readonly KeyPose[] | null = null;
    try {
      state.suggestion.value = { status: 'loading', fraction: 0 };
      const heard = await ground();
      signal.throwIfAborted();
      const { keyPoses } = state.document.value;
      const request: SuggestRequest = {
        ...heard,
        keyPoses,
        density: call.density ?? 'beat',
        range,
        gaps: call.gaps,
        variation: call.variation ?? 0.5,
        seed: call.seed ?? state.document.value.dials.seed,
        style: call.style,
      };
      const stay = keysThatStay(keyPoses, suggestionRange(request) ?? range);
      // Numbers that no key pose had before: what is remembered of a former one must not be taken for this one's.
      const taken = [...keyPoses, ...idsOnStage(state).map((id) => ({ id }))];
      const first = Number(nextKeyId(taken).slice(1));
      const found: KeyPose[] = [];
      /** Undone, or changed by hand. */
      const isOver = () => shown !== null && (!history.capturing || history.present.keyPoses !== shown);
      const show = (poses: readonly SuggestedPose[]) => {
        for (const pose of poses) found.push({ id: `k${first + found.length}`, ...pose, suggested: true });
        if (shown === null) history.capture();
        shown = settleKeys(stay, found, state.duration.value);
        history.preview(withOwnCurves({ ...history.present, keyPoses: shown as KeyPose[] }));
        context.sync();
      };
      await worker.suggest(
        request,
        {
          signal,
          onLoading: ({ fraction }) => {
            if (running === own) state.suggestion.value = { status: 'loading', fraction };
          },
          onPoses: (poses, fraction) => {
            if (signal.aborted) return;
            if (isOver() || (shown === null && state.document.value.keyPoses !== keyPoses)) {
              own.abort();
              return;
            }
            show(poses);
            state.suggestion.value = { status: 'running', fraction, poses: found.length };
          },
        },
        services.forcedBackend,
      );
      signal.throwIfAborted();
      if (isOver()) throw new DOMException('The key poses were changed meanwhile.', 'AbortError');
      history.commit(LABEL);
      context.sync();
      state.alternates.value = new Map();
      return found;
    } catch (error) {
      // What was found so far goes, unless the visitor has made it part of a step already.
      if (shown !== null && history.capturing && history.present.keyPoses === shown) {
        history.discard();
        context.sync();
      }
      throw error;
    } finally {
      if (running === own) cancel();
    }
  }

  /** The key pose whose alternates are meant: the selected one, when it is a suggestion. */
  const chosen = (): KeyPose | null => {
    const keys = state.document.value.keyPoses.filter((key) => state.selection.value.has(key.id));
    return keys.length === 1 && keys[0].suggested && !keys[0].locked ? keys[0] : null;
  };

  const known = (key: KeyPose) => {
    const list = state.alternates.value.get(key.id);
    return list?.some((pose) => samePose(pose, key.rotations)) ? list : undefined;
  };

  /** Looks for other poses for a suggested key pose, once. */
  function prepareAlternates(id: string): Promise<void> {
    const key = state.document.value.keyPoses.find((each) => each.id === id);
    if (!key?.suggested || known(key)) return Promise.resolve();
    if (finding?.id === id) return finding.promise;
    finding?.controller.abort();
    const controller = new AbortController();
    const promise = (async () => {
      const heard = await ground();
      const { keyPoses, dials } = state.document.value;
      const { style, variation } = state.suggestChoice.value;
      const request = { ...heard, keyPoses, seed: dials.seed, variation, style: style ?? undefined };
      const poses = await suggester().alternates(request, key, controller.signal, services.forcedBackend);
      const next = new Map(state.alternates.value);
      next.set(id, [key.rotations, ...poses]);
      for (const old of [...next.keys()].slice(0, Math.max(0, next.size - KEPT_ALTERNATES))) next.delete(old);
      state.alternates.value = next;
    })();
    const own = (finding = { id, controller, promise });
    const forget = () => {
      if (finding === own) finding = null;
    };
    promise.then(forget, forget);
    return promise;
  }

  return {
    suggestKeyPoses,
    /** Stops suggesting; what was there before stays. */
    cancelSuggestion: cancel,

    /** Loads the model ahead: somebody is about to use it. */
    warmSuggester(): void {
      services.suggester?.load(services.forcedBackend).catch(() => undefined);
    },

    /** Changes a setting of the next suggestion; not part of the project. */
    chooseSuggestion(choice: Partial<SuggestChoice>): void {
      state.suggestChoice.value = { ...state.suggestChoice.value, ...choice };
    },

    /** What the button does: suggests as the menu says; errors become notices, and the dance is one press away. */
    async suggestForPage(): Promise<void> {
      const { density, place, variation, style } = state.suggestChoice.value;
      const range = place === 'range' ? state.loop.value : null;
      // What was said of the suggestion before is over: several of them would hide the stage of a phone.
      state.notices.value = state.notices.value.filter(({ action }) => action?.label !== NEXT);
      try {
        const found = await suggestKeyPoses({
          density,
          variation,
          gaps: place === 'gaps',
          seed: (state.document.value.dials.seed + presses) % 2 ** 31,
          ...(range ? { range } : {}),
          ...(style ? { style } : {}),
        });
        presses += 1;
        const text = `${found.length === 1 ? 'One key pose' : `${found.length} key poses`} suggested.`;
        context.notify('info', text, { label: NEXT, run: () => void generate() });
        context.announce(text);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },

    prepareAlternates,

    /** Puts the next (1) or the previous (-1) alternate in the place of the selected suggestion; after the last comes the first. */
    async stepAlternate(direction: -1 | 1): Promise<void> {
      const key = chosen();
      if (!key) {
        context.notify(
          'info',
          'Select one suggested key pose first: only suggestions have other poses to flip through.',
        );
        return;
      }
      try {
        await prepareAlternates(key.id);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
        return;
      }
      const now = state.document.value.keyPoses.find((each) => each.id === key.id);
      const list = now && known(now);
      if (!now || !list || list.length < 2) return;
      const index = list.findIndex((pose) => samePose(pose, now.rotations));
      const next = (index + direction + list.length) % list.length;
      context.change('Another suggestion', (document) => ({
        ...document,
        keyPoses: document.keyPoses.map((each) =>
          each.id === key.id ? { ...each, rotations: [...list[next]] } : each,
        ),
      }));
      context.announce(`Pose ${next + 1} of ${list.length}.`);
    },

    /** Which of its poses a suggestion has, from 1, and how many there are; null while that is not known. */
    alternateOf(key: KeyPose): { number: number; count: number } | null {
      const list = known(key);
      return list ? { number: 1 + list.findIndex((pose) => samePose(pose, key.rotations)), count: list.length } : null;
    },
  };
}

/** Actions on suggested key poses. */
export type SuggestActions = ReturnType<typeof suggestActions>;
