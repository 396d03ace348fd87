import { describe, expect, it, vi } from 'vitest';
import { excerpt } from '../../web/core/excerpt';
import { finishDance, type UncorrectedDance } from '../../web/core/finish';
import { consistencyError, footSkate, jerkPerFrame } from '../../web/core/metrics';
import { sliceMotion } from '../../web/core/motion';
import { spec } from '../../web/core/spec';
import type { Motion } from '../../web/core/types';
import { keyDistances, musicRows, planWindows } from '../../web/core/window-plan';
import { generateMotion, type WindowInputs } from '../../web/core/windows';
import { clickFeatures, danceRequest, key, poseWith, slerpNetwork, steadyGrid } from './dance';

const arms = poseWith({ left_shoulder: [0, 0, 0.9], right_shoulder: [0, 0, -0.9] });
const turned = poseWith({
  pelvis: [0, 1.4, 0],
  left_elbow: [0, -1.2, 0],
  right_hip: [-0.6, 0, 0],
  right_knee: [0.8, 0, 0],
});
const keyPoses = [key(2.3, arms), key(6.8, turned), key(13.3, arms), key(17.9, turned)];
const same = (a: Motion, b: Motion) => {
  expect(a.root).toEqual(b.root);
  expect(a.quaternions).toEqual(b.quaternions);
};

describe('the plan of windows', () => {
  const { musicFrames, overlapFrames } = spec.model;
  it('is one window for a short song', () => {
    expect(planWindows(0, 100, [])).toEqual([{ start: 0, end: 100 }]);
  });
  it('ends windows right after a key and overlaps them', () => {
    const plan = planWindows(0, 700, [100, 200, 225, 400, 410]);
    expect(plan[0]).toEqual({ start: 0, end: 226 });
    expect(plan[1]).toEqual({ start: 226 - overlapFrames, end: 411 });
    expect(plan.at(-1)!.end).toBe(700);
    for (const { start, end } of plan) expect(end - start).toBeLessThanOrEqual(musicFrames);
  });
});

describe('the inputs of a window', () => {
  it('count the frames to the keys on both sides', () => {
    const { toPrevious, toNext } = keyDistances(Float32Array.from([0, 1, 0, 0, 1, 0]));
    expect(Array.from(toPrevious)).toEqual([-1, 0, 1, 2, 0, 1]);
    expect(Array.from(toNext)).toEqual([1, 0, 2, 1, 0, -1]);
  });
  it('have silence past the song', () => {
    const features = clickFeatures(1, steadyGrid(1, 120, 29 / 30));
    const rows = musicRows(features, 28, 4);
    const column = (name: string) => [0, 1, 2, 3].map((t) => rows[t * 15 + features.names.indexOf(name)]);
    expect(column('chroma_c')).toEqual([1, 1, 1, 1]);
    expect(column('beat')).toEqual([0, 1, 0, 0]);
  });
  it('are in the frame of the last seed pose, with the turned keys', async () => {
    const seen: WindowInputs[] = [];
    await generateMotion(danceRequest(6, { keyPoses: [key(1, turned)] }), async (inputs) => {
      seen.push(inputs);
      return slerpNetwork(inputs);
    });
    const { seed, seedFrames, keyMask, keyPoses: poses, music, frames } = seen[0];
    expect([seedFrames, music.length]).toEqual([60, frames * 15]);
    const last = seed.subarray(59 * 147, 60 * 147);
    expect(last[144]).toBeCloseTo(0, 5);
    expect(last[146]).toBeCloseTo(0, 5);
    expect(keyMask[30]).toBe(1);
    // A first key soon after the start turns the whole opening, so in the local frame it faces forwards: column 0 = x.
    expect(poses[30 * 144]).toBeCloseTo(1, 2);
  });
});

