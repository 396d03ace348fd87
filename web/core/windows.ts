/**
 * From features and key poses to a whole dance of any length: windows that overlap, each seeded by the dance so far, blended, moved
 * through the exact keys and cleaned of sliding feet. The network itself is handed in, so this runs anywhere.
 */
import { accentBeats } from './accent';
import { beatPhase, type BeatPhase } from './beat-phase';
import { correctToKeys, keysOnFrames, type FrameKey } from './correction';
import { excerpt, heldAround } from './excerpt';
import { createCleaner, finishDance, finishLayer, flattened, SETTLE, type UncorrectedDance } from './finish';
import { headingCurve } from './filler';
import { headingOf } from './localframe';
import { copyFrames, emptyMotion, sliceMotion } from './motion';
import { cutLayer, type RangeLayer } from './range-layer';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { BeatGrid, Features, KeyPose, Motion, SeedClip } from './types';
import { planWindows, type RunWindow } from './window-plan';
import { addWindow, networkKeys, openingSeed, TAIL } from './window-run';

export type { RunWindow, WindowInputs } from './window-plan';

const POSE = JOINT_COUNT * 4;
const { seedFrames } = spec.model;

/** What a dance is made from. */
export interface GenerationRequest {
  features: Features;
  grid: BeatGrid;
  /** ceil(duration x fps) */
  frames: number;
  keyPoses: readonly KeyPose[];
  seedClip: SeedClip;
  /** Clips that fillers are borrowed from as variation grows. */
  otherClips?: readonly SeedClip[];
  /** The spec's seedFrames of dance just before frame 0, in the world, instead of the starting clip: a real dance goes on from there. */
  opening?: Motion;
  options: {
    /** 0 = the network alone, 1 = keys are hit exactly. */
    keyStrength: number;
    /** 0..1 */
    variation: number;
    /** Integer; the same seed gives the same dance. */
    seed: number;
    cleanFeet: boolean;
    /** Poses of the starting clip on beats far from any key (default true); without them the network alone fills the gaps. */
    fillers?: boolean;
  };
  /** The part of the song to dance to; before and after it the figure holds still. All other frames count in the whole song. */
  trim?: { from: number; to: number };
  /** Frames [from, to) are made anew; the rest stays as in the dance so far, which is given in one of its two forms, or in both. */
  range?: { from: number; to: number };
  /** The dance so far as it is shown; without it `previousUncorrected` is finished at the key strength of `options`. */
  previous?: Motion;
  /** The dance so far as `onUncorrected` gave it; without it a range has no uncorrected form to hand out. */
  previousUncorrected?: UncorrectedDance;
}

/** How the caller follows a generation. */
export interface GenerationHooks {
  /** The dance so far (frames [0, motion.frames) are final; null for a range), the share that is done, and the windows run. */
  onPartial?(motion: Motion | null, fraction: number, windows: number): void;
  /**
   * The whole dance before key poses and floor had their say, once, at the end: what `finishDance` (finish.ts) finishes for another key
   * strength without the network.
   */
  onUncorrected?(dance: UncorrectedDance): void;
  /** Checked between windows; the promise then rejects with the signal's reason. */
  signal?: AbortSignal;
}

/**
 * Makes a dance, or a range of one anew.
 * @returns exactly `frames` frames
 * @throws Error when the request makes no sense; the signal's reason when it is aborted
 */
export async function generateMotion(
  request: GenerationRequest,
  runWindow: RunWindow,
  hooks: GenerationHooks = {},
): Promise<Motion> {
  check(request);
  hooks.signal?.throwIfAborted();
  if (request.trim) return generateTrimmed(request, request.trim, runWindow, hooks);
  return request.range
    ? generateRange(request, request.range, runWindow, hooks)
    : generateWhole(request, runWindow, hooks);
}

/** The trimmed part as a song of its own, put back in its place. */
async function generateTrimmed(
  request: GenerationRequest,
  trim: { from: number; to: number },
  runWindow: RunWindow,
  hooks: GenerationHooks,
): Promise<Motion> {
  const { frames, range, previous, previousUncorrected } = request;
  const { from, to } = trim;
  if (previousUncorrected && previousUncorrected.place?.from !== from) {
    throw new Error('The dance so far was made for another part of the song: generate it again.');
  }
  const inside = (frame: number) => Math.min(Math.max(from, frame), to) - from;
  const part: GenerationRequest = {
    ...request,
    ...excerpt(request, from, to),
    trim: undefined,
    range: range && { from: inside(range.from), to: inside(range.to) },
    previous: previous && sliceMotion(previous, from, to),
    previousUncorrected: previousUncorrected && { ...previousUncorrected, place: undefined },
  };
  const motion = await generateMotion(part, runWindow, {
    ...hooks,
    onPartial: (made, fraction, windows) =>
      hooks.onPartial?.(made && heldAround(made, from, from + made.frames), fraction, windows),
    onUncorrected: (made) => hooks.onUncorrected?.({ ...made, place: { from, frames } }),
  });
  return heldAround(motion, from, frames);
}

