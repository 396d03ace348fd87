/** What the dials do to the dance at hand without the network: key strength at once, takes that were already made, the trade-off plot. */
import { batch, effect, untracked } from '@preact/signals';
import { tradeOffStrengths } from '../../core/report-curves';
import { isAbort, messageOf, type Context } from '../context';
import type { Reporter, TunableDance } from '../report-client';
import { madeFrom, type Dance } from '../state';
import type { DanceActions } from './dance';

/** Takes that are kept, and how many frames all of them may have together (some 1.6 kB a frame). */
const KEPT = { takes: 8, frames: 40_000 };
/** The trade-off is worked out at 9 strengths. */
const HALVINGS = 3;

/** Actions on the dance at hand. */
export function tuningActions(context: Context, reporter: Reporter, dances: DanceActions) {
  const { state, services } = context;
  /** Dances that were made, newest last; each knows what it was made from. */
  let takes: { dance: Dance; hash: string }[] = [];
  /** The strength that is being worked out. */
  let wanted: number | null = null;
  let plotting: AbortController | null = null;

  const hash = () => state.song.value?.reference.hash ?? '';

  const tunable = (): (TunableDance & { dance: Dance }) | null => {
    const dance = state.dance.value;
    if (!dance?.uncorrected || !dance.inputs) return null;
    return { dance, uncorrected: dance.uncorrected, motion: dance.motion, keyPoses: dance.inputs.keyPoses };
  };

  /** Finishes the dance on stage at a strength; `live` shows the poses around the playhead first. */
  async function strengthen(strength: number, live: boolean): Promise<void> {
    const now = tunable();
    if (!now || (now.dance.keyStrength === strength && wanted === null) || wanted === strength) return;
    wanted = strength;
    const { uncorrected } = now;
    const swap = (change: Partial<Dance>) => {
      const shown = state.dance.value;
      if (shown?.uncorrected !== uncorrected) return false;
      state.dance.value = { ...shown, ...change };
      return true;
    };
    try {
      const { motion, report } = await reporter.finish(now, {
        strength,
        grid: state.grid.value,
        ...(live ? { near: services.player.time() * now.motion.fps } : {}),
        onDraft: (draft) => void swap({ motion: draft }),
      });
      batch(() => {
        if (swap({ motion, keyStrength: strength })) dances.showReport(motion, report);
      });
      if (state.dance.value?.motion !== motion) return;
      if (state.dance.value.byDials) remember(state.dance.value);
      dances.saveShown();
    } catch (error) {
      if (!isAbort(error)) context.notify('error', messageOf(error));
    } finally {
      if (wanted === strength) wanted = null;
    }
  }

  /** Remembers a dance that the document's own dials made. */
  function remember(dance: Dance): void {
    const own = hash();
    takes = takes.filter((take) => take.hash === own && !(take.dance.inputs && sameTake(take.dance, dance)));
    takes.push({ dance, hash: own });
    const frames = () => takes.reduce((sum, take) => sum + take.dance.motion.frames, 0);
    while (takes.length > KEPT.takes || (takes.length > 1 && frames() > KEPT.frames)) takes.shift();
  }

  const sameTake = (a: Dance, b: Dance) =>
    a.inputs !== null && b.inputs !== null && madeFrom(a.inputs, b.inputs, a.uncorrected !== undefined);

  /** The dance that the document asks for, if it was made before. */
  const known = (): Dance | null => {
    const own = hash();
    const found = takes.findLast(
      ({ dance, hash }) =>
        hash === own && dance.inputs && madeFrom(dance.inputs, state.document.value, dance.uncorrected !== undefined),
    );
    return found?.dance ?? null;
  };

  let newest: Dance['result'] = null;
  effect(() => {
    const dance = state.dance.value;
    if (!dance?.byDials || dance.result === newest) return;
    newest = dance.result;
    untracked(() => {
      remember(dance);
      // The dial may have moved while the dance was made.
      void strengthen(state.document.value.dials.keyStrength, false);
    });
  });

  let before = state.document.value.dials.keyStrength;
  effect(() => {
    const { keyStrength } = state.document.value.dials;
    const stale = state.stale.value;
    untracked(() => {
      // A take that was made before comes back at once, whether by its number or by undo.
      const back = stale && state.generation.value.status === 'idle' ? known() : null;
      if (back) {
        state.dance.value = back;
        void dances.measureShown();
      }
      if (keyStrength === before && !back) return;
      before = keyStrength;
      void strengthen(keyStrength, false);
    });
  });

  return {
    /** The dial is being dragged: the poses around the playhead follow at once, the rest as soon as it rests. */
    previewStrength(strength: number): void {
      state.strengthDraft.value = strength;
      void strengthen(strength, true);
    },

    /** The dial is let go: one step of undo. */
    commitStrength(strength: number): void {
      batch(() => {
        state.strengthDraft.value = null;
        dances.setDial('keyStrength', strength);
      });
      void strengthen(strength, false);
    },

    /** Another take: shown at once where it was made before, else made now. */
    async showTake(seed: number): Promise<void> {
      if (seed === state.document.value.dials.seed) return;
      dances.setDial('seed', seed);
      if (state.stale.value && state.song.value && !state.songJob.value) await dances.generateForPage();
    },

    /** Works out consistency against smoothness of the dance on stage, unless that is done or under way. */
    async plotTradeOff(): Promise<void> {
      const now = tunable();
      if (!now || now.keyPoses.length === 0) {
        plotting?.abort();
        state.tradeOff.value = null;
        return;
      }
      const { uncorrected } = now;
      if (state.tradeOff.value?.of === uncorrected) return;
      plotting?.abort();
      const own = (plotting = new AbortController());
      state.tradeOff.value = { of: uncorrected, points: [], complete: false };
      const change = (complete: boolean, more: TradeOffPoints = []) => {
        const shown = state.tradeOff.value;
        if (shown?.of !== uncorrected) return;
        const points = [...shown.points, ...more].sort((a, b) => a.strength - b.strength);
        state.tradeOff.value = { of: uncorrected, points, complete };
      };
      try {
        await reporter.plot(now, tradeOffStrengths(HALVINGS), (point) => change(false, [point]), own.signal);
        change(true);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
        else if (state.tradeOff.value?.of === uncorrected) state.tradeOff.value = null;
      }
    },
  };
}

type TradeOffPoints = NonNullable<Context['state']['tradeOff']['value']>['points'];

/** Actions on the dance at hand. */
export type TuningActions = ReturnType<typeof tuningActions>;
