/** Key poses on beats, suggested by the first stage of DanceFormer: which beats get one, and the steps that make them. */
import { beatCount } from './beat-count';
import { frameOf, type TimeRange } from './document';
import { FORBIDDEN, stepMoving, turning, VISIBLE_DISTANCE, type Neighbour, type Neighbours } from './suggest-moving';
import { poseOfRow, poseDistance, rowOfPose, ROW_SIZE } from './suggest-pose';
import { StepContext, temperatureOf, type Fixed, type StepInputs } from './suggest-step';
import { seededRandom } from './random';
import { spec } from './spec';
import type { BeatGrid, Features, KeyPose } from './types';

/** How many beats get a pose: every one, two in a bar, or the first of each bar. */
export type Density = 'beat' | 'half' | 'bar';

/** What to suggest. */
export interface SuggestRequest {
  /** Of the whole song. */
  features: Features;
  grid: BeatGrid;
  /** All key poses of the project; suggested ones in the stretch give way unless they are locked. */
  keyPoses: readonly KeyPose[];
  density: Density;
  /** Where, seconds. */
  range: TimeRange;
  /** Only between the visitor's first and last own key pose in that stretch. */
  gaps?: boolean;
  /** 0..1. */
  variation: number;
  /** Whole number; the same seed gives the same poses. */
  seed: number;
  /** One of spec.danceformer.styles, or none for any. */
  style?: string;
}

/** A suggested pose: on a beat, inside the joints' limits. */
export interface SuggestedPose {
  /** Seconds. */
  time: number;
  /** 24 x 3 axis-angle, radians. */
  rotations: number[];
}

/**
 * One step of the network for as many samples as there are rows of noise. Each sample has a code for every part of the body that has
 * codes of its own: the place in the noise that it was chosen by.
 */
export type StepRunner = (inputs: StepInputs) => Promise<{ poses: Float32Array; codes: Float32Array }>;

/** How to follow the work. */
export interface SuggestHooks {
  /** A pose is found; the share of the beats that is done. */
  onPose?: (pose: SuggestedPose, fraction: number) => void;
  signal?: AbortSignal;
}

/** Beats of the past that matter to a step: where a stretch begins in the middle of a song, the steps begin that much earlier. */
const { pastPoses, codes } = spec.danceformer.suggest;
/** A suggestion nearer than this to a key pose that stays, beats, would only fight it. */
const ELBOW_ROOM = 0.6;
/** Samples of one call when alternates are looked for, and calls at most. */
const ALTERNATE_BATCH = 8;
const ALTERNATE_CALLS = 3;
/** Alternates of a beat. */
export const ALTERNATES = 4;

/** Key poses that a suggestion never touches: those of the visitor, the locked ones, and all outside the stretch. */
export function keysThatStay(keyPoses: readonly KeyPose[], range: TimeRange): KeyPose[] {
  return keyPoses.filter((key) => !key.suggested || key.locked || key.time < range.start || key.time > range.end);
}

/**
 * The beats that get a pose.
 * @returns indices into grid.beats, ascending
 */
export function suggestionBeats(
  request: Pick<SuggestRequest, 'grid' | 'keyPoses' | 'density' | 'range' | 'gaps'>,
): number[] {
  const { grid, keyPoses, density } = request;
  const range = suggestionRange(request);
  if (!range) return [];
  const count = beatCount(grid);
  const stay = keysThatStay(keyPoses, range).map((key) => count.of(key.time));
  const step = density === 'beat' ? 1 : density === 'half' ? Math.ceil(grid.beatsPerBar / 2) : grid.beatsPerBar;
  const room = Math.max(ELBOW_ROOM, 0.45 * step);
  const places = placesInBar(grid);
  return grid.beats.flatMap((time, k) => {
    if (time < range.start || time > range.end) return [];
    const place = places[k];
    const wanted = density === 'beat' || place === 0 || (density === 'half' && place % step === 0);
    return wanted && stay.every((beat) => Math.abs(beat - k) >= room) ? [k] : [];
  });
}

/** Where poses are suggested; between own key poses null where there are not two. */
export function suggestionRange({ keyPoses, range, gaps }: Pick<SuggestRequest, 'keyPoses' | 'range' | 'gaps'>) {
  return gaps ? betweenOwn(keyPoses, range) : range;
}

