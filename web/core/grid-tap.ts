/** Tap tempo: from the moments that somebody tapped to a beat grid of the whole song. */
import { barred, beatPosition, evenGrid, firstBar, GRID_TEMPO, tidy, timeAtBeat } from './grid-edit';
import { percentile } from './interpolate';
import type { BeatGrid } from './types';

/** Fewer taps than this tell no tempo. */
export const MIN_TAPS = 4;
/** Taps per analysed beat that are the same music counted at another level. */
const LEVELS = [1, 2, 1 / 2, 3, 1 / 3, 3 / 2, 2 / 3, 4, 1 / 4] as const;
/** The taps' tempo is that of a level when it is this near (share of the period), and up to the second where the taps are unsteady. */
const NEAR = { steady: 0.025, unsteady: 0.08 } as const;
/** Analysed beats lie on onsets; hands are early or late by as much as this, seconds (Repp 2005), which is no reason to leave them. */
const HAND = 0.045;
/** A tap further off the line than so many deviations, and than this many seconds, was a slip. */
const SLIP = { deviations: 3, seconds: 0.05 } as const;

/** The steady pulse through a series of taps. */
export interface TapFit {
  /** Seconds between beats. */
  period: number;
  /** A time that a beat falls on: that of the first tap used, by the fit. */
  phase: number;
  /** Standard errors of period and phase, seconds. */
  periodError: number;
  phaseError: number;
  /** The taps that were no slips, in order. */
  used: number[];
}

/**
 * Fits a steady pulse to taps: the median interval tells how many beats lie between two taps (a missed beat counts two, a bounced
 * key none), slips are thrown out by their distance from the Theil-Sen line, and least squares over the rest gives period and phase.
 *
 * @param taps - Song times in the order tapped, seconds; a jump back (a loop) begins a new run that shares the pulse.
 * @returns null when fewer than {@link MIN_TAPS} agree, or the tempo is outside {@link GRID_TEMPO}
 */
export function fitTaps(taps: readonly number[]): TapFit | null {
  const shortest = 60 / GRID_TEMPO.max;
  const longest = 60 / GRID_TEMPO.min;
  const steps = taps.slice(1).map((time, i) => time - taps[i]);
  const typical = median(steps.filter((step) => step >= shortest / 2 && step <= longest));
  if (!(typical > 0)) return null;
  const points = longestRun(taps, typical);
  if (points.length < MIN_TAPS) return null;
  const rough = theilSen(points);
  const off = points.map(([beat, time]) => time - rough.phase - beat * rough.period);
  const deviation = 1.4826 * median(off.map(Math.abs));
  const limit = Math.max(SLIP.deviations * deviation, SLIP.seconds);
  const kept = points.filter((_, i) => Math.abs(off[i]) <= limit);
  if (kept.length < MIN_TAPS) return null;
  const fit = leastSquares(kept);
  if (fit.period < shortest || fit.period > longest) return null;
  return { ...fit, used: kept.map(([, time]) => time) };
}

const median = (values: readonly number[]): number => percentile(values, 0.5);

/** [beat, time] of a tap. */
type Point = readonly [number, number];

/** Taps with their beat numbers; runs after a jump back are numbered by the pulse of the longest one. */
function longestRun(taps: readonly number[], typical: number): Point[] {
  const runs: Point[][] = [];
  let previous = Infinity;
  for (const time of taps) {
    const run = runs.at(-1);
    if (!run || time <= previous) runs.push([[0, time]]);
    else {
      const beats = Math.round((time - previous) / typical);
      if (beats === 0) continue; // bounced
      run.push([run[run.length - 1][0] + beats, time]);
    }
    previous = time;
  }
  const main = runs.reduce((most, run) => (run.length > most.length ? run : most), []);
  if (main.length < 2) return [];
  const { period, phase } = theilSen(main);
  const others = runs.filter((run) => run !== main).flat();
  return [...main, ...others.map(([, time]): Point => [Math.round((time - phase) / period), time])];
}

/** The line through points by medians: half of them may be wrong. */
function theilSen(points: readonly Point[]): { period: number; phase: number } {
  const slopes: number[] = [];
  points.forEach(([beat, time], i) => {
    for (const [other, at] of points.slice(0, i)) if (other !== beat) slopes.push((time - at) / (beat - other));
  });
  const period = median(slopes);
  return { period, phase: median(points.map(([beat, time]) => time - beat * period)) };
}

