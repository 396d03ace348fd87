import { describe, it } from 'vitest';
import { beatMusic, frameFeatures } from '../../web/core/beat-features';
import { MFCC_COUNT, TIMBRE_SIZE } from '../../web/core/mfcc';
import { spec } from '../../web/core/spec';
import type { BeatGrid, Features } from '../../web/core/types';
import { agree, golden } from './golden';

interface BeatMusic {
  tolerance: number;
  mfcc: number[][];
  energy: number[];
  chroma: number[][];
  onset: number[];
  beats: number[];
  downbeats: number[];
  beatsPerBar: BeatGrid['beatsPerBar'];
  frameFeatures: number[][];
  beatMusic: number[][];
}

describe('what the key pose model hears', () => {
  const given = golden<BeatMusic>('beat-music');
  const frames = given.mfcc.length;
  const names = spec.features.names;
  const data = new Float32Array(frames * names.length);
  const timbre = new Float32Array(frames * TIMBRE_SIZE);
  given.mfcc.forEach((mfcc, f) => {
    timbre.set(mfcc, f * TIMBRE_SIZE);
    timbre[f * TIMBRE_SIZE + MFCC_COUNT] = given.energy[f];
    data.set(given.chroma[f], f * names.length);
    data[f * names.length + names.indexOf('onset')] = given.onset[f];
  });
  const features: Features = { fps: spec.fps, names, frames, data, timbre };

  it('is the same in Python frame by frame', () => {
    agree(frameFeatures(features), given.frameFeatures.flat(), given.tolerance);
  });

  it('is the same in Python beat by beat', () => {
    const { beats, downbeats, beatsPerBar } = given;
    agree(beatMusic(features, { tempo: 120, beatsPerBar, beats, downbeats }), given.beatMusic.flat(), given.tolerance);
  });
});
