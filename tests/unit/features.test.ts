import { describe, expect, it } from 'vitest';
import { analyse, FeatureExtractor, frameCount, withGrid } from '../../web/core/features';
import { spec } from '../../web/core/spec';
import { band, fMeasure } from './sounds';

const COLUMNS = spec.features.names.length;

describe('analyse', () => {
  it.each([
    [96, 4],
    [128, 4],
    [168, 4],
    [100, 3],
  ] as const)('finds the beats and bars of a band at %i beats a minute in %i', (tempo, beatsPerBar) => {
    const { pcm, beats } = band(tempo, beatsPerBar, Math.round((20 * tempo) / 60 / beatsPerBar));
    const { grid } = analyse(pcm, 22050);
    expect(fMeasure(beats, grid.beats)).toBeGreaterThan(0.95);
    expect(grid.beatsPerBar).toBe(beatsPerBar);
    expect(Math.abs(grid.tempo - tempo)).toBeLessThan(0.02 * tempo);
    expect(
      fMeasure(
        beats.filter((_, i) => i % beatsPerBar === 0),
        grid.downbeats,
      ),
    ).toBeGreaterThan(0.9);
  });

  it('gives ceil(duration x fps) frames of 15 sane numbers', () => {
    const { pcm } = band(120, 4, 3, 16000);
    const { features } = analyse(pcm, 16000);
    expect(features.frames).toBe(Math.ceil((pcm.length / 16000) * 30));
    expect(features.data.length).toBe(features.frames * COLUMNS);
    for (let f = 0; f < features.frames; f++) {
      const row = features.data.subarray(f * COLUMNS, (f + 1) * COLUMNS);
      expect(Math.hypot(...row.subarray(0, 12))).toBeCloseTo(1, 4);
      expect([0, 1]).toContain(row[12]);
      expect(row[13] === 0 || row[12] === 1).toBe(true);
      expect(row[14]).toBeGreaterThanOrEqual(0);
      expect(row[14]).toBeLessThanOrEqual(1);
    }
  });

  it('finds no beats in silence, and none in the silence before a song', () => {
    const silent = analyse(new Float32Array(22050 * 3), 22050);
    expect(silent.grid.beats).toEqual([]);
    expect(silent.features.data.every((v) => v === 0)).toBe(true);
    const { pcm } = band(120, 4, 6, 22050, 3);
    const { grid } = analyse(pcm, 22050);
    expect(grid.beats[0]).toBeGreaterThan(2.9);
    expect(grid.beats[0]).toBeLessThan(3.1);
  });

  it('can do with a tenth of a second', () => {
    const { features, grid } = analyse(new Float32Array(4410).fill(0.5), 44100);
    expect(features.frames).toBe(3);
    expect(features.data.every(Number.isFinite)).toBe(true);
    expect(grid.beats.every(Number.isFinite)).toBe(true);
  });
});

describe('FeatureExtractor', () => {
  it('gives the head of a song before the rest', () => {
    const { pcm } = band(120, 4, 10);
    const extractor = new FeatureExtractor(22050, pcm.length);
    extractor.push(pcm.subarray(0, 22050 * 11));
    const { features, grid } = extractor.head();
    expect(features.frames).toBeGreaterThan(300);
    expect(grid.beats.length).toBeGreaterThan(18);
    extractor.push(pcm.subarray(22050 * 11));
    expect(extractor.finish().features.frames).toBe(frameCount(pcm.length, 22050));
  });
});

describe('withGrid', () => {
  it('writes the beats anew and nothing else', () => {
    const names = spec.features.names;
    const features = { fps: 30, names, frames: 10, data: new Float32Array(10 * COLUMNS).fill(0.25) };
    const out = withGrid(features, { tempo: 300, beatsPerBar: 4, beats: [0.1, 0.2, 5], downbeats: [0.1] });
    for (let f = 0; f < 10; f++) {
      expect(out.data[f * COLUMNS + 12]).toBe(f === 3 || f === 6 ? 1 : 0);
      expect(out.data[f * COLUMNS + 13]).toBe(f === 3 ? 1 : 0);
      expect(out.data[f * COLUMNS + 14]).toBe(0.25);
    }
    expect(features.data.every((v) => v === 0.25)).toBe(true);
  });
});
