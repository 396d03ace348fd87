import { describe, expect, it } from 'vitest';
import {
  aroundBeat,
  BEAT_MUSIC_SIZE,
  beatMusic,
  FRAME_FEATURE_SIZE,
  frameFeatures,
} from '../../web/core/beat-features';
import { analyse } from '../../web/core/features';
import { deltas, MFCC_COUNT, TIMBRE_SIZE } from '../../web/core/mfcc';
import { spec } from '../../web/core/spec';
import type { Features } from '../../web/core/types';
import { band } from './sounds';

const RATE = 22050;

/** Four struck tones with harmonics in a second, rising. */
function struck(): Float32Array {
  return Float32Array.from({ length: RATE }, (_, i) => {
    const t = i / RATE;
    const fundamental = 220 + 110 * Math.floor(t * 4);
    let sum = 0;
    for (const h of [1, 2, 3, 7]) sum += Math.sin(2 * Math.PI * h * fundamental * t) / h;
    return 0.3 * sum * Math.exp(-8 * (((t * 4) % 1) / 4));
  });
}

/**
 * librosa 0.11.0 of the same sound: stft (2048, hop 735, symmetric Hann, padded with zeros), melspectrogram (128 bands),
 * 10 log10(max(3e-5, .)), feature.mfcc(S = that, n_mfcc = 13); the last number is the mean band power in decibels.
 */
const LIBROSA: Record<number, number[]> = {
  0: [-226.553, 193.509, 14.989, 27.291, 15.865, -0.797, -17.35, -7.697, 13.346, 19.594, 2.773, -13.165, -9.247, 7.943],
  8: [
    -247.107, 208.139, 20.923, 15.948, -12.685, -44.272, 1.291, 25.783, -6.293, -32.941, -12.048, 7.075, -12.305, 9.898,
  ],
  20: [
    -455.551, 41.664, -4.67, -13.183, -23.761, -18.975, 5.594, -9.784, -32.978, -10.821, -2.986, -24.811, -17.268, 0.08,
  ],
};
/** librosa.feature.delta(width = 9, mode = 'nearest') of coefficients 0..3 of frame 8, and that of the deltas. */
const LIBROSA_DELTA = [-2.8381, -3.5863, -3.1539, -3.1519];
const LIBROSA_DELTA2 = [-0.5882, -0.8737, 0.0729, -0.0714];

describe('MFCC', () => {
  const { features } = analyse(struck(), RATE);
  const timbre = features.timbre!;
  const mfcc = Float64Array.from({ length: features.frames * MFCC_COUNT }, (_, i) => {
    return timbre[Math.floor(i / MFCC_COUNT) * TIMBRE_SIZE + (i % MFCC_COUNT)];
  });

  it('are librosa’s', () => {
    expect(timbre.length).toBe(30 * TIMBRE_SIZE);
    for (const [frame, wanted] of Object.entries(LIBROSA)) {
      const row = timbre.subarray(Number(frame) * TIMBRE_SIZE, (Number(frame) + 1) * TIMBRE_SIZE);
      wanted.forEach((value, k) => expect(Math.abs(row[k] - value)).toBeLessThan(0.01));
    }
  });

  it('have librosa’s first and second differences', () => {
    const first = deltas(mfcc, MFCC_COUNT);
    const second = deltas(first, MFCC_COUNT);
    LIBROSA_DELTA.forEach((value, k) => expect(first[8 * MFCC_COUNT + k]).toBeCloseTo(value, 2));
    LIBROSA_DELTA2.forEach((value, k) => expect(second[8 * MFCC_COUNT + k]).toBeCloseTo(value, 2));
  });
});

describe('frameFeatures', () => {
  it('evens out every column over the sounding frames and keeps chroma and onset', () => {
    const { pcm } = band(120, 4, 4, RATE, 2);
    const { features } = analyse(pcm, RATE);
    const rows = frameFeatures(features);
    const names = spec.danceformer.featureNames;
    expect(rows).toHaveLength(features.frames * FRAME_FEATURE_SIZE);
    const sounding = Array.from({ length: features.frames }, (_, f) => f).filter(
      (f) => rows[f * FRAME_FEATURE_SIZE + names.indexOf('energy')] !== 0,
    );
    // Two seconds of silence come first.
    expect(sounding[0]).toBeGreaterThan(56);
    for (const name of ['mfcc_0', 'mfcc_5', 'mfcc_delta_1', 'mfcc_delta2_12', 'energy']) {
      const column = sounding.map((f) => rows[f * FRAME_FEATURE_SIZE + names.indexOf(name)]);
      const mean = column.reduce((a, b) => a + b, 0) / column.length;
      const variance = column.reduce((a, b) => a + (b - mean) ** 2, 0) / column.length;
      expect(Math.abs(mean)).toBeLessThan(0.05);
      expect(Math.sqrt(variance)).toBeGreaterThan(0.85);
      expect(Math.sqrt(variance)).toBeLessThan(1.001);
      expect(Math.max(...column.map(Math.abs))).toBeLessThanOrEqual(4);
    }
    for (const [name, source] of [
      ['chroma_a', 9],
      ['onset', 14],
    ] as const) {
      for (const f of [0, 70, 200])
        expect(rows[f * FRAME_FEATURE_SIZE + names.indexOf(name)]).toBe(features.data[f * 15 + source]);
    }
  });

  it('does not depend on how loud the song is', () => {
    const { pcm } = band(120, 4, 4);
    const loud = frameFeatures(analyse(pcm, RATE).features);
    const soft = frameFeatures(
      analyse(
        pcm.map((v) => v / 2),
        RATE,
      ).features,
    );
    // Bands that only the louder one lifts over the floor differ: little, and nowhere much.
    const difference = loud.reduce((sum, value, i) => sum + Math.abs(value - soft[i]), 0) / loud.length;
    expect(difference).toBeLessThan(0.1);
  });

  it('is silent in silence, and refuses features without MFCC', () => {
    const { features } = analyse(new Float32Array(RATE), RATE);
    expect(frameFeatures(features).every((v) => v === 0)).toBe(true);
    const old: Features = { fps: 30, names: spec.features.names, frames: 2, data: new Float32Array(30) };
    expect(() => frameFeatures(old)).toThrow(/drop it again/);
  });
});

