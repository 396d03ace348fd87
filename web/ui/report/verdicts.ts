/** What the report's numbers mean: a value with its unit, and a sentence that says whether it is good. */
import type { DanceReport } from '../../app/report';
import {
  CLOSE_ERROR,
  degreesPerJoint,
  EXACT_ERROR,
  LONGEST_STANDSTILL,
  ON_BEAT_FRAMES,
  REAL_DANCE,
} from '../../app/report-reference';

/** A number for people. */
export interface Verdict {
  value: string;
  unit: string;
  sentence: string;
}

const percent = (share: number) => `${Math.round(share * 100)}%`;

/** A squared distance in few digits. */
export function errorText(error: number): string {
  if (error < EXACT_ERROR) return '0';
  if (error < 0.0005) return '<0.001';
  return error < 0.0995 ? error.toFixed(3) : error < 9.95 ? error.toFixed(2) : error.toFixed(0);
}

/** How close the dance comes to its key poses; null without any. */
export function keyVerdict({ consistencyError: error }: DanceReport): Verdict | null {
  if (Number.isNaN(error)) return null;
  if (error < EXACT_ERROR) {
    return { value: 'Exact', unit: 'E_c 0', sentence: 'The dance passes through every one of your poses.' };
  }
  const degrees = degreesPerJoint(error);
  const off = `Joints are some ${degrees < 0.95 ? degrees.toFixed(1) : degrees.toFixed(0)}° off at your poses`;
  return {
    value: errorText(error),
    unit: 'E_c, 0 is exact',
    sentence: error < CLOSE_ERROR ? `${off}: too little to see.` : `${off}: raise the key strength to come closer.`,
  };
}

/** How many beats the dance hits; null without beats. */
export function beatVerdict({ beatHitRate }: DanceReport): Verdict | null {
  const hits = beatHitRate[ON_BEAT_FRAMES - 1];
  if (hits === undefined || Number.isNaN(hits)) return null;
  const real = REAL_DANCE.beatHitRate[ON_BEAT_FRAMES - 1];
  const sentence =
    hits > 1.15 * real
      ? `More often than real dancers, who hit ${percent(real)}: this dance insists on the beat.`
      : hits >= real
        ? `As good as real dancers, who hit ${percent(real)}.`
        : hits >= 0.9 * real
          ? `Nearly as often as real dancers, who hit ${percent(real)}.`
          : hits >= 0.6 * real
            ? `Less often than real dancers, who hit ${percent(real)}.`
            : `The moves flow across the beats; real dancers hit ${percent(real)}.`;
  return { value: percent(hits), unit: 'of beats, within 0.1 s', sentence };
}

/** How lively or rough the dance is; null for one too short to say. */
export function jerkVerdict({ jerk }: DanceReport): Verdict | null {
  if (Number.isNaN(jerk)) return null;
  const [calm, wild] = REAL_DANCE.jerk;
  const sentence =
    jerk < calm
      ? 'Calmer than people dance: more key poses or more variation bring life.'
      : jerk <= wild
        ? 'As lively as people dance.'
        : 'Rougher than people dance: a lower key strength or fewer key poses smooth it.';
  return { value: jerk.toFixed(0), unit: 'm/s³ of jerk', sentence };
}

/** How long the dancer stands still at most. */
export function freezeVerdict({ longestFreeze }: DanceReport): Verdict {
  const sentence =
    longestFreeze <= LONGEST_STANDSTILL
      ? 'The dancer never stands still for longer than a held pose.'
      : 'The dancer freezes: a key pose there, or another take, brings life.';
  return { value: longestFreeze.toFixed(1), unit: 's', sentence };
}

/** Paper A's own number for smoothness; null for one too short to say. */
export function smoothnessVerdict({ smoothness }: DanceReport): Verdict | null {
  if (!Number.isFinite(smoothness)) return null;
  const value = smoothness < 1e5 ? Math.round(smoothness).toLocaleString('en') : smoothness.toExponential(1);
  return {
    value,
    unit: 'S_cv',
    sentence: `The paper’s smoothness; real dance has about ${REAL_DANCE.smoothness.toLocaleString('en')}. It divides by a mean near zero and jumps about, so trust the jerk.`,
  };
}

/** How firmly the feet stand; null for a dance that never touches the floor. */
export function footVerdict({ footSkate }: DanceReport): Verdict | null {
  if (Number.isNaN(footSkate)) return null;
  const [firm, loose] = REAL_DANCE.footSkate;
  const sentence =
    footSkate < firm
      ? 'Feet stand as firmly as those of calm dancers.'
      : footSkate <= loose
        ? 'Feet turn and glide as dancers’ feet do.'
        : 'Feet slide more than dancers’ feet do.';
  return { value: (footSkate * 100).toFixed(0), unit: 'cm/s on the floor', sentence };
}
