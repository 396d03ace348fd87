/** Sounds for the tests of the song analysis, made from formulas. */

/** Adds a decaying tone of 0.12 s. */
export function pluck(pcm: Float32Array, rate: number, at: number, hertz: number, level: number): void {
  const start = Math.round(at * rate);
  const end = Math.min(pcm.length, start + Math.round(0.12 * rate));
  for (let i = start; i < end; i++) {
    const t = (i - start) / rate;
    pcm[i] += level * Math.exp(-t * 30) * Math.sin(2 * Math.PI * hertz * t);
  }
}

/** Adds a short burst of noise from a fixed generator. */
export function noiseHit(pcm: Float32Array, rate: number, at: number, level: number): void {
  let state = 12345;
  const start = Math.round(at * rate);
  for (let i = start; i < Math.min(pcm.length, start + Math.round(0.08 * rate)); i++) {
    state = (Math.imul(state, 1103515245) + 12345) & 0x7fffffff;
    pcm[i] += level * Math.exp((-(i - start) / rate) * 40) * (state / 0x40000000 - 1);
  }
}

/** A bar-wise changing chord. */
export function chord(pcm: Float32Array, rate: number, from: number, to: number, pitches: readonly number[]): void {
  const end = Math.min(pcm.length, Math.round(to * rate));
  for (let i = Math.round(from * rate); i < end; i++) {
    for (const hertz of pitches) pcm[i] += 0.05 * Math.sin((2 * Math.PI * hertz * i) / rate);
  }
}

const CHORDS = [
  [261.6, 329.6, 392],
  [220, 261.6, 329.6],
  [174.6, 220, 261.6],
  [196, 246.9, 293.7],
];

/** Kick and chord change on the one, snare-like noise on the other beats (two and four, or two and three), soft eighths. */
export function band(
  tempo: number,
  beatsPerBar: 3 | 4,
  bars: number,
  rate = 22050,
  start = 0,
): { pcm: Float32Array; beats: number[] } {
  const period = 60 / tempo;
  const pcm = new Float32Array(Math.round((start + bars * beatsPerBar * period + 0.2) * rate));
  const beats = Array.from({ length: bars * beatsPerBar }, (_, i) => start + i * period);
  beats.forEach((time, i) => {
    const beat = i % beatsPerBar;
    const isBass = beatsPerBar === 3 ? beat === 0 : beat % 2 === 0;
    if (isBass) pluck(pcm, rate, time, 70, beat === 0 ? 0.8 : 0.6);
    else noiseHit(pcm, rate, time, 0.3);
    noiseHit(pcm, rate, time + period / 2, 0.05);
    if (beat === 0) chord(pcm, rate, time, time + beatsPerBar * period, CHORDS[(i / beatsPerBar) % 4]);
  });
  return { pcm, beats };
}

/** F-measure of event times within +-70 ms. */
export function fMeasure(reference: readonly number[], found: readonly number[]): number {
  let hits = 0;
  let at = 0;
  for (const time of reference) {
    while (at < found.length && found[at] < time - 0.07) at++;
    if (at < found.length && found[at] <= time + 0.07) {
      hits++;
      at++;
    }
  }
  return (2 * hits) / (reference.length + found.length);
}
