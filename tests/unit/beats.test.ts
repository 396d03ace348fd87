import { describe, expect, it } from 'vitest';
import { findBars } from '../../web/core/beats-bars';
import { backbeat, preferFaster } from '../../web/core/beats-level';
import { followTempo, normaliseEnvelope, periodAt, trackBeats } from '../../web/core/beats';

const RATE = 60;

/** Unit pulses at the given times. */
function clicks(times: readonly number[], seconds: number, level = 1): Float64Array {
  const out = new Float64Array(Math.round(seconds * RATE));
  for (const time of times) if (Math.round(time * RATE) < out.length) out[Math.round(time * RATE)] = level;
  return out;
}

const every = (period: number, count: number, from = 0): number[] =>
  Array.from({ length: count }, (_, i) => from + i * period);

describe('trackBeats', () => {
  it('finds every click of a train to the frame', () => {
    const times = every(0.5, 40, 0.25);
    const beats = trackBeats(clicks(times, 20.5), RATE, { step: 2, periods: new Float64Array(11).fill(0.5) });
    expect(beats.map((b) => Math.round(b))).toEqual(times.map((t) => Math.round(t * RATE)));
  });

  it('keeps time through missing clicks', () => {
    const times = every(0.5, 40, 0.25);
    const heard = times.filter((_, i) => i % 5 !== 3);
    const beats = trackBeats(clicks(heard, 20.5), RATE, { step: 2, periods: new Float64Array(11).fill(0.5) });
    expect(beats.length).toBe(40);
    beats.forEach((b, i) => expect(Math.abs(b / RATE - times[i])).toBeLessThan(0.05));
  });

  it('places beats between frames', () => {
    const period = 0.51;
    const envelope = new Float64Array(Math.round(RATE * 14.2));
    const times = every(period, 28, 0.3);
    for (const time of times) {
      for (let i = 0; i < envelope.length; i++) envelope[i] += Math.exp(-0.5 * ((i / RATE - time) / 0.02) ** 2);
    }
    const beats = trackBeats(envelope, RATE, { step: 2, periods: new Float64Array(8).fill(period) });
    beats.forEach((b, i) => expect(Math.abs(b / RATE - times[i])).toBeLessThan(0.004));
  });
});

describe('followTempo', () => {
  it('follows a change from 100 to 130 beats a minute', () => {
    const slow = every(0.6, 40);
    const fast = every(60 / 130, 50, 24);
    const envelope = normaliseEnvelope(clicks([...slow, ...fast], 47), RATE);
    const curve = followTempo([envelope], RATE);
    expect(60 / periodAt(curve, 10)).toBeCloseTo(100, -1);
    expect(Math.abs(60 / periodAt(curve, 38) - 130)).toBeLessThan(4);
  });
});

describe('normaliseEnvelope', () => {
  it('lifts a quiet half to the level of the loud one', () => {
    const times = every(0.5, 40);
    const values = clicks(times, 20);
    for (let i = 0; i < values.length / 2; i++) values[i] *= 0.2;
    const out = normaliseEnvelope(values, RATE);
    const peak = (from: number, to: number): number => Math.max(...out.subarray(from * RATE, to * RATE));
    expect(peak(2, 5) / peak(14, 18)).toBeGreaterThan(0.6);
  });
});

describe('choice of the tapped pulse', () => {
  const pulses = every(0.375, 80);
  const at = (phase: number, step: number): number[] => pulses.filter((_, i) => i % step === phase);
  const evidence = (low: Float64Array, middle: Float64Array) => ({
    rate: RATE,
    low,
    middle,
    all: low.map((v, i) => v + middle[i]),
  });

  it('takes bass and snare in turn for beats', () => {
    const e = evidence(clicks(at(0, 2), 31), clicks(at(1, 2), 31));
    expect(backbeat(e, pulses)).toBeGreaterThan(0.2);
    expect(preferFaster(e, pulses)).toBeGreaterThan(0);
  });

  it('takes weak strokes between bass and snare for half beats', () => {
    const low = clicks(at(0, 4), 31);
    const middle = clicks(at(2, 4), 31).map((v, i) => v + 0.2 * clicks(pulses, 31)[i]);
    expect(preferFaster(evidence(low, middle), pulses)).toBeLessThan(0);
  });
});

describe('findBars', () => {
  const evidence = (count: number, length: number, first: number) => {
    const low = Array.from({ length: count }, (_, i) => (i % length === first ? 1 : 0.2));
    return { onset: low.map((v) => 0.5 + v / 2), low, change: low.map((v) => v / 2) };
  };
  it.each([
    [4, 0],
    [4, 3],
    [3, 0],
    [3, 2],
  ] as const)('finds bars of %i that start on beat %i', (length, first) => {
    expect(findBars(evidence(48, length, first))).toEqual({ beatsPerBar: length, first });
  });
});