describe('a generated dance', () => {
  it('has exactly the frames of the song and hits its keys at strength 1, not at 0', async () => {
    for (const seconds of [0.2, 3.01, 20]) {
      const request = danceRequest(seconds, { keyPoses });
      const motion = await generateMotion(request, slerpNetwork);
      expect(motion.frames).toBe(Math.ceil(seconds * 30));
      expect(motion.quaternions.every(Number.isFinite) && motion.root.every(Number.isFinite)).toBe(true);
    }
    const noisy = async (inputs: WindowInputs) =>
      (await slerpNetwork(inputs)).map((v, i) => (i % 147 < 144 ? v + 0.1 * Math.sin(i) : v));
    const exact = await generateMotion(danceRequest(20, { keyPoses }), noisy);
    expect(consistencyError(exact, keyPoses)).toBeLessThan(1e-6);
    const loose = danceRequest(20, { keyPoses });
    loose.options.keyStrength = 0;
    const error = consistencyError(await generateMotion(loose, noisy), keyPoses);
    expect(error).toBeGreaterThan(0.01);
    expect(error).toBeLessThan(3);
  });

  it('is the same every time, and another with another seed', async () => {
    const first = await generateMotion(danceRequest(12), slerpNetwork);
    same(await generateMotion(danceRequest(12), slerpNetwork), first);
    const request = danceRequest(12);
    request.options.seed = 2;
    expect((await generateMotion(request, slerpNetwork)).quaternions).not.toEqual(first.quaternions);
  });

  it('shows final frames while it is made', async () => {
    const parts: Motion[] = [];
    const motion = await generateMotion(danceRequest(25, { keyPoses }), slerpNetwork, {
      onPartial: (part) => parts.push(part!),
    });
    expect(parts.length).toBeGreaterThanOrEqual(2);
    let before = 0;
    for (const part of parts) {
      expect(part.frames).toBeGreaterThan(before);
      before = part.frames;
      same(part, sliceMotion(motion, 0, part.frames));
    }
  });

  it('does not pop where windows join', async () => {
    const starts: number[] = [];
    const request = danceRequest(30, { keyPoses: [] });
    // A network that disagrees with itself from window to window: each has its own slow sway.
    const motion = await generateMotion(request, async (inputs) => {
      const rows = await slerpNetwork(inputs);
      const window = starts.push(0);
      return rows.map((v, i) => (i % 147 < 144 ? v + 0.05 * Math.sin(Math.floor(i / 147) / 15 + window) : v));
    });
    const jerk = jerkPerFrame(motion, true);
    const mean = jerk.reduce((sum, v) => sum + v, 0) / jerk.length;
    const joins = planWindows(0, motion.frames + 30, [])
      .slice(1)
      .map(({ start }) => start);
    for (const join of joins) {
      const near = jerk.subarray(join - 3, join + 30);
      expect(near.reduce((sum, v) => sum + v, 0) / near.length).toBeLessThan(1.5 * mean);
    }
    expect(footSkate(motion)).toBeLessThan(0.13);
  });

  it('stops between windows when it is aborted', async () => {
    const controller = new AbortController();
    const run = vi.fn(async (inputs: WindowInputs) => {
      if (run.mock.calls.length === 2) controller.abort();
      return slerpNetwork(inputs);
    });
    await expect(generateMotion(danceRequest(60), run, { signal: controller.signal })).rejects.toThrow(/abort/i);
    expect(run).toHaveBeenCalledTimes(2);
  });

  it('says what is wrong with a request', async () => {
    await expect(generateMotion(danceRequest(0), slerpNetwork)).rejects.toThrow('drop a song');
    const range = { from: 10, to: 20 };
    await expect(generateMotion(danceRequest(4, { range }), slerpNetwork)).rejects.toThrow('generate the whole dance');
    await expect(generateMotion(danceRequest(4), async () => new Float32Array(3))).rejects.toThrow('3 numbers');
  });
});

