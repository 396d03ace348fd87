/**
 * Sections of a song: where its harmony and liveliness change for long, and which parts come back.
 *
 * A checkerboard kernel that is slid along the diagonal of the bars' self-similarity is high where two stretches are alike inside
 * and unlike each other: J. Foote, "Automatic audio segmentation using a measure of audio novelty", ICME 2000. With dot products as
 * similarity and a kernel without taper, that sum is the squared distance of the two stretches' mean bars, which is what is computed.
 */
import type { BeatGrid, Features } from './types';

/** A stretch of a song; sections with the same label sound alike. */
export interface Section {
  /** Seconds; on a bar line, but for the song's own ends. */
  start: number;
  end: number;
  /** A, B, C... in order of appearance. */
  label: string;
}

/** Most bars on each side of a boundary that are compared; whole phrases, so that chords that come round weigh alike. */
const REACH = 8;
/** Bars of a phrase; no section is shorter. */
const PHRASE = 4;
/** A song shorter than this has no sections worth a name, bars. */
const MIN_SONG = 12;
/** How far apart the mean bars of two neighbouring sections are at least; two unlike bars are at most 1.5 apart. */
const MIN_NOVELTY = 0.25;
/** Sections whose mean bars are nearer than this are the same. */
const SAME = 0.15;
/** Weight of liveliness beside the harmony of length 1. */
const ONSET_WEIGHT = 0.6;

/**
 * Finds the sections of a song.
 *
 * @param features - Of the whole song.
 * @param grid - Its beats; bars are what is compared.
 * @param duration - Seconds.
 * @returns Sections that cover the song, in order; none when no change is clear enough or the song is short.
 */
export function findSections(features: Features, grid: BeatGrid, duration: number): Section[] {
  const bars = grid.downbeats;
  const vectors = barVectors(features, bars, duration);
  if (vectors.length < MIN_SONG) return [];
  const starts = [0, ...boundaries(vectors)];
  if (starts.length < 2) return [];
  const labels = labelled(vectors, starts);
  return starts.map((bar, i) => ({
    start: i === 0 ? 0 : bars[bar],
    end: i + 1 < starts.length ? bars[starts[i + 1]] : duration,
    label: labels[i],
  }));
}

/** Mean chroma (length 1) and mean onset strength of each bar. */
function barVectors(features: Features, bars: readonly number[], duration: number): Float64Array[] {
  const { data, fps, frames, names } = features;
  const onset = names.indexOf('onset');
  const chroma = names.flatMap((name, i) => (name.startsWith('chroma') ? [i] : []));
  const vectors: Float64Array[] = [];
  bars.forEach((start, i) => {
    const from = Math.round(start * fps);
    const to = Math.min(frames, Math.round((bars[i + 1] ?? duration) * fps));
    if (to <= from) return;
    const vector = new Float64Array(chroma.length + 1);
    for (let t = from; t < to; t += 1) {
      chroma.forEach((column, k) => (vector[k] += data[t * names.length + column]));
      if (onset >= 0) vector[chroma.length] += data[t * names.length + onset] / (to - from);
    }
    const length = Math.hypot(...vector.subarray(0, chroma.length));
    for (let k = 0; k < chroma.length; k += 1) vector[k] /= length || 1;
    vectors.push(vector);
  });
  const loudest = Math.max(...vectors.map((vector) => vector[chroma.length]), 1e-6);
  for (const vector of vectors) vector[chroma.length] *= ONSET_WEIGHT / loudest;
  return vectors;
}

/** The mean of bars from one to before another. */
function meanBar(vectors: readonly Float64Array[], from: number, to: number): Float64Array {
  const mean = new Float64Array(vectors[0].length);
  for (let bar = from; bar < to; bar += 1) vectors[bar].forEach((value, k) => (mean[k] += value / (to - from)));
  return mean;
}

const apart = (a: Float64Array, b: Float64Array) => Math.hypot(...a.map((value, k) => value - b[k]));

/** Bars at which a new section begins: clear peaks of novelty, a phrase apart at least. */
function boundaries(vectors: readonly Float64Array[]): number[] {
  const count = vectors.length;
  const novelty = vectors.map((_, bar) => {
    const room = Math.floor(Math.min(REACH, bar, count - bar) / PHRASE) * PHRASE;
    return room > 0 ? apart(meanBar(vectors, bar - room, bar), meanBar(vectors, bar, bar + room)) : 0;
  });
  const found: number[] = [];
  for (let bar = PHRASE; bar <= count - PHRASE; bar += 1) {
    const around = novelty.slice(Math.max(0, bar - PHRASE), bar + PHRASE + 1);
    if (novelty[bar] < MIN_NOVELTY || novelty[bar] < Math.max(...around)) continue;
    if (found.length === 0 || bar - found[found.length - 1] >= PHRASE) found.push(bar);
  }
  return found;
}

/** A letter for each section; a section that sounds like an earlier one has its letter. */
function labelled(vectors: readonly Float64Array[], starts: readonly number[]): string[] {
  const means = starts.map((start, i) => meanBar(vectors, start, starts[i + 1] ?? vectors.length));
  const labels: number[] = [];
  means.forEach((mean, i) => {
    let best = -1;
    let least = SAME;
    for (let j = 0; j < i; j += 1) {
      const distance = apart(mean, means[j]);
      if (distance < least) [best, least] = [j, distance];
    }
    labels.push(best >= 0 ? labels[best] : Math.max(-1, ...labels) + 1);
  });
  return labels.map((label) => (label < 26 ? String.fromCharCode(65 + label) : `A${label - 25}`));
}
