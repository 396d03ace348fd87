import { describe, expect, it } from 'vitest';
import { keysOnFrames } from '../../web/core/correction';
import { FIRST_TAKE, fillerPoses, headingCurve, KEY_DISTANCE } from '../../web/core/filler';
import { headingOf } from '../../web/core/localframe';
import { angleBetween } from '../../web/core/rotation';
import { key, poseWith, steadyGrid, stepClip } from './dance';

const grid = steadyGrid(20);
const turned = (angle: number) => poseWith({ pelvis: [0, angle, 0] });
const keys = keysOnFrames([key(4.3, turned(0)), key(5.3, turned(0)), key(12.3, turned(2))], 30, 600);
const request = { clip: stepClip(), grid, keys, from: 0, to: 600, variation: 0.5, seed: 3 };

describe('filler poses', () => {
  it('stand on beats, keep away from keys and leave short gaps alone', () => {
    const fillers = fillerPoses({ ...request, variation: 0 }, headingCurve(keys));
    const beats = new Set(grid.beats.map((beat) => Math.round(beat * 30)));
    expect(fillers.length).toBeGreaterThan(25);
    for (const { frame } of fillers) {
      expect(beats.has(frame)).toBe(true);
      for (const other of keys) expect(Math.abs(frame - other.frame)).toBeGreaterThanOrEqual(KEY_DISTANCE * 30);
      expect(frame > 4.3 * 30 && frame < 5.3 * 30).toBe(false);
    }
  });

  it('take another way through a short gap with each seed when variation is full', () => {
    const inGap = (seed: number) =>
      fillerPoses({ ...request, variation: 1, seed }, headingCurve(keys)).filter(
        ({ frame }) => frame > 4.3 * 30 && frame < 5.3 * 30,
      );
    const ways = Array.from({ length: 8 }, (_, seed) => inGap(seed));
    for (const way of ways) {
      expect(way).toHaveLength(1);
      for (const other of keys) expect(Math.abs(way[0].frame - other.frame)).toBeGreaterThanOrEqual(KEY_DISTANCE * 30);
      for (const v of [0, 4, 40]) expect(Math.hypot(...way[0].quaternions.subarray(v, v + 4))).toBeCloseTo(1, 5);
    }
    expect(inGap(3)).toEqual(ways[3]);
    const different = new Set(ways.map((way) => Array.from(way[0].quaternions, (v) => v.toFixed(3)).join()));
    expect(different.size).toBe(8);
  });

  it('leave short gaps to the network in the first take unless more variation is asked for', () => {
    const inGap = (variation: number, seed: number) =>
      fillerPoses({ ...request, variation, seed }, headingCurve(keys)).filter(
        ({ frame }) => frame > 4.3 * 30 && frame < 5.3 * 30,
      ).length;
    expect(inGap(FIRST_TAKE.variation, FIRST_TAKE.seed)).toBe(0);
    expect(inGap(1, FIRST_TAKE.seed)).toBe(1);
    const others = Array.from({ length: 40 }, (_, i) => inGap(FIRST_TAKE.variation, i + 2));
    // Seven of ten are expected; 40 draws leave 16..39 far below one in a million.
    const varied = others.reduce((sum, count) => sum + count, 0);
    expect(varied).toBeGreaterThan(15);
    expect(varied).toBeLessThan(40);
    expect(inGap(0, 5)).toBe(0);
  });

  it('are the same for the same seed and others for another', () => {
    const once = fillerPoses(request, headingCurve(keys));
    expect(fillerPoses(request, headingCurve(keys))).toEqual(once);
    expect(fillerPoses({ ...request, seed: 4 }, headingCurve(keys))).not.toEqual(once);
  });

  it('follow the clip in its own order without variation', () => {
    const plain = (seed: number) => fillerPoses({ ...request, keys: [], variation: 0, seed }, () => 0);
    expect(plain(1)).toEqual(plain(2));
    const fillers = plain(1);
    // The clip is four beats long, so the fifth filler repeats the first.
    expect(Array.from(fillers[4].quaternions)).toEqual(Array.from(fillers[0].quaternions, (v) => expect.closeTo(v, 5)));
  });

  it('borrow bars from other clips as variation grows, so that a long gap has many ways', () => {
    const twist = (angle: number, id: string) => {
      const clip = stepClip();
      const poses = clip.poses.map((pose) => pose.map((v, i) => (i % 3 === 1 && i > 2 ? v + angle : v)));
      return { ...clip, id, poses };
    };
    const others = [twist(0.2, 'a'), twist(-0.2, 'b'), twist(0.4, 'c')];
    /** Mean angle between the ways of eight seeds, radians. */
    const apart = (list: typeof others) => {
      const ways = Array.from({ length: 8 }, (_, seed) =>
        fillerPoses({ ...request, others: list, variation: 1, seed }, () => 0)
          .filter(({ frame }) => frame > 5.3 * 30 && frame < 12.3 * 30)
          .map(({ quaternions }) => quaternions),
      );
      const angles = ways.flatMap((way, i) =>
        ways.slice(0, i).flatMap((other) =>
          way.map((pose, k) => {
            let sum = 0;
            for (let j = 4; j < pose.length; j += 4) {
              sum += angleBetween(pose.subarray(j, j + 4), other[k].subarray(j, j + 4));
            }
            return sum / (pose.length / 4 - 1);
          }),
        ),
      );
      return angles.reduce((sum, angle) => sum + angle, 0) / angles.length;
    };
    expect(apart(others)).toBeGreaterThan(1.5 * apart([]));
    const plain = { ...request, variation: 0 };
    expect(fillerPoses({ ...plain, others }, () => 0)).toEqual(fillerPoses(plain, () => 0));
  });

  it('of a part of the song are those of the whole', () => {
    const whole = fillerPoses({ ...request, keys: [] }, () => 0);
    const part = fillerPoses({ ...request, keys: [], from: 200, to: 400 }, () => 0);
    expect(part).toEqual(whole.filter(({ frame }) => frame >= 199 + KEY_DISTANCE * 30 && frame < 400));
  });

  it('face where the keys face', () => {
    const heading = headingCurve(keys);
    expect(heading(129)).toBeCloseTo(0, 6);
    expect(heading(369)).toBeCloseTo(2, 6);
    expect(heading(600)).toBeCloseTo(2, 6);
    const last = fillerPoses(request, heading).at(-1)!;
    expect(headingOf(last.quaternions)).toBeCloseTo(2, 1);
  });
});
