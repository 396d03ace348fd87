import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { bodyTrack } from '../../web/core/contact-body';
import { correctToKeys, keysOnFrames } from '../../web/core/correction';
import { consistencyError } from '../../web/core/metrics';
import { spec } from '../../web/core/spec';
import { planWindows } from '../../web/core/window-plan';
import { generateMotion } from '../../web/core/windows';
import { danceRequest, key, slerpNetwork, swingingMotion } from '../unit/dance';

const pose = fc.array(fc.double({ min: -2, max: 2, noNaN: true }), { minLength: 72, maxLength: 72 });
const keys = fc.array(fc.tuple(fc.double({ min: 0, max: 5.9, noNaN: true }), pose), { minLength: 1, maxLength: 6 });

/** One key a frame, since of two on the same frame only the last can be hit. */
const distinct = (list: [number, number[]][]) => {
  const byFrame = new Map(list.map(([time, rotations]) => [Math.round(time * 30), key(time, rotations)]));
  return [...byFrame.values()];
};

describe('any keys', () => {
  it('are hit exactly by the correction, however close they are', () => {
    fc.assert(
      fc.property(keys, (list) => {
        const keyPoses = distinct(list);
        const motion = swingingMotion(180);
        correctToKeys(motion, keysOnFrames(keyPoses, 30, 180), 1);
        for (const one of keyPoses) expect(consistencyError(motion, [one])).toBeLessThan(1e-6);
      }),
      { numRuns: 30 },
    );
  });

  it('are hit by a whole dance that keeps above the floor', async () => {
    await fc.assert(
      fc.asyncProperty(
        keys,
        fc.integer(),
        fc.double({ min: 0, max: 1, noNaN: true }),
        async (list, seed, variation) => {
          const keyPoses = distinct(list);
          const options = { keyStrength: 1, variation, seed, cleanFeet: true };
          const motion = await generateMotion(danceRequest(6, { keyPoses, options }), slerpNetwork);
          expect(motion.frames).toBe(180);
          expect(consistencyError(motion, keyPoses)).toBeLessThan(1e-6);
          const { ground } = bodyTrack(motion);
          for (let t = 0; t < motion.frames; t++)
            expect(motion.root[t * 3 + 1] - ground[t]).toBeGreaterThanOrEqual(-1e-6);
        },
      ),
      { numRuns: 6 },
    );
  }, 60_000);
});

describe('any plan of windows', () => {
  it('covers every frame, in order, with the overlap that blending needs', () => {
    fc.assert(
      fc.property(
        fc.integer({ min: 0, max: 500 }),
        fc.integer({ min: 1, max: 20_000 }),
        fc.array(fc.integer({ min: 0, max: 20_000 }), { maxLength: 200 }),
        (from, frames, unsorted) => {
          const plan = planWindows(
            from,
            from + frames,
            unsorted.sort((a, b) => a - b),
          );
          const { musicFrames, overlapFrames } = spec.model;
          expect(plan[0].start).toBe(from);
          expect(plan.at(-1)!.end).toBe(from + frames);
          plan.forEach(({ start, end }, i) => {
            expect(end - start).toBeGreaterThan(0);
            expect(end - start).toBeLessThanOrEqual(musicFrames);
            if (i > 0) expect(start).toBe(plan[i - 1].end - overlapFrames);
          });
        },
      ),
    );
  });
});
