import { describe, expect, it } from 'vitest';
import { finishDance, flattened, type UncorrectedDance } from '../../web/core/finish';
import { consistencyError } from '../../web/core/metrics';
import { motionToAxisAngle } from '../../web/core/motion';
import { sameMotion } from '../../web/core/range-layer';
import { consistencyPerKey } from '../../web/core/report-curves';
import type { KeyPose, Motion } from '../../web/core/types';
import { generateMotion, type GenerationRequest } from '../../web/core/windows';
import { danceRequest, key, poseWith, slerpNetwork } from './dance';

const arms = poseWith({ left_shoulder: [0, 0, 0.9], right_shoulder: [0, 0, -0.9] });
const turned = poseWith({ pelvis: [0, 1.4, 0], left_elbow: [0, -1.2, 0], right_hip: [-0.6, 0, 0] });
const keyPoses = [key(2.3, arms), key(6.8, turned), key(7.1, arms), key(13.3, arms), key(17.9, turned)];

/** A network that misses its keys a little, so that there is something to correct. */
const missing: typeof slerpNetwork = async (inputs) => {
  const rows = await slerpNetwork(inputs);
  for (let i = 0; i < rows.length; i += 147) for (let k = 12; k < 18; k++) rows[i + k] += 0.15 * Math.sin(i + k);
  return rows;
};

async function dance(strength: number, more: Partial<GenerationRequest> = {}) {
  const request = danceRequest(20, { keyPoses, ...more });
  request.options = { ...request.options, keyStrength: strength };
  let uncorrected: UncorrectedDance | undefined;
  const motion = await generateMotion(request, missing, { onUncorrected: (made) => (uncorrected = made) });
  return { motion, uncorrected };
}

const apart = (a: Motion, b: Motion, from = 0, to = a.frames) => {
  let most = 0;
  for (let i = from * 96; i < to * 96; i++) most = Math.max(most, Math.abs(a.quaternions[i] - b.quaternions[i]));
  for (let i = from * 3; i < to * 3; i++) most = Math.max(most, Math.abs(a.root[i] - b.root[i]));
  return most;
};

/** The key poses with strengths of their own. */
const softened = keyPoses.map((pose, i) => ({ ...pose, strength: [1, 0.5, 0, 0.8, 1][i] }));

