import { describe, expect, it } from 'vitest';
import {
  beatConsistency,
  frechetDistance,
  longestFreeze,
  npss,
  poseFrechet,
  positionVariance,
  spectralDistance,
  velocityFrechet,
} from '../../web/core/dance-metrics';
import { motionBeats } from '../../web/core/metrics';
import { emptyMotion, sliceMotion } from '../../web/core/motion';
import { axisAngleToQuaternion, multiply } from '../../web/core/rotation';
import { jointIndex } from '../../web/core/skeleton';
import { eigenSymmetric, squareRoot } from '../../web/core/symmetric';
import type { Motion } from '../../web/core/types';
import { swingingMotion } from './dance';

/** The T-pose with one joint turned about an axis by an angle that is a function of the frame. */
function turning(frames: number, joint: string, axis: number, angle: (t: number) => number): Motion {
  const motion = emptyMotion(frames);
  for (let t = 0; t < frames; t++) {
    const vector = [0, 0, 0];
    vector[axis] = angle(t);
    motion.quaternions.set(Array.from(axisAngleToQuaternion(vector)), (t * 24 + jointIndex(joint)) * 4);
  }
  return motion;
}

describe('symmetric matrices', () => {
  it('come apart and have a root', () => {
    // [[2, 1], [1, 2]]: 3 along (1, 1), 1 along (1, -1).
    const matrix = Float64Array.from([2, 1, 1, 2]);
    expect(Array.from(eigenSymmetric(matrix, 2).values).sort()).toEqual([expect.closeTo(1, 12), expect.closeTo(3, 12)]);
    const [a, b] = [(Math.sqrt(3) + 1) / 2, (Math.sqrt(3) - 1) / 2];
    [a, b, b, a].forEach((value, i) => expect(squareRoot(matrix, 2)[i]).toBeCloseTo(value, 12));
  });
});

describe('Frechet distances', () => {
  const cross = (x: number, y: number, cx: number, cy: number) =>
    Float64Array.from([x, y, x, -y, -x, y, -x, -y].map((value, i) => value + (i % 2 ? cy : cx)));
  it('of known Gaussians', () => {
    // Variances (1, 4) and (4, 1), means 3 and 4 apart: 25 + 5 + 5 - 2 (sqrt(4) + sqrt(4)) = 27.
    expect(frechetDistance(cross(1, 2, 0, 0), cross(2, 1, 3, 4), 2)).toBeCloseTo(27, 9);
    expect(frechetDistance(cross(1, 2, 0, 0), cross(1, 2, 0, 0), 2)).toBeCloseTo(0, 9);
  });
  it('do not see where a body faces, but how it is bent', () => {
    const dance = swingingMotion(40);
    const turned = sliceMotion(dance, 0);
    for (let t = 0; t < 40; t++) {
      const pelvis = dance.quaternions.subarray(t * 96, t * 96 + 4);
      turned.quaternions.set(Array.from(multiply(axisAngleToQuaternion([0, 1.1, 0]), pelvis)), t * 96);
    }
    expect(poseFrechet(dance, turned)).toBeLessThan(1e-4);
    expect(velocityFrechet(dance, turned)).toBeLessThan(1e-2);
    // Arms held at rest and arms held up: all frames equal, so only the means differ: a quarter turn of the left elbow about z moves
    // wrist (0.26, 0.01) and hand (0.35, 0) by sqrt(2) times those lengths.
    const still = turning(8, 'left_elbow', 2, () => 0);
    const bent = turning(8, 'left_elbow', 2, () => Math.PI / 2);
    expect(poseFrechet(still, bent)).toBeCloseTo(2 * (0.26 ** 2 + 0.01 ** 2) + 2 * 0.35 ** 2, 4);
    expect(velocityFrechet(still, bent)).toBeCloseTo(0, 6);
  });
});

