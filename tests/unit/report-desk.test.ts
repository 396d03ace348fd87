import { describe, expect, it } from 'vitest';
import { draftAround, ReportDesk } from '../../web/app/report-desk';
import type { ReportReply } from '../../web/app/report-protocol';
import { heldAround } from '../../web/core/excerpt';
import { finishDance, type UncorrectedDance } from '../../web/core/finish';
import { consistencyError } from '../../web/core/metrics';
import { sliceMotion } from '../../web/core/motion';
import type { Motion } from '../../web/core/types';
import { key, poseWith, swingingMotion } from './dance';

const arms = poseWith({ left_shoulder: [0, 0, 0.9], right_shoulder: [0, 0, -0.9] });
const keyPoses = [key(2, arms), key(5, arms), key(15, arms)];
const dance: UncorrectedDance = { motion: swingingMotion(600), stretches: [] };

function desk() {
  const replies: ReportReply[] = [];
  /** Lets the desk do its next task. */
  let go: () => void = () => undefined;
  const pauses: number[] = [];
  const made = new ReportDesk({
    reply: (message) => replies.push(message),
    pause: (milliseconds) => {
      pauses.push(milliseconds);
      return new Promise((resolve) => (go = resolve));
    },
  });
  const step = async () => {
    go();
    await new Promise((resolve) => setTimeout(resolve));
  };
  const types = () => replies.map(({ type, job }) => `${type} ${job}`);
  made.handle({ type: 'hold', dance, motion: finishDance(dance, keyPoses, 1), keyPoses });
  return { desk: made, replies, pauses, step, types };
}

describe('the report desk', () => {
  it('gives a draft around the playhead, waits, then the whole dance with its report', async () => {
    const { desk: made, replies, pauses, step, types } = desk();
    made.handle({ type: 'finish', job: 1, strength: 0.5, grid: null, near: 150 });
    await step();
    expect(types()).toEqual(['draft 1']);
    expect(pauses.at(-1)).toBeGreaterThan(50);
    await step();
    expect(types()).toEqual(['draft 1', 'finished 1']);
    const done = replies[1] as Extract<ReportReply, { type: 'finished' }>;
    expect(done.motion.quaternions).toEqual(finishDance(dance, keyPoses, 0.5).quaternions);
    expect(done.report.consistencyError).toBe(consistencyError(done.motion, keyPoses));
    expect(done.report.consistencyPerKey.map(({ id }) => id)).toEqual(['k2', 'k5', 'k15']);
  });

  it('finishes with other strengths of the key poses when it is told', async () => {
    const { desk: made, replies, step } = desk();
    const own = keyPoses.map((pose, i) => ({ ...pose, strength: [0, 0.5, 1][i] }));
    made.handle({ type: 'keys', keyPoses: own });
    made.handle({ type: 'finish', job: 1, strength: 0.8, grid: null });
    await step();
    const done = replies[0] as Extract<ReportReply, { type: 'finished' }>;
    expect(done.motion.quaternions).toEqual(finishDance(dance, own, 0.8).quaternions);
    const [free, half, firm] = done.report.consistencyPerKey.map(({ error }) => error);
    expect(free).toBeGreaterThan(half);
    expect(half).toBeGreaterThan(firm);
  });

  it('measures the danced part of a trimmed song alone, in the song’s own time', async () => {
    const { desk: made, replies, step } = desk();
    const part = { from: 120, to: 300 };
    const motion = heldAround(sliceMotion(finishDance(dance, keyPoses, 1), part.from, part.to), part.from, 600);
    const beats = Array.from({ length: 40 }, (_, i) => i / 2);
    const grid = { tempo: 120, beatsPerBar: 4 as const, beats, downbeats: [0] };
    made.handle({ type: 'measure', job: 1, motion, keyPoses, grid, part });
    made.handle({ type: 'measure', job: 2, motion: sliceMotion(motion, 120, 300), keyPoses: [], grid, part: null });
    await step();
    await step();
    const [whole, alone] = replies.map((reply) => (reply as Extract<ReportReply, { type: 'report' }>).report);
    expect(whole.consistencyPerKey.map(({ id, time }) => [id, time])).toEqual([['k5', 5]]);
    expect(whole.consistencyError).toBeLessThan(1e-9);
    expect(whole.jerk).toBe(alone.jerk);
    expect(whole.speed).toHaveLength(599);
    expect(whole.speed[50]).toBe(0);
    expect(whole.longestFreeze).toBe(alone.longestFreeze);
    // Beats lie half a second apart, and the part begins on one: beat by beat they are the same.
    expect(whole.beatHitRate).toEqual(alone.beatHitRate);
    expect(Math.min(...whole.motionBeats)).toBeGreaterThanOrEqual(4);
    expect(whole.motionBeats).toEqual(alone.motionBeats.map((beat) => beat + 4));
  });

  it('drops an older wish for a newer one', async () => {
    const { desk: made, step, types } = desk();
    made.handle({ type: 'finish', job: 1, strength: 0.5, grid: null, near: 150 });
    await step();
    made.handle({ type: 'finish', job: 2, strength: 0.4, grid: null });
    await step();
    await step();
    expect(types()).toEqual(['draft 1', 'dropped 1', 'finished 2']);
  });

  it('plots when nothing else is to do, point by point, and can be stopped', async () => {
    const { desk: made, replies, step, types } = desk();
    made.handle({ type: 'plot', job: 1, strengths: [1, 0, 0.5] });
    made.handle({ type: 'measure', job: 2, motion: dance.motion, keyPoses, grid: null, part: null });
    await step();
    await step();
    expect(types()).toEqual(['report 2', 'point 1']);
    const point = replies[1] as Extract<ReportReply, { type: 'point' }>;
    expect(point.point.error).toBeLessThan(1e-6);
    await step();
    made.handle({ type: 'cancel', job: 1 });
    await step();
    expect(types()).toEqual(['report 2', 'point 1', 'point 1', 'dropped 1']);
    made.handle({ type: 'plot', job: 3, strengths: [0.5] });
    await step();
    expect(types().slice(4)).toEqual(['point 3', 'plotted 3']);
  });

  it('says what is wrong when there is no dance', async () => {
    const replies: ReportReply[] = [];
    const made = new ReportDesk({ reply: (message) => replies.push(message), pause: () => Promise.resolve() });
    made.handle({ type: 'finish', job: 7, strength: 1, grid: null });
    await new Promise((resolve) => setTimeout(resolve, 5));
    expect(replies).toEqual([{ type: 'error', job: 7, message: expect.stringMatching(/generate one first/) }]);
  });
});

describe('a draft', () => {
  it('hits the keys near the frame as the whole dance will, and leaves the rest as shown', () => {
    const shown = finishDance(dance, keyPoses, 0);
    const draft = draftAround(dance, shown, keyPoses, 1, 120);
    const pose = (motion: Motion, t: number) => motion.quaternions.slice(t * 96, t * 96 + 96);
    expect(consistencyError(draft, keyPoses.slice(0, 2))).toBeLessThan(1e-6);
    for (const t of [270, 450, 599]) expect(pose(draft, t)).toEqual(pose(shown, t));
    expect(pose(draft, 150)).not.toEqual(pose(shown, 150));
    for (let t = 0; t < 600; t++) expect(draft.root[t * 3]).toBe(shown.root[t * 3]);
  });
});