/** From the first to the last own key pose of a stretch; null where there are not two. */
function betweenOwn(keyPoses: readonly KeyPose[], { start, end }: TimeRange): TimeRange | null {
  const own = keyPoses.filter((key) => (!key.suggested || key.locked) && key.time >= start && key.time <= end);
  return own.length < 2 ? null : { start: own[0].time, end: own[own.length - 1].time };
}

/** Place of each beat in its bar, from 0; before the first bar line it is counted back from there, without bars from the first beat. */
function placesInBar({ beats, downbeats, beatsPerBar }: BeatGrid): number[] {
  const lines = new Set(downbeats);
  let bar = Math.max(
    0,
    beats.findIndex((time) => lines.has(time)),
  );
  return beats.map((time, k) => {
    if (lines.has(time)) bar = k;
    return (((k - bar) % beatsPerBar) + beatsPerBar) % beatsPerBar;
  });
}

/** Key poses on the beats that they are nearest to; of two on one beat the nearer. */
function fixedBeats(keys: readonly KeyPose[], grid: BeatGrid): Map<number, Fixed> {
  const count = beatCount(grid);
  const fixed = new Map<number, Fixed>();
  for (const key of keys) {
    const at = count.of(key.time);
    const beat = Math.round(at);
    const before = fixed.get(beat);
    if (!before || Math.abs(at - beat) < Math.abs(before.at - beat))
      fixed.set(beat, { at, row: rowOfPose(key.rotations) });
  }
  return fixed;
}

/** Noise of a beat: the same for the same seed, whatever else is suggested. */
function gumbel(seed: number, beat: number, draw: number): Float32Array {
  const random = seededRandom(Math.imul(seed, 1_000_003) ^ Math.imul(beat + 1, 8191) ^ Math.imul(draw, 131_071));
  // Strictly inside (0, 1): the logarithms must be finite.
  return Float32Array.from({ length: codes }, () => -Math.log(-Math.log((random() + 2 ** -34) / (1 + 2 ** -32))));
}

/**
 * Suggests poses beat by beat; each is made from the ones before it, leads to the key pose after it, and fits the music. One that nearly
 * repeats the key pose before it, or the own one right after it, gives way to another: the dance would stand still there.
 * @returns the suggestions in order of time
 * @throws Error when the song has no beats or there is no beat to suggest for; the signal's reason when it is aborted
 */
export async function suggestPoses(
  request: SuggestRequest,
  run: StepRunner,
  { onPose, signal }: SuggestHooks = {},
): Promise<SuggestedPose[]> {
  const { grid, seed, style } = request;
  const wanted = suggestionBeats(request);
  if (wanted.length === 0) throw new Error(whyNone(request));
  const emit = new Set(wanted);
  const first = Math.max(0, wanted[0] - pastPoses);
  const last = wanted[wanted.length - 1];
  const stay = keysThatStay(request.keyPoses, suggestionRange(request) ?? request.range);
  const context = new StepContext(request.features, grid, fixedBeats(stay, grid), style);
  const temperature = temperatureOf(request.variation);
  const found: SuggestedPose[] = [];
  for (let beat = first; beat <= last; beat++) {
    signal?.throwIfAborted();
    const time = grid.beats[beat];
    // Beats that get no key pose lead from one to the next and may rest.
    const neighbours = emit.has(beat)
      ? neighboursOf(time, [...stay, ...found], grid.beats[wanted[found.length + 1]])
      : null;
    const row = await stepMoving(context, beat, temperature, gumbel(seed, beat, 0), time, neighbours, run);
    const rotations = context.take(beat, row);
    if (!emit.has(beat)) continue;
    const pose = { time, rotations };
    found.push(pose);
    onPose?.(pose, (beat + 1 - first) / (last + 1 - first));
  }
  return found;
}

/** The key poses before a time, and the one after it unless a suggestion comes between at `next`, seconds. */
function neighboursOf(time: number, keys: readonly Neighbour[], next = Infinity): Neighbours {
  const recent = keys.filter((key) => key.time < time).sort((a, b) => a.time - b.time);
  const [after] = keys.filter((key) => key.time > time && key.time < next).sort((a, b) => a.time - b.time);
  return { around: [recent.at(-1), after].filter((key) => key !== undefined), recent };
}