describe('aroundBeat', () => {
  it('weighs frames by a Hamming window of one second about the beat', () => {
    // A ramp has its own value at the middle; a spike its weight's share.
    const ramp = Float32Array.from({ length: 300 }, (_, f) => f / 30);
    const out = new Float32Array(1);
    aroundBeat(ramp, 1, 30, 4, out);
    expect(out[0]).toBeCloseTo(4, 6);
    const spike = new Float32Array(300);
    spike[120] = 1;
    aroundBeat(spike, 1, 30, 4, out);
    // 31 frames; the cosine sums to -1 over them, as over a full turn it would to 0 but for one end.
    expect(out[0]).toBeCloseTo(1 / (31 * 0.54 - 0.46), 6);
    aroundBeat(spike, 1, 30, 3.5, out);
    expect(out[0]).toBeCloseTo(0.08 / (31 * 0.54 - 0.46), 6);
    aroundBeat(spike, 1, 30, 3.49, out);
    expect(out[0]).toBe(0);
  });

  it('takes what there is at the ends', () => {
    const flat = new Float32Array(30).fill(2);
    const out = new Float32Array(1);
    for (const time of [0, 0.97]) {
      aroundBeat(flat, 1, 30, time, out);
      expect(out[0]).toBeCloseTo(2, 6);
    }
    aroundBeat(flat, 1, 30, 9, out);
    expect(out[0]).toBe(0);
  });
});

describe('beatMusic', () => {
  const { pcm } = band(120, 4, 4);
  const { features } = analyse(pcm, RATE);
  const beats = Array.from({ length: 12 }, (_, i) => 0.5 * i);
  const grid = { tempo: 120, beatsPerBar: 4 as const, beats, downbeats: [0.5, 2.5, 4.5] };
  const rows = beatMusic(features, grid);
  const extra = (beat: number, index: number) => rows[beat * BEAT_MUSIC_SIZE + FRAME_FEATURE_SIZE + index];

  it('begins with what is heard around the beat', () => {
    expect(rows).toHaveLength(12 * BEAT_MUSIC_SIZE);
    const around = new Float32Array(FRAME_FEATURE_SIZE);
    aroundBeat(frameFeatures(features), FRAME_FEATURE_SIZE, 30, beats[3], around);
    expect(rows.slice(3 * BEAT_MUSIC_SIZE, 3 * BEAT_MUSIC_SIZE + FRAME_FEATURE_SIZE)).toEqual(around);
  });

  it('tells the loudest onset near the beat', () => {
    const middle = Math.round(beats[4] * 30);
    const near = [-2, -1, 0, 1, 2].map((d) => features.data[(middle + d) * 15 + 14]);
    expect(extra(4, 0)).toBe(Math.max(...near));
    expect(Math.max(...near)).toBeGreaterThan(features.data[(middle - 3) * 15 + 14]);
  });

  it('tells the place in the bar, counted back before the first bar line, and the length of the beat', () => {
    // Beat 0 is the fourth of its bar, beat 1 begins one, beat 2 is the second.
    for (const [beat, sine, cosine] of [
      [0, -1, 0],
      [1, 0, 1],
      [2, 1, 0],
      [3, 0, -1],
      [5, 0, 1],
    ]) {
      expect(extra(beat, 1)).toBeCloseTo(sine, 6);
      expect(extra(beat, 2)).toBeCloseTo(cosine, 6);
    }
    expect(extra(2, 3)).toBeCloseTo(0, 6);
    const slow = beatMusic(features, { ...grid, beats: [0, 1, 1.5], downbeats: [] });
    const at = (beat: number, index: number) => slow[beat * BEAT_MUSIC_SIZE + FRAME_FEATURE_SIZE + index];
    expect([at(0, 3), at(1, 3), at(2, 3)]).toEqual([1, 0, 0]);
    expect([at(1, 1), at(1, 2)]).toEqual([0, 0]);
  });
});