function check({ frames, features, trim, range, previous, previousUncorrected, opening }: GenerationRequest): void {
  if (!Number.isInteger(frames) || frames < 1) throw new Error('There is no song to dance to: drop a song first.');
  if (features.fps !== spec.fps || features.names.length !== spec.features.names.length) {
    throw new Error('The song was analysed by another version of Posebeat: drop it again.');
  }
  if (opening && opening.frames !== seedFrames) {
    throw new Error(`The opening has ${opening.frames} frames; it needs exactly ${seedFrames}.`);
  }
  if (trim && !(trim.from >= 0 && trim.to <= frames && trim.to - trim.from >= 2)) {
    throw new Error('The part of the song to dance to is empty or outside the song: trim it anew.');
  }
  if (!range) return;
  const given = [
    ...(previous ? [previous.frames] : []),
    ...(previousUncorrected ? [previousUncorrected.place?.frames ?? previousUncorrected.motion.frames] : []),
  ];
  if (!given.length)
    throw new Error('There is no dance yet whose range could be made anew: generate the whole dance first.');
  if (given.some((length) => length !== frames))
    throw new Error('The dance and the song differ in length: generate the whole dance again.');
  if (!(range.from >= 0 && range.to <= frames && range.to - range.from >= 2)) {
    throw new Error('The range to make anew is empty or outside the song: select a longer one.');
  }
}

async function generateWhole(
  request: GenerationRequest,
  runWindow: RunWindow,
  hooks: GenerationHooks,
): Promise<Motion> {
  const { frames, options } = request;
  const keys = keysOnFrames(request.keyPoses, spec.fps, frames);
  const total = frames + TAIL;
  const all = networkKeys(request, keys, 0, total);
  const opening = openingSeed(request, headingCurve(keys)(0));
  // `raw` is the network's own dance with the seed before it, so that every window finds its seed in one place.
  const raw = emptyMotion(seedFrames + total);
  copyFrames(opening, 0, seedFrames, raw, 0);
  const plan = planWindows(
    0,
    total,
    all.map((key) => key.frame),
  );
  const finish = finisher(request, keys);
  for (let i = 0; i < plan.length; i++) {
    await addWindow(plan[i], i > 0 ? plan[i - 1] : undefined, raw, seedFrames, request.features, all, runWindow);
    hooks.signal?.throwIfAborted();
    // A window that would begin after the song's end is not needed.
    const last = i + 1 === plan.length || plan[i + 1].start >= frames;
    const motion = finish(raw, last ? frames : plan[i + 1].start, last);
    if (last) {
      hooks.onUncorrected?.(finish.uncorrected);
      return motion;
    }
    if (motion.frames > 0) hooks.onPartial?.(motion, motion.frames / frames, i + 1);
  }
  throw new Error(`A dance of ${frames} frames with seed ${options.seed} got no windows.`);
}

/** Finishes a dance a stretch at a time. */
interface Finisher {
  (raw: Motion, stable: number, last: boolean): Motion;
  /** The dance so far, not yet moved through its keys. */
  uncorrected: { motion: Motion; stretches: number[] };
}

/**
 * Turns the raw dance into the finished one, a stretch at a time: a finished frame never changes again, so what is shown while the rest
 * is generated is what stays.
 */
function finisher(request: GenerationRequest, keys: FrameKey[]): Finisher {
  const { frames, options } = request;
  const uncorrected: Finisher['uncorrected'] = { motion: emptyMotion(frames), stretches: [] };
  const corrected = emptyMotion(frames);
  const phase = beatPhase(request.grid);
  const cleaner = createCleaner(frames, { cleanFeet: options.cleanFeet, keys: keys.map((key) => key.frame) });
  const finish = (raw: Motion, stable: number, last: boolean): Motion => {
    const into = { uncorrected: uncorrected.motion, corrected };
    correctStretch(raw, into, cleaner.done, last ? frames : stable, keys, phase, options.keyStrength);
    if (!last) uncorrected.stretches.push(stable);
    cleaner.clean(corrected, stable, last);
    return cleaner.result();
  };
  return Object.assign(finish, { uncorrected });
}