describe('NPSS', () => {
  it('tells how far power has moved', () => {
    const tone = (k: number, size = 1) =>
      Array.from({ length: 8 }, (_, t) => size * Math.cos((2 * Math.PI * k * t) / 8));
    const columns = (...list: number[][]) =>
      Float64Array.from({ length: 8 * list.length }, (_, i) => list[i % list.length][Math.floor(i / list.length)]);
    // Power halves in bins 1 and 7 against 2 and 6. Cumulated: 0 .5 .5 .5 .5 .5 .5 1 against 0 0 .5 .5 .5 .5 1 1: differ by .5 twice.
    expect(spectralDistance(columns(tone(1)), columns(tone(2)), 1)).toBeCloseTo(1, 9);
    expect(spectralDistance(columns(tone(1)), columns(tone(1)), 1)).toBeCloseTo(0, 9);
    // A second column that is right with a quarter of the real power: (1 * 4 + 0 * 1) / 5.
    expect(spectralDistance(columns(tone(1), tone(1, 0.5)), columns(tone(2), tone(1)), 2)).toBeCloseTo(0.8, 9);
    expect(() => npss(emptyMotion(4), emptyMotion(5))).toThrow('4 and 5 frames');
  });
  it('follows quaternions past half a turn', () => {
    // A pelvis that turns on by 120 degrees a frame: cutting the sign at w < 0 would fold its power elsewhere.
    const spin = turning(6, 'pelvis', 1, (t) => (t * 2 * Math.PI) / 3);
    const flipped = sliceMotion(spin, 0);
    for (let i = 0; i < 4; i++) flipped.quaternions[2 * 96 + i] *= -1;
    expect(npss(spin, flipped)).toBeCloseTo(0, 9);
  });
});

describe('variance, beats and freezes', () => {
  it('PVar is the variance over dances', () => {
    // A quarter turn of the elbow: half the squared way, (difference / 2)^2 each, of two joints in 24.
    const still = turning(5, 'left_elbow', 2, () => 0);
    const bent = turning(7, 'left_elbow', 2, () => Math.PI / 2);
    const way = 2 * (0.26 ** 2 + 0.01 ** 2) + 2 * 0.35 ** 2;
    expect(positionVariance([still, bent])).toBeCloseTo(way / 4 / 24, 6);
    expect(positionVariance([still])).toBeNaN();
  });
  it('BC falls off with the distance to the nearest motion beat', () => {
    // It turns round at 15.25, 30.25 ...: the slowest step is from frame 15 to 16, its middle 15.5.
    const swing = turning(91, 'left_elbow', 2, (t) => Math.cos((2 * Math.PI * (t - 0.25)) / 30));
    expect(motionBeats(swing).map((beat) => beat * 30)).toEqual(
      [15.5, 30.5, 45.5, 60.5, 75.5].map((b) => expect.closeTo(b, 6)),
    );
    // Beats 0 and 1.5 frames (0.05 s = sigma) away; one outside does not count.
    const score = beatConsistency(swing, [30.5 / 30, 47 / 30, 99]);
    expect(score).toBeCloseTo((1 + Math.exp(-0.5)) / 2, 4);
    expect(beatConsistency(swing, [])).toBeNaN();
    expect(
      beatConsistency(
        turning(30, 'left_elbow', 2, () => 0),
        [0.5],
      ),
    ).toBe(0);
    // With the maxima: half-way between.
    expect(motionBeats(swing, true).length).toBeGreaterThan(9);
  });
  it('a freeze is the longest slow stretch', () => {
    // Moves for 20 frames, holds for 31 (30 steps: 1 s), moves again.
    const held = turning(80, 'left_shoulder', 2, (t) => 0.2 * (t < 20 ? t : t < 50 ? 20 : t - 30));
    expect(longestFreeze(held)).toBeCloseTo(1, 9);
    expect(longestFreeze(held, 99)).toBeCloseTo(79 / 30, 9);
    expect(longestFreeze(swingingMotion(40), 0)).toBe(0);
  });
});
