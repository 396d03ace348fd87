import { describe, expect, it, vi } from 'vitest';
import { CHANNELS, rotationChannel, sampleCurves } from '../../web/core/curves';
import { CURVE_SIZE, generateCurves, intervalInputs, type CurveRequest } from '../../web/core/curves-dance';
import { FRAME_FEATURE_SIZE } from '../../web/core/beat-features';
import { TIMBRE_SIZE } from '../../web/core/mfcc';
import { bodyTrack } from '../../web/core/contact-body';
import { consistencyError, footSkate } from '../../web/core/metrics';
import { forwardKinematics } from '../../web/core/skeleton';
import { fourPoses } from '../e2e/support/page';
import { fakeIntervals } from './support/curves';
import { danceRequest, key, poseWith } from './dance';

const poses = [
  poseWith({ left_shoulder: [0, 0, 1], left_knee: [0.6, 0, 0], left_hip: [-0.5, 0, 0] }),
  poseWith({ right_shoulder: [0, 0, -1], spine1: [0, 0.4, 0] }),
  poseWith({ left_elbow: [0, -1.2, 0], pelvis: [0, 0.7, 0] }),
];

/** A song of some seconds with MFCC; beats every half second from 0.3 s on. */
function request(seconds: number, overrides: Partial<CurveRequest> = {}): CurveRequest {
  const { features, ...rest } = danceRequest(seconds);
  const timbre = Float32Array.from({ length: features.frames * TIMBRE_SIZE }, (_, i) => Math.sin(i * 0.7));
  return { ...rest, features: { ...features, timbre }, ...overrides };
}
const keysAt = (...times: number[]) => times.map((time, i) => key(time, poses[i % poses.length]));

describe('a dance of curves', () => {
  it('hits every key pose exactly and is as long as the song', async () => {
    const keyPoses = keysAt(1.3, 2.3, 2.8, 4.3);
    const { motion, curves } = await generateCurves(request(6, { keyPoses }), fakeIntervals);
    expect(motion.frames).toBe(180);
    expect(consistencyError(motion, keyPoses)).toBeLessThan(1e-9);
    expect(curves.anchors.filter((anchor) => typeof anchor === 'string')).toEqual(keyPoses.map(({ id }) => id));
    expect(sampleCurves(curves, 30)).toEqual(motion);
  });

  it('is the same for the same project, and another for another seed where there are gaps', async () => {
    const keyPoses = keysAt(1.3, 6.3);
    const make = async (seed: number) =>
      (
        await generateCurves(
          request(8, { keyPoses, options: { variation: 0.8, seed, cleanFeet: true } }),
          fakeIntervals,
        )
      ).motion;
    const [a, b, c] = [await make(1), await make(1), await make(2)];
    expect(a).toEqual(b);
    expect(c.quaternions).not.toEqual(a.quaternions);
    for (const motion of [a, c]) expect(consistencyError(motion, keyPoses)).toBeLessThan(1e-9);
  });

  it('has poses on the beats of long gaps and at its open ends, none in short gaps', async () => {
    const { curves } = await generateCurves(request(8, { keyPoses: keysAt(1.3, 2.1, 6.3) }), fakeIntervals);
    const beats = curves.anchors.filter((anchor) => typeof anchor === 'number');
    // Beat b is at 0.3 + b / 2 s: frame 0 is 0.6 beats before the first.
    expect(beats[0]).toBeCloseTo(-0.6, 3);
    expect(beats.slice(1, -1)).toEqual([1, 5, 6, 7, 8, 9, 10, 11, 13, 14]);
    expect(beats[beats.length - 1]).toBeGreaterThan(14);
    const { times } = curves;
    for (let k = 0; k + 1 < times.length; k++) expect(times[k + 1] - times[k]).toBeLessThanOrEqual(0.9 + 1e-9);
  });

  it('stays on the floor, the way over it running on', async () => {
    const { motion } = await generateCurves(request(8, { keyPoses: keysAt(1.3, 3.3, 4.3) }), fakeIntervals);
    let lowest = Infinity;
    for (let t = 0; t < motion.frames; t++) {
      const joints = forwardKinematics(
        motion.quaternions.subarray(t * 96, t * 96 + 96),
        motion.root.subarray(t * 3, t * 3 + 3),
      );
      for (let i = 1; i < 72; i += 3) lowest = Math.min(lowest, joints[i]);
      if (t > 0) {
        const step = Math.hypot(
          motion.root[t * 3] - motion.root[t * 3 - 3],
          motion.root[t * 3 + 2] - motion.root[t * 3 - 1],
        );
        expect(step).toBeLessThan(0.12);
      }
    }
    expect(lowest).toBeGreaterThan(-0.01);
    expect(lowest).toBeLessThan(0.05);
  });

  it('puts its feet down: they slide a third as fast as on the bare curves, and nothing dips below the floor', async () => {
    const dances = [false, true].map((cleanFeet) =>
      generateCurves(
        request(12, {
          keyPoses: fourPoses().map((pose, i) => key(1.3 + 2 * i, pose)),
          options: { variation: 0.5, seed: 1, cleanFeet },
        }),
        fakeIntervals,
      ),
    );
    const [bare, planted] = (await Promise.all(dances)).map(({ motion }) => motion);
    expect(footSkate(planted)).toBeLessThan(footSkate(bare) / 3);
    const { ground } = bodyTrack(planted);
    const dips = ground.map((y, t) => y - planted.root[t * 3 + 1]);
    expect(Math.max(...dips)).toBeLessThan(0.003);
  });

  it('keeps to the trimmed part and holds still around it', async () => {
    const { motion, curves } = await generateCurves(
      request(8, { keyPoses: keysAt(0.5, 3.3, 7.5), trim: { from: 60, to: 180 } }),
      fakeIntervals,
    );
    expect(curves.times[0]).toBe(2);
    expect(curves.times[curves.times.length - 1]).toBeGreaterThan(179 / 30 - 0.4);
    expect(curves.times[curves.times.length - 1]).toBeLessThanOrEqual(179 / 30);
    expect(curves.anchors).not.toContain('k0.5');
    const pose = (t: number) => [...motion.quaternions.slice(t * 96, t * 96 + 96)];
    expect(pose(0)).toEqual(pose(60));
    expect(pose(239)).toEqual(pose(179));
    expect(pose(100)).not.toEqual(pose(101));
  });

  it('dances a range with a take of its own another way, and the same poses outside', async () => {
    const base = { keyPoses: keysAt(1.3), options: { variation: 0.9, seed: 1, cleanFeet: false } };
    const whole = await generateCurves(request(10, base), fakeIntervals);
    const takes = [{ from: 120, to: 210, seed: 5, variation: 1 }];
    const other = await generateCurves(request(10, { ...base, takes }), fakeIntervals);
    expect(other.curves.times).toEqual(whole.curves.times);
    let changed = 0;
    for (let k = 0; k < whole.curves.times.length; k++) {
      const row = (curves: typeof whole.curves) => curves.keys.slice(k * CHANNELS + 3, (k + 1) * CHANNELS);
      const frame = Math.round(whole.curves.times[k] * 30);
      if (frame < 120 || frame >= 210) expect(row(other.curves), `frame ${frame}`).toEqual(row(whole.curves));
      else if (row(other.curves).some((value, i) => value !== row(whole.curves)[i])) changed += 1;
    }
    expect(changed).toBeGreaterThan(2);
  });

  it('is cancelled between runs of the network, and refuses what is no answer', async () => {
    const controller = new AbortController();
    const run = vi.fn(async (inputs: Parameters<typeof fakeIntervals>[0]) => {
      controller.abort();
      return fakeIntervals(inputs);
    });
    const long = request(60, { keyPoses: keysAt(1) });
    await expect(generateCurves(long, run, { signal: controller.signal })).rejects.toThrow('abort');
    expect(run).toHaveBeenCalledTimes(1);
    const short = async () => ({ curves: new Float32Array(5), root: new Float32Array(6) });
    await expect(generateCurves(request(4), short)).rejects.toThrow('another size');
    await expect(generateCurves(request(4, { trim: { from: 50, to: 51 } }), fakeIntervals)).rejects.toThrow('trim');
  });

  it('takes tension, continuity, bias and the root as the network gives them, held to what they can be', async () => {
    const { curves } = await generateCurves(
      request(4, {
        keyPoses: keysAt(0.3, 1.3, 2.3, 3.3),
        options: { variation: 0, seed: 1, cleanFeet: false },
      }),
      async (inputs) => {
        const given = await fakeIntervals(inputs);
        for (let i = 0; i < given.curves.length; i += CURVE_SIZE) given.curves.set([0.5, -3, 0.25], i);
        for (let i = 0; i < inputs.intervals; i++) given.root.set([0, 0.9, 0, 0.1, 0.95, -0.2], i * 6);
        return given;
      },
    );
    const [first, second] = [0, 1].map((k) => curves.keys.slice(k * CHANNELS, k * CHANNELS + 3));
    expect([...first]).toEqual([0, expect.closeTo(0.9, 6), 0]);
    expect([...second]).toEqual([0.1, 0.95, -0.2].map((value) => expect.closeTo(value, 6)));
    expect(curves.keys[2 * CHANNELS]).toBeCloseTo(0.2, 6);
    expect(curves.inner[0]).toBeCloseTo(0.1 / 3, 6);
    expect([curves.shape[5], curves.shape[CHANNELS + 5], curves.shape[2 * CHANNELS + 5]]).toEqual([0.5, -1, 0.25]);
  });
});

