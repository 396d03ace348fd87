/**
 * What the report worker does with its messages: one small task at a time, the most urgent first. What the visitor drags comes before
 * numbers, numbers before the plot; of drafts and plots only the newest counts.
 */
import { keysWithin } from '../core/excerpt';
import { finishDance, flattened, partOf, type UncorrectedDance } from '../core/finish';
import { copyFrames, sliceMotion } from '../core/motion';
import { tradeOffPoint } from '../core/report-curves';
import type { KeyPose, Motion } from '../core/types';
import { measureDance } from './report';
import type { ReportReply, ReportRequest } from './report-protocol';

type Measure = Extract<ReportRequest, { type: 'measure' }>;
type Finish = Extract<ReportRequest, { type: 'finish' }>;
type Plot = Extract<ReportRequest, { type: 'plot' }>;

/** A draft reaches this far before and after the frame that is looked at, seconds: the longest correction and a foot's step fit in. */
const DRAFT_REACH = 5;
/** After a draft the whole dance waits this long for the next drag, milliseconds. */
const DRAFT_PAUSE = 120;

/** The worker's ways to the outside; tests plug in their own. */
export interface DeskTools {
  reply(message: ReportReply, transfer: Transferable[]): void;
  /** Lets messages in, after so many milliseconds. */
  pause(milliseconds: number): Promise<void>;
}

/** The report worker without the worker. */
export class ReportDesk {
  private held: { dance: UncorrectedDance; shown: Motion; keyPoses: readonly KeyPose[] } | null = null;
  private readonly measures: Measure[] = [];
  private finish: (Finish & { drafted: boolean }) | null = null;
  private plot: (Plot & { next: number }) | null = null;
  private working = false;

  constructor(private readonly tools: DeskTools) {}

  /** Takes a message in; the work itself is done in later tasks. */
  handle(request: ReportRequest): void {
    if (request.type === 'measure') this.measures.push(request);
    else if (request.type === 'hold') {
      this.held = { dance: request.dance, shown: request.motion, keyPoses: request.keyPoses };
      this.dropFinish();
      this.dropPlot();
    } else if (request.type === 'keys') {
      if (this.held) this.held.keyPoses = request.keyPoses;
      this.dropPlot();
    } else if (request.type === 'finish') {
      this.dropFinish();
      this.finish = { ...request, drafted: false };
    } else if (request.type === 'plot') {
      this.dropPlot();
      this.plot = { ...request, next: 0 };
    } else this.cancel(request.job);
    void this.work();
  }

  private dropFinish(): void {
    if (this.finish) this.tools.reply({ type: 'dropped', job: this.finish.job }, []);
    this.finish = null;
  }

  private dropPlot(): void {
    if (this.plot) this.tools.reply({ type: 'dropped', job: this.plot.job }, []);
    this.plot = null;
  }

  private cancel(job: number): void {
    if (this.finish?.job === job) this.dropFinish();
    if (this.plot?.job === job) this.dropPlot();
    const index = this.measures.findIndex((each) => each.job === job);
    if (index >= 0) this.tools.reply({ type: 'dropped', job: this.measures.splice(index, 1)[0].job }, []);
  }

  private async work(): Promise<void> {
    if (this.working) return;
    this.working = true;
    await this.tools.pause(0);
    for (let task = this.next(); task; task = this.next()) {
      const pause = this.run(task.job, task.run);
      await this.tools.pause(pause);
    }
    this.working = false;
  }

  /** The most urgent thing to do, which returns how long to wait afterwards. */
  private next(): { job: number; run: () => number } | null {
    const { finish, plot } = this;
    if (finish) return { job: finish.job, run: () => this.finishStep(finish) };
    const measure = this.measures.shift();
    if (measure) return { job: measure.job, run: () => this.measure(measure) };
    if (plot) return { job: plot.job, run: () => this.plotStep(plot) };
    return null;
  }

  private run(job: number, task: () => number): number {
    try {
      return task();
    } catch (error) {
      if (this.finish?.job === job) this.finish = null;
      if (this.plot?.job === job) this.plot = null;
      this.tools.reply({ type: 'error', job, message: error instanceof Error ? error.message : String(error) }, []);
      return 0;
    }
  }

  private measure({ job, motion, keyPoses, grid, part }: Measure): number {
    const report = measureDance(motion, keyPoses, grid, part);
    this.tools.reply({ type: 'report', job, report }, [report.speed.buffer]);
    return 0;
  }

  private finishStep(finish: Finish & { drafted: boolean }): number {
    const { held } = this;
    if (!held) throw new Error('There is no dance whose key strength could be changed: generate one first.');
    const { job, strength, near, grid } = finish;
    if (near !== undefined && !finish.drafted) {
      finish.drafted = true;
      const motion = draftAround(held.dance, held.shown, held.keyPoses, strength, near);
      this.tools.reply({ type: 'draft', job, motion }, [motion.root.buffer, motion.quaternions.buffer]);
      return DRAFT_PAUSE;
    }
    this.finish = null;
    const motion = finishDance(held.dance, held.keyPoses, strength);
    held.shown = sliceMotion(motion, 0, motion.frames);
    const report = measureDance(motion, held.keyPoses, grid, partOf(held.dance));
    const transfer = [motion.root.buffer, motion.quaternions.buffer, report.speed.buffer];
    this.tools.reply({ type: 'finished', job, motion, report }, transfer);
    return 0;
  }

  private plotStep(plot: Plot & { next: number }): number {
    const { held } = this;
    if (!held) throw new Error('There is no dance to plot: generate one first.');
    const strength = plot.strengths[plot.next++];
    if (strength !== undefined) {
      const point = tradeOffPoint(held.dance, held.keyPoses, strength);
      this.tools.reply({ type: 'point', job: plot.job, point }, []);
    }
    if (plot.next >= plot.strengths.length) {
      this.plot = null;
      this.tools.reply({ type: 'plotted', job: plot.job }, []);
    }
    return 0;
  }
}

/**
 * The dance as shown, with the poses around a frame finished at another strength. The way over the floor stays the shown one, so the
 * figure does not jump; the whole dance follows when the dial rests.
 */
export function draftAround(
  dance: UncorrectedDance,
  shown: Motion,
  keyPoses: readonly KeyPose[],
  strength: number,
  near: number,
): Motion {
  const motion = flattened(dance);
  const begin = dance.place?.from ?? 0;
  const reach = DRAFT_REACH * motion.fps;
  const from = Math.max(begin, Math.round(near) - reach);
  const to = Math.min(begin + motion.frames, Math.round(near) + reach);
  const draft = sliceMotion(shown, 0, shown.frames);
  if (to - from < 2) return draft;
  const keys = keysWithin(keyPoses, from, to).filter((key) => key.time * motion.fps < to - from - 0.5);
  const part = finishDance({ motion: sliceMotion(motion, from - begin, to - begin), stretches: [] }, keys, strength);
  for (let t = 0; t < part.frames; t++) {
    for (const k of [0, 2]) part.root[t * 3 + k] = shown.root[(from + t) * 3 + k];
  }
  copyFrames(part, 0, part.frames, draft, from);
  return draft;
}