/** Copies raw frames that are not finished yet and moves them through the keys; `raw` has the seed before frame 0. */
function correctStretch(
  raw: Motion,
  into: { uncorrected: Motion; corrected: Motion },
  done: number,
  readable: number,
  keys: FrameKey[],
  phase: BeatPhase,
  strength: number,
): void {
  // Keys reach SETTLE frames back and their residual is taken at their own frame, so start from where none is half applied.
  const from = Math.max(0, done - 2 * SETTLE);
  const cut = sliceMotion(raw, from + seedFrames, readable + seedFrames);
  const exact = keys.map((key) => key.frame);
  const part = accentBeats(cut, phase, exact, from);
  const keep = Math.max(0, done - from);
  copyFrames(part, keep, part.frames, into.uncorrected, from + keep);
  const inside = keys
    .filter((key) => key.frame >= from && key.frame < readable)
    .map((key) => ({ ...key, frame: key.frame - from }));
  correctToKeys(part, inside, strength);
  copyFrames(part, keep, part.frames, into.corrected, from + keep);
}

async function generateRange(
  request: GenerationRequest,
  range: { from: number; to: number },
  runWindow: RunWindow,
  hooks: GenerationHooks,
): Promise<Motion> {
  const { frames, options, previous, previousUncorrected } = request;
  if (range.from === 0 && range.to === frames) return generateWhole(request, runWindow, hooks);
  // The network sees the dance before key strength had its say: the same layer then fits every strength.
  const below = previousUncorrected ? flattened(previousUncorrected) : previous!;
  const layer = await generateLayer(request, range, below, runWindow, hooks);
  const uncorrected = previousUncorrected && {
    ...previousUncorrected,
    layers: [...(previousUncorrected.layers ?? []), layer],
  };
  if (uncorrected) hooks.onUncorrected?.(uncorrected);
  const { keyStrength, cleanFeet } = options;
  if (!previous) return finishDance(uncorrected!, request.keyPoses, keyStrength, cleanFeet);
  return finishLayer(previous, layer, keysOnFrames(request.keyPoses, spec.fps, frames), keyStrength, cleanFeet);
}

/** Runs the network over frames [from, to) of the dance below. */
async function generateLayer(
  request: GenerationRequest,
  range: { from: number; to: number },
  below: Motion,
  runWindow: RunWindow,
  hooks: GenerationHooks,
): Promise<RangeLayer> {
  const { from, to } = range;
  const { frames, options } = request;
  const userKeys = keysOnFrames(request.keyPoses, spec.fps, frames).filter(
    (key) => key.frame >= from && key.frame < to,
  );
  const pin: FrameKey[] =
    to < frames ? [{ frame: to, quaternions: below.quaternions.slice(to * POSE, (to + 1) * POSE) }] : [];
  const keys = [...userKeys, ...pin];
  const total = to < frames ? to + 1 : frames + TAIL;
  const startHeading = headingOf(
    below.quaternions.subarray(Math.max(0, from - 1) * POSE, Math.max(0, from - 1) * POSE + 4),
  );
  const opening = openingSeed(request, startHeading);
  const raw = emptyMotion(seedFrames + Math.max(total, frames));
  copyFrames(opening, 0, seedFrames, raw, 0);
  copyFrames(below, 0, frames, raw, seedFrames);
  // Near the song's start the seed would reach before it: what is missing is the opening clip.
  const all = networkKeys(request, keys, from, total, from > 0 ? { frame: from, heading: startHeading } : undefined);
  const plan = planWindows(
    from,
    total,
    all.map((key) => key.frame),
  );
  for (let i = 0; i < plan.length; i++) {
    await addWindow(plan[i], i > 0 ? plan[i - 1] : undefined, raw, seedFrames, request.features, all, runWindow);
    hooks.signal?.throwIfAborted();
    hooks.onPartial?.(null, (plan[i].end - from) / (total - from), i + 1);
  }
  const made = sliceMotion(raw, seedFrames, seedFrames + frames);
  const bent = accentBeats(
    made,
    beatPhase(request.grid),
    userKeys.map((key) => key.frame),
  );
  return cutLayer(bent, below, range, options);
}