describe('what the network is fed', () => {
  it('is the key poses around an interval, its times and the music inside it', async () => {
    const { curves } = await generateCurves(request(4, { keyPoses: keysAt(0.3, 1.1, 1.9, 2.7) }), fakeIntervals);
    const rows = Float32Array.from({ length: 120 * FRAME_FEATURE_SIZE }, (_, i) => Math.floor(i / FRAME_FEATURE_SIZE));
    const own = curves.anchors.flatMap((anchor, k) => (typeof anchor === 'string' ? [k] : []));
    const { keys, keyMask, seconds, music } = intervalInputs(curves, rows, own[1], 1);
    const at = (k: number) => [...curves.keys.slice(k * CHANNELS + rotationChannel(0), (k + 1) * CHANNELS)];
    [0, 1, 2, 3].forEach((n) => expect([...keys.slice(n * 96, n * 96 + 96)]).toEqual(at(own[n])));
    expect([...keyMask]).toEqual([1, 1]);
    [...seconds].forEach((value) => expect(value).toBeCloseTo(0.8, 6));
    // Moment s is at 1.1 + 0.8 (s + 1/2) / 8 seconds: frame 33 + 24 (s + 1/2) / 8.
    [0, 3, 7].forEach((s) => expect(music[s * FRAME_FEATURE_SIZE + 9]).toBeCloseTo(33 + (24 * (s + 0.5)) / 8, 4));
    const first = intervalInputs(curves, rows, 0, 1);
    expect([...first.keyMask]).toEqual([0, 1]);
    expect(first.seconds[0]).toBe(0);
    expect([...first.keys.slice(0, 96)]).toEqual([...first.keys.slice(96, 192)]);
  });
});