function leastSquares(points: readonly Point[]): Omit<TapFit, 'used'> {
  const n = points.length;
  const meanBeat = points.reduce((sum, [beat]) => sum + beat, 0) / n;
  const meanTime = points.reduce((sum, [, time]) => sum + time, 0) / n;
  const spread = points.reduce((sum, [beat]) => sum + (beat - meanBeat) ** 2, 0);
  const period = points.reduce((sum, [beat, time]) => sum + (beat - meanBeat) * (time - meanTime), 0) / spread;
  const rest = points.reduce((sum, [beat, time]) => sum + (time - meanTime - (beat - meanBeat) * period) ** 2, 0);
  const noise = Math.sqrt(rest / Math.max(1, n - 2));
  const first = points[0][0];
  return {
    period,
    phase: meanTime + (first - meanBeat) * period,
    periodError: noise / Math.sqrt(spread),
    phaseError: noise / Math.sqrt(n),
  };
}

/**
 * A grid of the whole song from taps. Where the taps count the analysed beats at some level (all of them, every second, two on
 * each...), those beats are used, resampled: real songs drift, and the analysis followed them through the whole song while the taps
 * cover a few bars. The taps then say only which of the beats, or whether between them. Else it is an even grid at the taps' tempo.
 *
 * Bar 1 stays on its beat where that still is one; else a bar begins at the first tap.
 *
 * @param taps - Song times in the order tapped, seconds.
 * @param analysed - The beats as analysed, or null.
 * @param duration - Length of the song, seconds.
 * @param beatsPerBar - Of the grid to make.
 * @returns null when the taps tell no tempo
 */
export function tapGrid(
  taps: readonly number[],
  analysed: BeatGrid | null,
  duration: number,
  beatsPerBar: 3 | 4 = analysed?.beatsPerBar ?? 4,
): BeatGrid | null {
  const fit = fitTaps(taps);
  if (!fit) return null;
  const even = evenGrid(fit.period, fit.phase, beatsPerBar, duration);
  if (!analysed || analysed.beats.length < 8) return even.beats.length < 2 ? null : even;
  const level = levelOf(fit, analysed);
  const result = level === null ? even : resampled(fit, analysed, level, duration, beatsPerBar);
  return result.beats.length < 2 ? null : result;
}

/** How many taps go on one analysed beat where they were tapped; null when the tempi have nothing to do with each other. */
function levelOf(fit: TapFit, grid: BeatGrid): number | null {
  const start = Math.min(...fit.used);
  const end = Math.max(...fit.used);
  const beats = beatPosition(grid, end) - beatPosition(grid, start);
  const ratio = (end - start) / beats / fit.period;
  const near = Math.min(Math.max((3 * fit.periodError) / fit.period, NEAR.steady), NEAR.unsteady);
  const distance = (level: number): number => Math.abs(Math.log(ratio / level));
  const level = LEVELS.reduce((best, each) => (distance(each) < distance(best) ? each : best));
  return distance(level) <= near ? level : null;
}

function resampled(fit: TapFit, grid: BeatGrid, level: number, duration: number, beatsPerBar: 3 | 4): BeatGrid {
  const phase = phaseOf(fit, grid, level);
  const time = (k: number): number => tidy(timeAtBeat(grid, (k + phase) / level));
  let k = Math.ceil(level * beatPosition(grid, 0) - phase - 1e-6);
  const first = k;
  const beats: number[] = [];
  for (let at = Math.max(0, time(k)); at < duration; at = time(k)) {
    beats.push(at);
    k += 1;
  }
  const bar = level * firstBar(grid) - phase;
  const whole = Math.abs(bar - Math.round(bar)) < 0.2;
  const anchor = whole ? Math.round(bar) : Math.round(level * beatPosition(grid, fit.used[0]) - phase);
  return barred(beats, beatsPerBar, anchor - first);
}

/** Where between two analysed beats the first new one lies, 0..1 of a new beat: on a half of an analysed beat unless the taps insist. */
function phaseOf(fit: TapFit, grid: BeatGrid, level: number): number {
  let x = 0;
  let y = 0;
  for (const tap of fit.used) {
    const angle = 2 * Math.PI * level * beatPosition(grid, tap);
    x += Math.cos(angle);
    y += Math.sin(angle);
  }
  const tapped = Math.atan2(y, x) / (2 * Math.PI);
  const step = Math.min(0.5, level / 2);
  const natural = Math.round(tapped / step) * step;
  const off = Math.abs(tapped - natural) * fit.period;
  return off > Math.max(HAND, 2 * fit.phaseError) ? tapped : natural;
}