describe('a part of the song', () => {
  const trim = { from: 123, to: 437 };
  it('is danced as a song of its own, with stillness around it, and shows itself while it is made', async () => {
    const keys = [key(2, arms), key(6.8, turned), key(437 / 30, arms), key(18, turned)];
    const parts: Motion[] = [];
    let uncorrected: UncorrectedDance | undefined;
    const request = danceRequest(20, { keyPoses: keys, trim });
    const motion = await generateMotion(request, slerpNetwork, {
      onPartial: (part) => parts.push(part!),
      onUncorrected: (made) => (uncorrected = made),
    });
    expect(motion.frames).toBe(600);
    for (const t of [0, 60, 122]) same(sliceMotion(motion, t, t + 1), sliceMotion(motion, 123, 124));
    for (const t of [437, 599]) same(sliceMotion(motion, t, t + 1), sliceMotion(motion, 436, 437));
    expect(sliceMotion(motion, 200, 201).quaternions).not.toEqual(sliceMotion(motion, 123, 124).quaternions);
    expect(consistencyError(motion, [keys[1]])).toBeLessThan(1e-6);
    // A pose on the very end of the part is its last one.
    expect(consistencyError(motion, [{ ...keys[2], time: 436 / 30 }])).toBeLessThan(1e-6);
    const alone = await generateMotion({ ...request, ...excerpt(request, 123, 437), trim: undefined }, slerpNetwork);
    same(sliceMotion(motion, 123, 437), alone);
    expect(parts.length).toBeGreaterThan(0);
    for (const part of parts) same(part, sliceMotion(motion, 0, part.frames));
    same(finishDance(uncorrected!, keys, 1), motion);
    const all = await generateMotion(danceRequest(20, { keyPoses: keys, trim: { from: 0, to: 600 } }), slerpNetwork);
    same(all, await generateMotion(danceRequest(20, { keyPoses: keys }), slerpNetwork));
  });

  it('has ranges made anew in it, clipped to it', async () => {
    let uncorrected: UncorrectedDance | undefined;
    const hooks = { onUncorrected: (made: UncorrectedDance) => (uncorrected = made) };
    const before = await generateMotion(danceRequest(20, { keyPoses, trim }), slerpNetwork, hooks);
    const range = { from: 400, to: 600 };
    const options = { keyStrength: 1, variation: 1, seed: 9, cleanFeet: true };
    const again = { keyPoses, trim, range, previousUncorrected: uncorrected, options };
    const motion = await generateMotion(danceRequest(20, again), slerpNetwork, hooks);
    same(sliceMotion(motion, 0, 400), sliceMotion(before, 0, 400));
    expect(sliceMotion(motion, 420, 437).quaternions).not.toEqual(sliceMotion(before, 420, 437).quaternions);
    same(sliceMotion(motion, 599, 600), sliceMotion(motion, 436, 437));
    same(finishDance(uncorrected!, keyPoses, 1), motion);
    const elsewhere = { ...again, trim: { from: 100, to: 437 }, previousUncorrected: uncorrected };
    await expect(generateMotion(danceRequest(20, elsewhere), slerpNetwork)).rejects.toThrow('another part of the song');
    const empty = { keyPoses, trim: { from: 9, to: 9 } };
    await expect(generateMotion(danceRequest(20, empty), slerpNetwork)).rejects.toThrow('trim it anew');
  });
});

describe('a range made anew', () => {
  it('changes the range only, hits its keys and joins without a pop', async () => {
    const previous = await generateMotion(danceRequest(20), slerpNetwork);
    const range = { from: 200, to: 400 };
    const inside = [key(10, arms)];
    const request = danceRequest(20, { keyPoses: inside, range, previous });
    request.options.seed = 9;
    const motion = await generateMotion(request, slerpNetwork);
    same(sliceMotion(motion, 0, 200), sliceMotion(previous, 0, 200));
    same(sliceMotion(motion, 400, 600), sliceMotion(previous, 400, 600));
    expect(sliceMotion(motion, 220, 380).quaternions).not.toEqual(sliceMotion(previous, 220, 380).quaternions);
    expect(consistencyError(motion, inside)).toBeLessThan(1e-6);
    const jerk = jerkPerFrame(motion, true);
    const limit = Math.max(...jerkPerFrame(previous, true)) * 1.3;
    for (const join of [200, 400]) {
      expect(Math.max(...jerk.subarray(join - 4, join + 3))).toBeLessThan(limit);
      for (const t of [join - 1, join, join + 1]) {
        const step = Math.hypot(...[0, 1, 2].map((k) => motion.root[t * 3 + k] - motion.root[t * 3 - 3 + k]));
        expect(step * 30).toBeLessThan(1.5);
      }
    }
  });

  it('works at both ends of the song', async () => {
    const previous = await generateMotion(danceRequest(10), slerpNetwork);
    for (const range of [
      { from: 0, to: 100 },
      { from: 250, to: 300 },
      { from: 10, to: 14 },
    ]) {
      const motion = await generateMotion(
        danceRequest(10, { range, previous, keyPoses: [key(9, arms)] }),
        slerpNetwork,
      );
      expect(motion.frames).toBe(300);
      expect(motion.root.every(Number.isFinite) && motion.quaternions.every(Number.isFinite)).toBe(true);
      same(sliceMotion(motion, range.to, 300), sliceMotion(previous, range.to, 300));
    }
  });
});
