/** What the key pose model hears: the music around a beat, from the features that the song's analysis kept (DanceFormer, section 4.1). */
import { deltas, MFCC_COUNT, TIMBRE_SIZE } from './mfcc';
import { spec } from './spec';
import type { BeatGrid, Features } from './types';

const { featureNames, beatExtraNames, beatWindowSeconds, onsetPeakFrames } = spec.danceformer;

/** Columns of a song's sound that are evened out per song: MFCC, both differences, energy. */
const TIMBRE_COLUMNS = 3 * MFCC_COUNT + 1;
const CHROMA_COLUMNS = 12;
const ONSET = spec.features.names.indexOf('onset');
/** Numbers per frame: the evened-out columns, chroma, onset; their names are `danceformer.featureNames` in spec.json. */
export const FRAME_FEATURE_SIZE = featureNames.length;
/** Numbers per beat: those of the frames around it, then `danceformer.beatExtraNames`. */
export const BEAT_MUSIC_SIZE = FRAME_FEATURE_SIZE + beatExtraNames.length;
/** Decibels below a song's loudest frame at which it counts as silent. */
const SILENT_BELOW = 60;
/** Normalised numbers are held inside this, so that one odd frame cannot outweigh a song. */
const CLIP = 4;
/** Beat length that counts as 0 in `log_period`, seconds. */
const USUAL_PERIOD = 0.5;

/**
 * Features per frame: MFCC with first and second differences and energy, each column evened out over the song (mean 0, deviation 1
 * over the frames that sound, silent frames 0, at most 4), then chroma and onset as the dance model has them.
 * @returns frames x 53, row-major
 * @throws Error when the features came without MFCC
 */
export function frameFeatures({ frames, data, names, timbre }: Features): Float32Array {
  if (timbre?.length !== frames * TIMBRE_SIZE) {
    throw new Error('This song was analysed by an older Posebeat: drop it again.');
  }
  const out = new Float32Array(frames * FRAME_FEATURE_SIZE);
  const mfcc = new Float64Array(frames * MFCC_COUNT);
  const energy = new Float64Array(frames);
  for (let f = 0; f < frames; f++) {
    for (let k = 0; k < MFCC_COUNT; k++) mfcc[f * MFCC_COUNT + k] = timbre[f * TIMBRE_SIZE + k];
    energy[f] = timbre[f * TIMBRE_SIZE + MFCC_COUNT];
  }
  const loudest = energy.reduce((most, level) => Math.max(most, level), -Infinity);
  const sounding: number[] = [];
  energy.forEach((level, f) => level > loudest - SILENT_BELOW && sounding.push(f));
  const slope = deltas(mfcc, MFCC_COUNT);
  const parts = [mfcc, slope, deltas(slope, MFCC_COUNT)];
  const put = (values: Float64Array, width: number, from: number, column: number): void => {
    const { mean, spread } = statistics(values, width, from, sounding);
    for (const f of sounding) {
      const value = (values[f * width + from] - mean) / spread;
      out[f * FRAME_FEATURE_SIZE + column] = Math.min(CLIP, Math.max(-CLIP, value));
    }
  };
  parts.forEach((part, p) => {
    for (let k = 0; k < MFCC_COUNT; k++) put(part, MFCC_COUNT, k, p * MFCC_COUNT + k);
  });
  put(energy, 1, 0, TIMBRE_COLUMNS - 1);
  for (let f = 0; f < frames; f++) {
    const from = f * names.length;
    const to = f * FRAME_FEATURE_SIZE + TIMBRE_COLUMNS;
    out.set(data.subarray(from, from + CHROMA_COLUMNS), to);
    out[to + CHROMA_COLUMNS] = data[from + ONSET];
  }
  return out;
}

/** Mean and standard deviation of a column over some frames. */
function statistics(values: Float64Array, width: number, from: number, frames: readonly number[]) {
  let sum = 0;
  for (const f of frames) sum += values[f * width + from];
  const mean = sum / Math.max(1, frames.length);
  let squares = 0;
  for (const f of frames) squares += (values[f * width + from] - mean) ** 2;
  return { mean, spread: Math.max(1e-6, Math.sqrt(squares / Math.max(1, frames.length))) };
}

/**
 * The music around one moment: the mean of the frames in a window, weighted by a Hamming window centred on the very moment.
 * @param rows frames x width, row-major
 * @param fps frames per second
 * @param time seconds
 * @param out gets `width` numbers at its start; zeros where no frame is near
 */
export function aroundBeat(rows: Float32Array, width: number, fps: number, time: number, out: Float32Array): void {
  const frames = rows.length / width;
  const first = Math.max(0, Math.ceil((time - beatWindowSeconds / 2) * fps));
  const last = Math.min(frames - 1, Math.floor((time + beatWindowSeconds / 2) * fps));
  const sums = new Float64Array(width);
  let total = 0;
  for (let f = first; f <= last; f++) {
    const weight = 0.54 + 0.46 * Math.cos((2 * Math.PI * (f / fps - time)) / beatWindowSeconds);
    total += weight;
    for (let c = 0; c < width; c++) sums[c] += weight * rows[f * width + c];
  }
  for (let c = 0; c < width; c++) out[c] = total > 0 ? sums[c] / total : 0;
}

/**
 * The music of every beat: what is heard around it, its loudest onset, its place in the bar (sine and cosine of a turn per bar; 0, 0
 * without bars) and its length, log2 of its share in half a second.
 * @param features of the whole song
 * @returns beats x 57, row-major
 * @throws Error when the features came without MFCC
 */
export function beatMusic(features: Features, grid: BeatGrid): Float32Array {
  const rows = frameFeatures(features);
  const { fps, frames } = features;
  const { beats, beatsPerBar } = grid;
  const downbeats = new Set(grid.downbeats);
  const firstDownbeat = beats.findIndex((time) => downbeats.has(time));
  const out = new Float32Array(beats.length * BEAT_MUSIC_SIZE);
  let bar = firstDownbeat;
  beats.forEach((time, k) => {
    const row = out.subarray(k * BEAT_MUSIC_SIZE, (k + 1) * BEAT_MUSIC_SIZE);
    aroundBeat(rows, FRAME_FEATURE_SIZE, fps, time, row);
    const middle = Math.round(time * fps);
    let peak = 0;
    for (let f = Math.max(0, middle - onsetPeakFrames); f <= Math.min(frames - 1, middle + onsetPeakFrames); f++)
      peak = Math.max(peak, rows[f * FRAME_FEATURE_SIZE + FRAME_FEATURE_SIZE - 1]);
    if (downbeats.has(time)) bar = k;
    const turn = (2 * Math.PI * (k - bar)) / beatsPerBar;
    const from = Math.max(0, Math.min(k, beats.length - 2));
    const period = beats.length > 1 ? beats[from + 1] - beats[from] : USUAL_PERIOD;
    const place = bar < 0 ? [0, 0] : [Math.sin(turn), Math.cos(turn)];
    row.set([peak, ...place, Math.log2(period / USUAL_PERIOD)], FRAME_FEATURE_SIZE);
  });
  return out;
}
