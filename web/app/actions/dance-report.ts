/** What was measured of the dance on stage. */
import { effect, untracked } from '@preact/signals';
import type { BeatGrid, KeyPose, Motion } from '../../core/types';
import { isAbort, messageOf, type Context } from '../context';
import { documentOnStage } from '../on-stage';
import { trimFrames } from '../recipe';
import type { Reporter } from '../report-client';
import { measureDance, type DanceReport } from '../report';
import type { Dance } from '../state';

/** What a dance is measured against. */
interface Against {
  keyPoses: readonly KeyPose[];
  grid: BeatGrid | null;
}

/** Actions on the report. */
export function danceReport(context: Context, reporter: Reporter) {
  const { state } = context;
  /** Reports as long as their dances live: two that are compared are each measured once. */
  const known = new WeakMap<Motion, Against & { report: DanceReport }>();
  let asking: (Against & { motion: Motion; answer: Promise<void> }) | null = null;

  const same = (a: Against, b: Against) => a.keyPoses === b.keyPoses && a.grid === b.grid;
  const against = (dance: Dance, document = state.document.value): Against => ({
    keyPoses: dance.inputs?.keyPoses ?? document.keyPoses,
    grid: document.grid ?? state.song.value?.grid ?? null,
  });
  const knownOf = (motion: Motion, wanted: Against): DanceReport | null => {
    const found = known.get(motion);
    return found && same(found, wanted) ? found.report : null;
  };
  /** What a dance dances to, where the song is trimmed. */
  const partOf = (dance: Dance) => trimFrames(dance.inputs?.trim ?? null, state.frames.value);

  /** Takes in what was measured of a dance, and shows it where that dance is on stage. */
  function showReport(motion: Motion, report: DanceReport, measured: Against): void {
    known.set(motion, { ...measured, report });
    if (state.onStage.value?.motion === motion) state.report.value = report;
  }

  async function measure(dance: Dance, wanted: Against): Promise<void> {
    try {
      const report = await reporter.measure(dance.motion, wanted.keyPoses, wanted.grid, partOf(dance));
      showReport(dance.motion, report, wanted);
    } catch (error) {
      if (!isAbort(error)) context.notify('error', messageOf(error));
    }
  }

  /** Measures the dance on stage for the report panel, unless that is done or under way. */
  async function measureShown(): Promise<void> {
    const dance = state.onStage.value;
    if (!dance || dance.kind === 'preview') return;
    const { motion } = dance;
    const wanted = against(dance, documentOnStage(state));
    const report = knownOf(motion, wanted);
    if (report) {
      state.report.value = report;
      return;
    }
    if (asking?.motion !== motion || !same(asking, wanted))
      asking = { ...wanted, motion, answer: measure(dance, wanted) };
    const own = asking;
    await own.answer;
    if (asking === own) asking = null;
  }

  // The other of two compared dances has a report of its own.
  let side: 'a' | 'b' = 'b';
  effect(() => {
    const now = state.compare.value?.shown ?? 'b';
    if (now === side) return;
    side = now;
    untracked(() => {
      state.report.value = null;
      void measureShown();
    });
  });

  return {
    measureShown,
    showReport,

    /** Measures the dance of now. Throws when there is none. */
    reportNow(): DanceReport {
      const dance = state.dance.value;
      if (!dance) throw new Error('There is no dance yet: call generate first.');
      const wanted = against(dance);
      const report = knownOf(dance.motion, wanted);
      return structuredClone(report ?? measureDance(dance.motion, wanted.keyPoses, wanted.grid, partOf(dance)));
    },
  };
}
