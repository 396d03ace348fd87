/** What the dials do to the dance at hand without the network: key strength at once, takes that were already made, the trade-off plot. */
import { batch, effect, untracked } from '@preact/signals';
import { tradeOffStrengths } from '../../core/report-curves';
import type { KeyPose } from '../../core/types';
import { isAbort, messageOf, type Context } from '../context';
import type { DanceCache } from '../dance-cache';
import { sameStrengths, type DanceInputs } from '../recipe';
import type { Reporter, TunableDance } from '../report-client';
import type { Dance } from '../state';
import type { DanceActions } from './dance';

/** The trade-off is worked out at 9 strengths. */
const HALVINGS = 3;

/** Actions on the dance at hand. */
export function tuningActions(context: Context, reporter: Reporter, dances: DanceActions, cache: DanceCache) {
  const { state, services, history } = context;
  /** The strengths that are being worked out. */
  let wanted: { strength: number; keyPoses: readonly KeyPose[] } | null = null;
  let plotting: AbortController | null = null;

  const tunable = (dance = state.dance.value): (TunableDance & { dance: Dance; inputs: DanceInputs }) | null => {
    if (!dance?.uncorrected || !dance.inputs) return null;
    const { uncorrected, motion, inputs } = dance;
    return { dance, inputs, uncorrected, motion, keyPoses: inputs.keyPoses };
  };

  /** Finishes the dance on stage at other strengths of dial and key poses; `live` shows the poses around the playhead first. */
  async function strengthen(strength: number, live: boolean, keyPoses?: readonly KeyPose[]): Promise<void> {
    const now = tunable();
    if (!now) return;
    const wish = { strength, keyPoses: keyPoses ?? now.keyPoses };
    const same = (other: typeof wish) => other.strength === strength && other.keyPoses === wish.keyPoses;
    if (wanted ? same(wanted) : same({ strength: now.dance.keyStrength ?? NaN, keyPoses: now.keyPoses })) return;
    wanted = wish;
    const { uncorrected } = now;
    const swap = (change: Partial<Dance>) => {
      const shown = state.dance.value;
      if (shown?.uncorrected !== uncorrected) return false;
      state.dance.value = { ...shown, ...change };
      return true;
    };
    const grid = state.grid.value;
    try {
      const { motion, report } = await reporter.finish(
        { uncorrected, motion: now.motion, keyPoses: wish.keyPoses },
        {
          strength,
          grid,
          ...(live ? { near: services.player.time() * now.motion.fps } : {}),
          onDraft: (draft) => void swap({ motion: draft }),
        },
      );
      batch(() => {
        const inputs = { ...(state.dance.value?.inputs ?? now.inputs), keyPoses: wish.keyPoses };
        if (swap({ motion, keyStrength: strength, inputs }))
          dances.showReport(motion, report, { keyPoses: wish.keyPoses, grid });
      });
      if (state.dance.value?.motion !== motion) return;
      if (state.dance.value.byDials) cache.remember(state.dance.value, state.song.value?.reference.hash ?? '');
      dances.saveShown();
    } catch (error) {
      if (!isAbort(error)) context.notify('error', messageOf(error));
    } finally {
      if (wanted === wish) wanted = null;
    }
  }

  let newest: unknown = null;
  effect(() => {
    const dance = state.dance.value;
    const made = dance?.uncorrected ?? dance?.motion;
    if (!dance?.byDials || made === newest) return;
    newest = made;
    // Dial and key poses may have moved while the dance was made, or since it was on stage before.
    untracked(() => follow(true));
  });

  let before = state.document.value.dials.keyStrength;
  effect(() => {
    const { keyStrength } = state.document.value.dials;
    const stale = state.stale.value;
    const idle = state.generation.value.status === 'idle';
    void state.document.value.keyPoses;
    untracked(() => {
      // A dance that was made before comes back at once, whether by its number or by undo.
      const back = stale && idle && dances.bringBack();
      const moved = keyStrength !== before;
      before = keyStrength;
      if (moved || !back) follow(moved);
    });
  });

  /** Takes over the strengths that the document says; that of the dial only when `dial` says so: a call may have asked for another one. */
  function follow(dial: boolean): void {
    const now = tunable();
    if (!now) return;
    const { dials, keyPoses } = state.document.value;
    const same = state.stale.value || sameStrengths(now.keyPoses, keyPoses);
    if (same && !state.stale.value && now.keyPoses !== keyPoses) {
      // Only names or locks changed: the dance is the same.
      state.dance.value = { ...now.dance, inputs: { ...now.inputs, keyPoses } };
    }
    if (!dial && same) return;
    const strength = dial ? dials.keyStrength : (now.dance.keyStrength ?? dials.keyStrength);
    void strengthen(strength, history.capturing, same ? undefined : keyPoses);
  }

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
      if (state.song.value && !state.songJob.value) await dances.catchUp();
    },

    /** Works out consistency against smoothness of the dance on stage, unless that is done or under way. */
    async plotTradeOff(): Promise<void> {
      const now = tunable(state.onStage.value);
      if (!now || now.keyPoses.length === 0) {
        plotting?.abort();
        state.tradeOff.value = null;
        return;
      }
      const { uncorrected, keyPoses } = now;
      const isOfThis = (plot: typeof state.tradeOff.value) => plot?.of === uncorrected && plot.keyPoses === keyPoses;
      if (isOfThis(state.tradeOff.value)) return;
      plotting?.abort();
      const own = (plotting = new AbortController());
      state.tradeOff.value = { of: uncorrected, keyPoses, points: [], complete: false };
      const change = (complete: boolean, more: TradeOffPoints = []) => {
        const shown = state.tradeOff.value;
        if (!shown || !isOfThis(shown)) return;
        const points = [...shown.points, ...more].sort((a, b) => a.strength - b.strength);
        state.tradeOff.value = { ...shown, points, complete };
      };
      try {
        await reporter.plot(now, tradeOffStrengths(HALVINGS), (point) => change(false, [point]), own.signal);
        change(true);
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
        else if (isOfThis(state.tradeOff.value)) state.tradeOff.value = null;
      }
    },
  };
}

type TradeOffPoints = NonNullable<Context['state']['tradeOff']['value']>['points'];