describe('finishing a dance again', () => {
  it('follows the strength of each key pose, which the network never sees', async () => {
    const { uncorrected } = await dance(1);
    const own = await dance(0.9, { keyPoses: softened });
    expect(sameMotion(own.uncorrected!.motion, uncorrected!.motion)).toBe(true);
    expect(apart(finishDance(uncorrected!, softened, 0.9), own.motion)).toBe(0);
    const errors = (keys: KeyPose[]) =>
      consistencyPerKey(finishDance(uncorrected!, keys, 1), keyPoses).map(({ error }) => error);
    const [free, soft] = [errors(keyPoses.map((pose) => ({ ...pose, strength: 0 }))), errors(softened)];
    for (const exact of [0, 4]) expect(soft[exact]).toBeLessThan(1e-9);
    expect(soft[2]).toBeGreaterThan(0.9 * free[2]);
    expect(soft[1]).toBeGreaterThan(0.15 * free[1]);
    expect(soft[1]).toBeLessThan(0.4 * free[1]);
    // At 0.8 a fifth of the miss is left, and a fifth of what planting the feet does to the pose.
    expect(soft[3]).toBeLessThan(0.2 * free[3]);
    // The same product of dial and key is the same dance.
    const half = keyPoses.map((pose) => ({ ...pose, strength: 0.5 }));
    expect(apart(finishDance(uncorrected!, half, 1), finishDance(uncorrected!, keyPoses, 0.5))).toBe(0);
  });

  it('gives what generating at that strength gives, without the network', async () => {
    const { uncorrected } = await dance(0.4);
    for (const strength of [0, 0.5, 1]) {
      const { motion } = await dance(strength);
      expect(apart(finishDance(uncorrected!, keyPoses, strength), motion)).toBe(0);
    }
  });

  it('is exact at 1, free at 0, and leaves the uncorrected dance alone', async () => {
    const { uncorrected } = await dance(1);
    const before = uncorrected!.motion.quaternions.slice();
    const errors = [0, 0.25, 0.5, 0.75, 1].map((strength) =>
      consistencyError(finishDance(uncorrected!, keyPoses, strength), keyPoses),
    );
    for (let i = 1; i < errors.length; i++) expect(errors[i]).toBeLessThan(errors[i - 1]);
    expect(errors[0]).toBeGreaterThan(1e-4);
    expect(errors[4]).toBeLessThan(1e-6);
    expect(uncorrected!.motion.quaternions).toEqual(before);
  });

  it('leaves the pose on a key to the strength alone: the clean-up of the feet turns nothing there', async () => {
    const { uncorrected } = await dance(0);
    const cleaned = finishDance(uncorrected!, keyPoses, 0);
    const free = consistencyError(uncorrected!.motion, keyPoses);
    expect(Math.abs(consistencyError(cleaned, keyPoses) - free)).toBeLessThan(1e-6);
    expect(apart(cleaned, uncorrected!.motion)).toBeGreaterThan(1e-3);
  });

  it('knows a range made anew too, without a pop at its ends', async () => {
    const whole = await dance(1);
    const range = { from: 240, to: 420 };
    const again = await dance(1, {
      range,
      previous: whole.motion,
      previousUncorrected: whole.uncorrected,
      options: { keyStrength: 1, variation: 1, seed: 9, cleanFeet: true },
    });
    const uncorrected = { motion: flattened(again.uncorrected!) };
    expect(apart(uncorrected.motion, whole.uncorrected!.motion, 0, range.from)).toBe(0);
    expect(apart(uncorrected.motion, whole.uncorrected!.motion, range.to)).toBe(0);
    expect(apart(uncorrected.motion, whole.uncorrected!.motion, range.from, range.to)).toBeGreaterThan(0.05);
    const steps = (motion: Motion, t: number) =>
      apart(
        { ...motion, quaternions: motion.quaternions.subarray((t - 1) * 96), root: motion.root.subarray((t - 1) * 3) },
        { ...motion, quaternions: motion.quaternions.subarray(t * 96), root: motion.root.subarray(t * 3) },
        0,
        1,
      );
    const largest = Math.max(...Array.from({ length: 599 }, (_, t) => steps(whole.uncorrected!.motion, t + 1)));
    for (const edge of [range.from, range.to]) {
      for (let t = edge - 2; t <= edge + 2; t++) expect(steps(uncorrected.motion, t)).toBeLessThan(largest * 1.5);
    }
  });

  it('is the same for ranges laid over it, whatever the strength was when they were made', async () => {
    const keysNow = softened;
    const ranges = [
      { from: 90, to: 215, seed: 4 },
      { from: 200, to: 330, seed: 5 },
      { from: 470, to: 600, seed: 6 },
    ];
    const layered = async (strengths: number[]) => {
      let made = await dance(strengths[0], { keyPoses: keysNow });
      for (const [i, { from, to, seed }] of ranges.entries()) {
        made = await dance(strengths[i + 1], {
          keyPoses: keysNow,
          range: { from, to },
          previousUncorrected: made.uncorrected,
          options: { keyStrength: 1, variation: 0.6, seed, cleanFeet: true },
        });
      }
      return made;
    };
    const once = await layered([0.7, 0.7, 0.7, 0.7]);
    const moved = await layered([1, 0, 0.2, 0.4]);
    expect(apart(finishDance(moved.uncorrected!, keysNow, 0.7), once.motion)).toBe(0);
    expect(apart(finishDance(once.uncorrected!, keysNow, 0.4), moved.motion)).toBe(0);
    // Between the ranges nothing changed (a quaternion and its negative are one rotation).
    const before = await dance(0.7, { keyPoses: keysNow });
    const angles = motionToAxisAngle(once.motion);
    const former = motionToAxisAngle(before.motion);
    for (let i = 330 * 72; i < 470 * 72; i++) expect(Math.abs(angles[i] - former[i])).toBeLessThan(1e-6);
    for (let i = 330 * 3; i < 470 * 3; i++) expect(once.motion.root[i]).toBe(before.motion.root[i]);
  });

  it('hands no uncorrected form of a range out when it has none of the rest', async () => {
    const whole = await dance(1);
    const again = await dance(1, { range: { from: 240, to: 420 }, previous: whole.motion });
    expect(again.uncorrected).toBeUndefined();
  });
});
