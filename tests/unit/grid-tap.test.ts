import { describe, expect, it } from 'vitest';
import { seededRandom } from '../../web/core/random';
import { evenGrid } from '../../web/core/grid-edit';
import { fitTaps, tapGrid } from '../../web/core/grid-tap';
import type { BeatGrid } from '../../web/core/types';

const every = (period: number, count: number, from = 0) => Array.from({ length: count }, (_, i) => from + i * period);
/** A hand that is late and early by up to `spread` seconds. */
const unsteady = (taps: number[], spread: number, seed = 1) => {
  const random = seededRandom(seed);
  return taps.map((time) => time + (random() * 2 - 1) * spread);
};
/** A song of 60 s that slows down from 126 to 114 beats a minute. */
const drifting = (): BeatGrid => {
  const beats: number[] = [];
  for (let time = 0.2; time < 60; time += 60 / (126 - time / 5)) beats.push(time);
  return { tempo: 120, beatsPerBar: 4, beats, downbeats: beats.filter((_, i) => i % 4 === 1) };
};
const nearest = (list: readonly number[], time: number) => Math.min(...list.map((each) => Math.abs(each - time)));

describe('fitTaps', () => {
  it('finds the period and the phase of even taps', () => {
    const fit = fitTaps(every(0.5, 8, 3.2))!;
    expect(fit.period).toBeCloseTo(0.5, 12);
    expect(fit.phase).toBeCloseTo(3.2, 12);
    expect(fit.used).toHaveLength(8);
  });
  it('needs four taps', () => {
    expect(fitTaps([])).toBeNull();
    expect(fitTaps([1, 1.5, 2])).toBeNull();
  });
  it('averages an unsteady hand out', () => {
    const fit = fitTaps(unsteady(every(0.5, 16), 0.03))!;
    expect(Math.abs(fit.period - 0.5)).toBeLessThan(0.003);
    expect(Math.abs(fit.phase)).toBeLessThan(0.025);
  });
  it('counts over a missed beat, drops a bounced key and a slip', () => {
    const taps = every(0.5, 12);
    const damaged = [...taps.slice(0, 4), taps[4] + 0.2, ...taps.slice(5, 7), taps[6] + 0.04, ...taps.slice(8)];
    const fit = fitTaps(damaged)!;
    expect(fit.period).toBeCloseTo(0.5, 9);
    expect(fit.used).toEqual([0, 0.5, 1, 1.5, 2.5, 3, 4, 4.5, 5, 5.5]);
  });
  it('goes on through the jump of a loop', () => {
    const fit = fitTaps([...every(0.5, 6, 4), ...every(0.5, 6, 4)])!;
    expect(fit.period).toBeCloseTo(0.5, 9);
    expect(fit.used).toHaveLength(12);
  });
  it('knows no tempo outside 20 to 400', () => {
    expect(fitTaps(every(0.1, 8))).toBeNull();
    expect(fitTaps(every(4, 8))).toBeNull();
  });
});

describe('tapGrid', () => {
  it('covers the whole song with even beats where nothing was analysed; a bar begins at the first tap', () => {
    expect(tapGrid(every(0.5, 4, 1.25), null, 4)).toEqual({
      tempo: 120,
      beatsPerBar: 4,
      beats: [0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3.25, 3.75],
      downbeats: [1.25, 3.25],
    });
  });
  it('is nothing with too few taps', () => {
    expect(tapGrid([1, 2], drifting(), 60)).toBeNull();
  });

  it('of a drifting song whose tempo was halved gives its own beats back', () => {
    const song = drifting();
    const halved = { ...song, beats: song.beats.filter((_, i) => i % 2 === 1) };
    const taps = unsteady(song.beats.slice(20, 32), 0.025);
    const tapped = tapGrid(taps, halved, 60)!;
    for (const beat of song.beats) expect(nearest(tapped.beats, beat)).toBeLessThan(0.005);
    expect(Math.abs(tapped.beats.length - song.beats.length)).toBeLessThanOrEqual(1);
    expect(nearest(song.downbeats, tapped.downbeats[0])).toBeLessThan(0.005);
  });
  it('of a song counted twice too fast keeps those beats that were tapped', () => {
    const song = drifting();
    const taps = unsteady(song.beats.filter((_, i) => i % 2 === 0).slice(5, 17), 0.025);
    const tapped = tapGrid(taps, song, 60)!;
    expect(tapped.tempo).toBeCloseTo(60, 0);
    for (const tap of taps) expect(nearest(tapped.beats, tap)).toBeLessThan(0.03);
    for (const beat of tapped.beats) expect(nearest(song.beats, beat)).toBeLessThan(1e-5);
  });
  it('between the analysed beats moves them by half a beat, and follows the drift', () => {
    const song = drifting();
    const between = song.beats.slice(0, -1).map((time, i) => (time + song.beats[i + 1]) / 2);
    const tapped = tapGrid(unsteady(between.slice(30, 42), 0.02), song, 60)!;
    for (const beat of between) expect(nearest(tapped.beats, beat)).toBeLessThan(0.005);
  });
  it('leaves the analysed beats where they are when the hand is merely early', () => {
    const song = drifting();
    const taps = song.beats.slice(8, 20).map((time) => time - 0.035);
    const tapped = tapGrid(taps, song, 60)!;
    expect(song.beats.every((beat) => nearest(tapped.beats, beat) < 1e-5)).toBe(true);
    expect(tapped.downbeats[0]).toBeCloseTo(song.downbeats[0], 5);
  });
  it('moves them when the taps are clearly elsewhere', () => {
    const song = evenGrid(0.5, 0, 4, 60);
    const tapped = tapGrid(every(0.5, 12, 10.1), song, 60)!;
    expect(nearest(tapped.beats, 30.1)).toBeLessThan(1e-3);
  });
  it('is even at the taps’ own tempo when the analysis was about something else', () => {
    const tapped = tapGrid(every(60 / 97, 12, 5), drifting(), 60)!;
    expect(tapped.tempo).toBeCloseTo(97, 6);
    expect(nearest(tapped.downbeats, 5)).toBeLessThan(1e-6);
  });
});
