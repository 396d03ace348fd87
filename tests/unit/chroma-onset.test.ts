import { describe, expect, it } from 'vitest';
import { cens, chroma, chromaBank, hannWeights } from '../../web/core/chroma';
import { FLUX_BANDS, FluxMeter, hertzToMel, melBank, melToHertz } from '../../web/core/onset';
import { percentile } from '../../web/core/interpolate';
import { SpectrumAnalyser } from '../../web/core/spectrum';

const RATE = 5512.5;

describe('chroma', () => {
  it.each([
    [261.63, 0],
    [110, 9],
    [82.41, 4],
    [987.77, 11],
    [1864.66, 10],
  ])('hears %f Hz as pitch class %i', (hertz, pitchClass) => {
    const frame = Float32Array.from({ length: 2048 }, (_, i) => Math.sin((2 * Math.PI * hertz * i) / RATE));
    const out = chroma(chromaBank(RATE, 2048), new SpectrumAnalyser(2048).analyse(frame), new Float32Array(12));
    expect(out.indexOf(Math.max(...out))).toBe(pitchClass);
    expect(out[pitchClass] ** 2 / out.reduce((sum, v) => sum + v * v, 0)).toBeGreaterThan(0.8);
  });

  it("scales each bin's weights to length 1", () => {
    const bank = chromaBank(RATE, 2048);
    const squares = new Float64Array(1024);
    bank.bins.forEach((bin, i) => (squares[bin] += bank.weights[i] ** 2));
    // Meyda leaves out a few bins half-way between semitones.
    const used = [...squares].filter((sum) => sum > 0);
    expect(used.length).toBeGreaterThan(900);
    for (const sum of used) expect(sum).toBeCloseTo(1, 4);
  });
});

describe('cens', () => {
  it('normalises, quantises and scales one frame as worked out by hand', () => {
    // Shares 0.5, 0.25, 0.15, 0.07, 0.03: levels 1, 0.75, 0.5, 0.25, 0.
    const raw = new Float32Array(12);
    raw.set([50, 25, 15, 7, 3]);
    const length = Math.hypot(1, 0.75, 0.5, 0.25);
    const wanted = [1, 0.75, 0.5, 0.25, 0, 0, 0, 0, 0, 0, 0, 0].map((v) => v / length);
    cens(raw, 1).forEach((v, i) => expect(v).toBeCloseTo(wanted[i], 6));
  });

  it('smooths over time with a Hann window and leaves silence at zero', () => {
    const raw = new Float32Array(12 * 7);
    raw[3 * 12] = 1;
    raw[4 * 12 + 5] = 1;
    const out = cens(raw, 3);
    expect([...hannWeights(3)].map((w) => Number(w.toFixed(6)))).toEqual([0.25, 0.5, 0.25]);
    expect(out[3 * 12]).toBeCloseTo(0.5 / Math.hypot(0.5, 0.25), 6);
    expect(out[3 * 12 + 5]).toBeCloseTo(0.25 / Math.hypot(0.5, 0.25), 6);
    expect([...out.subarray(0, 24)].every((v) => v === 0)).toBe(true);
  });
});

describe('mel filters', () => {
  it('follow the Slaney scale', () => {
    expect(hertzToMel(1000)).toBeCloseTo(15, 10);
    expect(hertzToMel(6400)).toBeCloseTo(42, 10);
    expect(melToHertz(3)).toBeCloseTo(200, 10);
    for (const hertz of [50, 440, 1000, 5000, 11025]) expect(melToHertz(hertzToMel(hertz))).toBeCloseTo(hertz, 6);
  });

  it('have equal area in hertz where bins are fine', () => {
    const bank = melBank(20, 22050, 8192);
    for (const row of bank.rows) expect((row.reduce((a, b) => a + b, 0) * 22050) / 8192).toBeCloseTo(1, 1);
  });
});

describe('FluxMeter', () => {
  it('measures a rise of 20 dB as 20, a fall as 0', () => {
    const meter = new FluxMeter(22050, 2048, 1);
    const out = new Float32Array(FLUX_BANDS);
    const flat = (level: number): Float32Array => new Float32Array(1024).fill(level);
    meter.next(flat(10), out);
    meter.next(flat(100), out);
    for (const band of [0, 1, 2, 3]) expect(out[band]).toBeCloseTo(20, 3);
    meter.next(flat(1), out);
    for (const band of [0, 1, 2, 3]) expect(out[band]).toBe(0);
  });

  it('takes percentiles between neighbours', () => {
    expect(percentile([3, 1, 2, 5, 4], 0.5)).toBe(3);
    expect(percentile([0, 10], 0.98)).toBeCloseTo(9.8, 10);
    expect(percentile([5, 1, 4], 0)).toBe(1);
    expect(percentile([5, 1, 4], 1)).toBe(5);
    expect(percentile([], 0.5)).toBe(0);
  });
});
