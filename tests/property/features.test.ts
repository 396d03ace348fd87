import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { cens } from '../../web/core/chroma';
import { analyse, FeatureExtractor } from '../../web/core/features';
import { Resampler, resample } from '../../web/core/resample';
import { sniffSound } from '../../web/core/sound-format';
import { band } from '../unit/sounds';

describe('chunks', () => {
  it('do not change what the resampler gives', () => {
    const pcm = Float32Array.from({ length: 3000 }, (_, i) => Math.sin(i * 0.1) + Math.sin(i * i * 0.001));
    fc.assert(
      fc.property(
        fc.constantFrom(8000, 22050, 44100, 48000),
        fc.array(fc.integer({ min: 0, max: 3000 }), { maxLength: 6 }),
        (rate, cuts) => {
          const resampler = new Resampler(rate, 22050);
          const places = [0, ...cuts.sort((a, b) => a - b), pcm.length];
          const parts = places.slice(1).map((to, i) => [...resampler.push(pcm.subarray(places[i], to))]);
          expect([...parts.flat(), ...resampler.flush()]).toEqual([...resample(pcm, rate, 22050)]);
        },
      ),
      { numRuns: 30 },
    );
  });

  it('do not change the analysis', () => {
    const { pcm } = band(130, 4, 3, 44100);
    const whole = analyse(pcm, 44100);
    fc.assert(
      fc.property(fc.array(fc.integer({ min: 1, max: pcm.length - 1 }), { maxLength: 5 }), (cuts) => {
        const extractor = new FeatureExtractor(44100, pcm.length);
        const places = [0, ...cuts.sort((a, b) => a - b), pcm.length];
        places.slice(1).forEach((to, i) => extractor.push(pcm.subarray(places[i], to)));
        expect(extractor.finish()).toEqual(whole);
      }),
      { numRuns: 4 },
    );
  });
});

describe('cens', () => {
  it('gives frames of length 1 or 0 and does not care for loudness', () => {
    const frames = fc.array(fc.double({ min: 0, max: 1, noNaN: true }), { minLength: 36, maxLength: 36 });
    fc.assert(
      fc.property(frames, (values) => {
        const raw = Float32Array.from(values);
        const out = cens(raw, 5);
        for (let f = 0; f < 3; f++) {
          const length = Math.hypot(...out.subarray(12 * f, 12 * f + 12));
          expect(Math.min(length, Math.abs(1 - length))).toBeLessThan(1e-5);
        }
        const louder = cens(
          raw.map((v) => v * 8),
          5,
        );
        out.forEach((v, i) => expect(louder[i]).toBeCloseTo(v, 5));
      }),
    );
  });
});

describe('sniffSound', () => {
  it('never throws, whatever the bytes', () => {
    const starts = fc.constantFrom('', 'RIFF', 'fLaC', 'OggS', 'ID3', '\xff\xfb', '\0\0\0\x18ftyp');
    fc.assert(
      fc.property(starts, fc.uint8Array({ maxLength: 400 }), (start, rest) => {
        const bytes = Uint8Array.from([...[...start].map((c) => c.charCodeAt(0)), ...rest]);
        expect(typeof sniffSound(bytes).isTruncated).toBe('boolean');
      }),
      { numRuns: 300 },
    );
  });
});
