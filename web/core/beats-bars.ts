/** Bar lines: which beats are downbeats, and whether a bar has three beats or four. */

/** What is known about each beat, one number per beat. */
export interface BeatEvidence {
  /** Strength of the onset there. */
  onset: ArrayLike<number>;
  /** Strength of the onset in the bass. */
  low: ArrayLike<number>;
  /** Change of harmony from the beat before to the beat after, 0..1. */
  change: ArrayLike<number>;
}

/** Relative weights of bass, harmony and accent. */
const WEIGHTS = { onset: 0.5, low: 1, change: 1.5 };
/** Triple time must explain this much more: most dance music is in four. */
const TRIPLE_MARGIN = 1.15;

/**
 * @returns beats per bar and the index of the first downbeat (0 <= first < beatsPerBar)
 */
export function findBars(evidence: BeatEvidence): { beatsPerBar: 3 | 4; first: number } {
  const score = combine(evidence);
  const four = bestPhase(score, 4);
  const three = bestPhase(score, 3);
  return three.contrast > TRIPLE_MARGIN * four.contrast
    ? { beatsPerBar: 3, first: three.first }
    : { beatsPerBar: 4, first: four.first };
}

function combine(evidence: BeatEvidence): Float64Array {
  const out = new Float64Array(evidence.onset.length);
  for (const key of ['onset', 'low', 'change'] as const) {
    const values = Float64Array.from(evidence[key]);
    const mean = values.reduce((a, b) => a + b, 0) / Math.max(1, values.length);
    const spread = Math.sqrt(values.reduce((a, b) => a + (b - mean) ** 2, 0) / Math.max(1, values.length)) + 1e-9;
    for (let i = 0; i < out.length; i++) out[i] += (WEIGHTS[key] * (values[i] - mean)) / spread;
  }
  return out;
}

/** Phase whose beats stand out most: its mean less the mean of the others. */
function bestPhase(score: Float64Array, length: number): { first: number; contrast: number } {
  let best = { first: 0, contrast: -Infinity };
  for (let first = 0; first < length; first++) {
    let on = 0;
    let off = 0;
    let count = 0;
    for (let i = 0; i < score.length; i++) {
      if (i % length === first) {
        on += score[i];
        count++;
      } else off += score[i];
    }
    const contrast = on / Math.max(1, count) - off / Math.max(1, score.length - count);
    if (contrast > best.contrast) best = { first, contrast };
  }
  return best;
}
