import { describe, expect, it, vi } from 'vitest';
import { createReporter, type TunableDance } from '../../web/app/report-client';
import type { ReportReply, ReportRequest } from '../../web/app/report-protocol';
import { emptyMotion } from '../../web/core/motion';
import { fakeReport } from './support/app';
import { FakeWorker } from './support/worker';

class ReportWorker extends FakeWorker<ReportRequest, ReportReply> {
  types = () => this.sent.map((request) => ('job' in request ? `${request.type} ${request.job}` : request.type));
}

function open() {
  const worker = new ReportWorker();
  const reporter = createReporter(() => worker as unknown as Worker);
  const dance = (): TunableDance => ({
    uncorrected: { motion: emptyMotion(3), stretches: [] },
    motion: emptyMotion(3),
    keyPoses: [],
  });
  return { worker, reporter, dance };
}
const wish = (strength: number) => ({ strength, grid: null });

describe('the client of the report worker', () => {
  it('gives the worker a dance once, and again when it is another', async () => {
    const { worker, reporter, dance } = open();
    const [first, second] = [dance(), dance()];
    void reporter.finish(first, wish(0.5)).catch(() => undefined);
    void reporter.finish({ ...first, motion: emptyMotion(3) }, wish(0.4)).catch(() => undefined);
    const softer = { ...first, keyPoses: [{ id: 'k1', time: 1, rotations: [], strength: 0.5 }] };
    void reporter.finish(softer, wish(0.4)).catch(() => undefined);
    void reporter.finish(second, wish(0.3)).catch(() => undefined);
    expect(worker.types()).toEqual(['hold', 'finish 1', 'finish 2', 'keys', 'finish 3', 'hold', 'finish 4']);
  });

  it('hands on drafts and the result; what was dropped rejects', async () => {
    const { worker, reporter, dance } = open();
    const held = dance();
    const onDraft = vi.fn();
    const older = reporter.finish(held, { ...wish(0.5), near: 4, onDraft });
    const draft = emptyMotion(3);
    worker.reply({ type: 'draft', job: 1, motion: draft });
    const newer = reporter.finish(held, wish(0.6));
    worker.reply({ type: 'dropped', job: 1 });
    worker.reply({ type: 'finished', job: 2, motion: held.motion, report: fakeReport });
    await expect(older).rejects.toMatchObject({ name: 'AbortError' });
    expect(onDraft).toHaveBeenCalledWith(draft);
    expect(await newer).toEqual({ motion: held.motion, report: fakeReport });
  });

  it('plots point by point and can be stopped', async () => {
    const { worker, reporter, dance } = open();
    const onPoint = vi.fn();
    const controller = new AbortController();
    const plot = reporter.plot(dance(), [1, 0], onPoint, controller.signal);
    const point = { strength: 1, error: 0, jerk: 9 };
    worker.reply({ type: 'point', job: 1, point });
    controller.abort();
    await expect(plot).rejects.toMatchObject({ name: 'AbortError' });
    expect(onPoint).toHaveBeenCalledWith(point);
    expect(worker.types()).toEqual(['hold', 'plot 1', 'cancel 1']);
    worker.reply({ type: 'point', job: 1, point });
    expect(onPoint).toHaveBeenCalledTimes(1);
    await expect(reporter.plot(dance(), [1], onPoint, controller.signal)).rejects.toMatchObject({ name: 'AbortError' });
  });

  it('passes errors on and starts a new worker after one that died', async () => {
    const { worker, reporter, dance } = open();
    const held = dance();
    const failing = reporter.measure(held.motion, [], null);
    worker.reply({ type: 'error', job: 1, message: 'what to do' });
    await expect(failing).rejects.toThrow('what to do');
    const dying = reporter.finish(held, wish(1));
    worker.onerror?.({ preventDefault: () => undefined } as unknown as ErrorEvent);
    await expect(dying).rejects.toThrow(/stopped unexpectedly/);
    expect(worker.terminate).toHaveBeenCalled();
    void reporter.finish(held, wish(1)).catch(() => undefined);
    expect(worker.types().slice(-2)).toEqual(['hold', 'finish 3']);
  });
});