/**
 * Other poses for a beat that has a suggestion, made from the same past, each visibly different from it and from each other as far as
 * the network knows some; the most different first.
 * @param key the key pose at hand
 */
export async function alternatePoses(
  request: Omit<SuggestRequest, 'density' | 'range' | 'gaps'>,
  key: KeyPose,
  run: StepRunner,
  signal?: AbortSignal,
): Promise<number[][]> {
  const { grid, seed, keyPoses, style } = request;
  if (grid.beats.length === 0) return [];
  const target = Math.min(grid.beats.length - 1, Math.max(0, Math.round(beatCount(grid).of(key.time))));
  const others = keyPoses.filter((each) => each.id !== key.id && frameOf(each.time) !== frameOf(key.time));
  const context = new StepContext(request.features, grid, fixedBeats(others, grid), style);
  for (let beat = Math.max(0, target - pastPoses); beat < target; beat++) {
    signal?.throwIfAborted();
    const { poses } = await run(context.inputs(beat, temperatureOf(request.variation), [gumbel(seed, beat, 0)]));
    context.take(beat, poses.subarray(0, ROW_SIZE));
  }
  const around = neighboursOf(key.time, others);
  const taken = new Set<number>();
  const seen = new Set<string>();
  const candidates: number[][] = [];
  let chosen: number[][] = [];
  for (let call = 0; call < ALTERNATE_CALLS; call++) {
    signal?.throwIfAborted();
    const noise = Array.from({ length: ALTERNATE_BATCH }, (_, i) => {
      const numbers = gumbel(seed, target, 1 + call * ALTERNATE_BATCH + i);
      for (const code of taken) numbers[code] = FORBIDDEN;
      return numbers;
    });
    const { poses, codes: used } = await run(context.inputs(target, temperatureOf(0.5), noise));
    const parts = used.length / noise.length;
    for (let i = 0; i < noise.length; i++) {
      const own = used.subarray(i * parts, (i + 1) * parts);
      const name = own.join();
      if (seen.has(name)) continue;
      seen.add(name);
      for (const code of own) taken.add(code);
      candidates.push(poseOfRow(poses.subarray(i * ROW_SIZE, (i + 1) * ROW_SIZE)));
    }
    // Those that the body cannot turn to in time come only where there are no others.
    const [within, beyond] = [true, false].map((wanted) =>
      candidates.filter((pose) => turning(pose, key.time, around) >= 1 === wanted),
    );
    chosen = farthest(key.rotations, within);
    if (chosen.length < ALTERNATES)
      chosen.push(...farthest(key.rotations, beyond).slice(0, ALTERNATES - chosen.length));
    const least =
      within.length < ALTERNATES ? 0 : poseDistance(chosen[ALTERNATES - 1], nearestOf(chosen, key.rotations));
    if (least >= VISIBLE_DISTANCE) break;
  }
  return chosen;
}

/** Of the poses chosen before the last one, and the one at hand, the nearest to the last. */
function nearestOf(chosen: readonly number[][], own: readonly number[]): readonly number[] {
  const last = chosen[chosen.length - 1];
  return [own, ...chosen.slice(0, -1)].reduce((a, b) => (poseDistance(last, b) < poseDistance(last, a) ? b : a));
}

/** Greedy: each time the candidate whose nearest neighbour among those taken is farthest (Gonzalez 1985). */
function farthest(own: readonly number[], candidates: readonly number[][]): number[][] {
  const distance = candidates.map((pose) => poseDistance(pose, own));
  const chosen: number[][] = [];
  while (chosen.length < Math.min(ALTERNATES, candidates.length)) {
    const best = distance.indexOf(Math.max(...distance));
    chosen.push(candidates[best]);
    candidates.forEach((pose, i) => (distance[i] = Math.min(distance[i], poseDistance(pose, candidates[best]))));
    distance[best] = -1;
  }
  return chosen;
}

/** Why there is no beat to suggest a pose for, in words for people. */
function whyNone({ grid, gaps, keyPoses, range }: SuggestRequest): string {
  if (grid.beats.length === 0) return 'No beats were found in this song: tap the tempo (T) or type it, then try again.';
  if (gaps && !betweenOwn(keyPoses, range))
    return 'There is no gap to fill: place at least two key poses of your own first.';
  return 'There is no free beat here: choose another stretch, or more poses a bar.';
}
