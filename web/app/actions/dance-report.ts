/** What was measured of the dance on stage. */
import type { Motion } from '../../core/types';
import { isAbort, messageOf, type Context } from '../context';
import { trimFrames } from '../recipe';
import type { Reporter } from '../report-client';
import { measureDance, type DanceReport } from '../report';

/** Actions on the report. */
export function danceReport(context: Context, reporter: Reporter) {
  const { state } = context;
  /** The dance that the report is of. */
  let measured: Motion | null = null;

  /** Shows what was measured of a dance. */
  function showReport(motion: Motion, report: DanceReport): void {
    measured = motion;
    state.report.value = report;
  }

  /** What the dance on stage dances to, where the song is trimmed. */
  const partShown = () => trimFrames(state.dance.value?.inputs?.trim ?? null, state.frames.value);

  /** Measures the dance on stage for the report panel. */
  async function measureShown(): Promise<void> {
    const dance = state.dance.value;
    if (!dance || dance.kind === 'preview') return;
    const keys = dance.inputs?.keyPoses ?? state.document.value.keyPoses;
    try {
      const report = await reporter.measure(dance.motion, keys, state.grid.value, partShown());
      if (state.dance.value?.motion === dance.motion) showReport(dance.motion, report);
    } catch (error) {
      if (!isAbort(error)) context.notify('error', messageOf(error));
    }
  }

  return {
    measureShown,
    showReport,

    /** Measures the dance on stage now. Throws when there is none. */
    reportNow(): DanceReport {
      const dance = state.dance.value;
      if (!dance) throw new Error('There is no dance yet: call generate first.');
      const keys = dance.inputs?.keyPoses ?? state.document.value.keyPoses;
      const known = measured === dance.motion ? state.report.value : null;
      return structuredClone(known ?? measureDance(dance.motion, keys, state.grid.value, partShown()));
    },
  };
}
