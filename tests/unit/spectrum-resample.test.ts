import Meyda from 'meyda';
import { describe, expect, it } from 'vitest';
import { Resampler, resample } from '../../web/core/resample';
import { SpectrumAnalyser } from '../../web/core/spectrum';

const tone = (hertz: number, rate: number, length: number): Float32Array =>
  Float32Array.from({ length }, (_, i) => Math.sin((2 * Math.PI * hertz * i) / rate));

const rms = (values: Float32Array): number => Math.sqrt(values.reduce((sum, v) => sum + v * v, 0) / values.length);

describe('resample', () => {
  it.each([44100, 48000, 32000, 16000, 8000, 96000, 11025])('keeps a tone in place from %i Hz', (rate) => {
    const out = resample(tone(440, rate, rate / 2), rate, 22050);
    expect(out.length).toBe(Math.ceil((Math.floor(rate / 2) * 22050) / rate));
    const wanted = tone(440, 22050, out.length);
    for (let i = 200; i < out.length - 200; i++) expect(Math.abs(out[i] - wanted[i])).toBeLessThan(1e-3);
  });

  it('removes what the lower rate cannot hold', () => {
    const out = resample(tone(15000, 44100, 22050), 44100, 22050);
    expect(rms(out.subarray(200, -200))).toBeLessThan(1e-3);
  });

  it('passes a constant and copies at equal rates', () => {
    const ones = new Float32Array(5000).fill(1);
    for (const v of resample(ones, 48000, 22050).subarray(100, 2000)) expect(v).toBeCloseTo(1, 5);
    expect(resample(ones, 22050, 22050)).toEqual(ones);
  });

  it('rejects a rate of zero', () => {
    expect(() => new Resampler(0, 22050)).toThrow(RangeError);
  });
});

describe('SpectrumAnalyser', () => {
  it.each([4, 8, 512, 2048])("gives Meyda's amplitude spectrum for %i samples", (size) => {
    const frame = Float32Array.from({ length: size }, (_, i) => Math.sin(i * i * 0.37) + 0.2 * Math.cos(i));
    const meyda = ((Meyda as unknown as { default?: typeof Meyda }).default ?? Meyda) as typeof Meyda;
    meyda.bufferSize = size;
    const wanted = meyda.extract('amplitudeSpectrum', frame) as unknown as Float32Array;
    const found = new SpectrumAnalyser(size).analyse(frame);
    for (let k = 0; k < size / 2; k++) expect(found[k]).toBeCloseTo(wanted[k], 4);
  });

  it('reads from an offset and rejects odd sizes', () => {
    const sound = tone(1000, 22050, 4096);
    const analyser = new SpectrumAnalyser(2048);
    const shifted = analyser.analyse(sound, 777).slice();
    expect(shifted).toEqual(analyser.analyse(sound.slice(777, 777 + 2048)));
    expect(shifted.indexOf(Math.max(...shifted))).toBe(Math.round((1000 * 2048) / 22050));
    expect(() => new SpectrumAnalyser(1000)).toThrow(RangeError);
  });
});
