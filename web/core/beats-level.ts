/** Which of the pulses of a song, each twice as fast as the next, is the beat that people tap. */

/** Onset strengths that the choice is made from, all at the same frame rate. */
export interface LevelEvidence {
  rate: number;
  all: ArrayLike<number>;
  low: ArrayLike<number>;
  middle: ArrayLike<number>;
}

/** Weights of the reasons, each about -1 to 1, set by hand on the rendered scores; `faster` settles what is undecided. */
const WEIGHTS = { faster: 0.42, prior: 2.5, backbeat: 7, slowBackbeat: 7, subdivision: 0.6, evenness: 0.5 };
/** A pulse is most likely near this tempo, beats per minute, and less by the square of the distance in octaves. */
const PRIOR_CENTRE = 118;
const PRIOR_OCTAVES = 0.8;
/** Nobody taps a faster pulse than this, beats per minute: people take every second one. */
const FASTEST_TAPPED = 190;
/** Onsets count as on the pulse within this time, seconds. */
const REACH = 0.035;

/** @returns log of the log-normal tempo prior (Ellis 2007, eq. 7) for a beat period in seconds */
export function logTempoPrior(period: number): number {
  return -0.5 * (Math.log2(60 / period / PRIOR_CENTRE) / PRIOR_OCTAVES) ** 2;
}

/** Mean over the pulses of the strongest value near each. */
function strength(values: ArrayLike<number>, pulses: readonly number[], rate: number): number {
  const reach = Math.round(REACH * rate);
  let sum = 0;
  for (const pulse of pulses) {
    const centre = Math.round(pulse * rate);
    let best = 0;
    for (let i = centre - reach; i <= centre + reach; i++) best = Math.max(best, values[i] ?? 0);
    sum += best;
  }
  return sum / Math.max(1, pulses.length);
}

function logRatio(a: number, b: number): number {
  return Math.log((a + 1e-3) / (b + 1e-3));
}

/** Every second one. */
function parity(pulses: readonly number[], phase: number): number[] {
  return pulses.filter((_, i) => i % 2 === phase);
}

/** Points between neighbours, at a share of the way. */
function between(pulses: readonly number[], share: number): number[] {
  return pulses.slice(1).map((p, i) => pulses[i] + share * (p - pulses[i]));
}

/**
 * Backbeat: bass on one pulse, snare (middle range) on the next. Positive where the two alternate, as on real beats; negative where
 * every second pulse is weaker in both, as between beats.
 */
export function backbeat(evidence: LevelEvidence, pulses: readonly number[]): number {
  const { rate, low, middle } = evidence;
  const [even, odd] = [parity(pulses, 0), parity(pulses, 1)];
  const bass = logRatio(strength(low, odd, rate), strength(low, even, rate));
  const snare = logRatio(strength(middle, odd, rate), strength(middle, even, rate));
  const crossed = (-bass * snare) / (Math.abs(bass) + Math.abs(snare) + 0.1);
  return Math.max(-0.3, Math.min(0.3, crossed));
}

/**
 * How much more likely the beat is this pulse than the one half as fast (0 = undecided).
 * @param pulses times of the faster pulse, seconds, ascending
 */
export function preferFaster(evidence: LevelEvidence, pulses: readonly number[]): number {
  if (pulses.length < 4) return 0;
  const { rate, all } = evidence;
  const period = (pulses[pulses.length - 1] - pulses[0]) / (pulses.length - 1);
  if (60 / period > FASTEST_TAPPED) return -1;
  const onPulse = strength(all, pulses, rate);
  const even = strength(all, parity(pulses, 0), rate);
  const odd = strength(all, parity(pulses, 1), rate);
  const parts = [1 / 2, 1 / 3, 2 / 3].map((share) => strength(all, between(pulses, share), rate));
  const subdivision = Math.max(-2.5, Math.min(0, logRatio(Math.max(...parts), onPulse)));
  const alternation = backbeat(evidence, pulses);
  const slower = Math.max(backbeat(evidence, parity(pulses, 0)), backbeat(evidence, parity(pulses, 1)), 0);
  return (
    WEIGHTS.faster +
    WEIGHTS.prior * (logTempoPrior(period) - logTempoPrior(2 * period)) +
    WEIGHTS.backbeat * alternation -
    WEIGHTS.slowBackbeat * slower +
    WEIGHTS.subdivision * (subdivision + 1.5) +
    WEIGHTS.evenness * (0.4 - Math.abs(logRatio(odd, even)))
  );
}
