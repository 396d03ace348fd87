/** Shots: how the camera stands in each, and on which frames it changes. Pure: no DOM, no three. */
import type { BeatGrid } from '../core/types';
import { frameTime, type FramePlan, type VideoCamera } from './options';

/** How the camera stands while a shot lasts. */
export interface Shot {
  /** First frame, and the one after the last. */
  from: number;
  to: number;
  /** Direction from the dancer to the camera, radians about Y, 0 = +Z; at the first frame, and how far it turns until the last. */
  azimuth: number;
  turn: number;
  /** Radians above the horizon. */
  elevation: number;
  /** What must be whole in the picture: all of the body, or from the hips up. */
  body: 'whole' | 'upper';
  /** Share of the distance by which the camera comes nearer while the shot lasts. */
  push: number;
  /** Whether the camera goes with the dancer or stays where it is. */
  follows: boolean;
}

type Setup = Omit<Shot, 'from' | 'to'>;

const STILL: Setup = { azimuth: 0, turn: 0, elevation: 0.06, body: 'whole', push: 0, follows: false };
/** As the stage opens: a little to the figure's left and a little above its eyes. */
const FOLLOW: Setup = { ...STILL, azimuth: 0.42, elevation: 0.13, follows: true };

/** The cuts go through these in turn; all on the audience's side, so that left stays left. */
const SEQUENCE: readonly Setup[] = [
  { ...FOLLOW, push: 0.06 },
  { ...FOLLOW, azimuth: -0.7, elevation: 0.04, body: 'upper', turn: 0.12 },
  { ...FOLLOW, azimuth: 0, elevation: -0.07, push: 0.05 },
  { ...FOLLOW, azimuth: 1.15, elevation: 0.1, turn: -0.15 },
  { ...FOLLOW, azimuth: 0.2, elevation: 0.05, body: 'upper', push: 0.06 },
  { ...FOLLOW, azimuth: -0.35, elevation: 0.42, turn: 0.1 },
];

/** No shot is shorter than this, seconds. */
const SHORTEST = 1;
/** Bars are put together until they last this long, seconds. */
const AT_LEAST = 2.2;
/** Seconds between cuts where no bars are known. */
const WITHOUT_BARS = 4;
/** One way round: so many bars, but never quicker or slower than this, seconds. */
const ROUND = { bars: 8, min: 12, max: 24 };

/** Length of a bar, seconds: the middle one of all. */
function barLength(downbeats: readonly number[]): number | null {
  if (downbeats.length < 2) return null;
  const lengths = downbeats.slice(1).map((time, i) => time - downbeats[i]);
  return lengths.sort((a, b) => a - b)[lengths.length >> 1];
}

/** How many bars one shot lasts: 1, 2, 4 or 8. */
export function barsPerShot(downbeats: readonly number[]): number {
  const bar = barLength(downbeats) ?? AT_LEAST;
  return [1, 2, 4].find((bars) => bars * bar >= AT_LEAST) ?? 8;
}

/**
 * Where the camera changes. A stretch of the song has the cuts that the whole song has there.
 * @returns the first frame of each shot with its number in the song; the first is frame 0
 */
export function cutFrames(plan: FramePlan, grid: BeatGrid | null): { frame: number; number: number }[] {
  const downbeats = grid?.downbeats ?? [];
  const bars = barsPerShot(downbeats);
  const times =
    downbeats.length > 1
      ? downbeats.filter((_, i) => i % bars === 0)
      : Array.from({ length: Math.ceil(frameTime(plan, plan.frames) / WITHOUT_BARS) }, (_, i) => i * WITHOUT_BARS);
  const least = SHORTEST * plan.fps;
  const before = times.filter((time) => Math.round((time - plan.start) * plan.fps) < least).length;
  const cuts = [{ frame: 0, number: Math.max(0, before - 1) }];
  times.forEach((time, number) => {
    const frame = Math.round((time - plan.start) * plan.fps);
    if (number >= before && plan.frames - frame >= least) cuts.push({ frame, number });
  });
  return cuts;
}

/** The shots of a video, one after another without a gap. */
export function shotsOf(camera: VideoCamera, plan: FramePlan, grid: BeatGrid | null): Shot[] {
  const all = { from: 0, to: plan.frames };
  // The stage's opening view is this one; another has a path of its own.
  if (camera === 'follow' || camera === 'stage') return [{ ...FOLLOW, ...all }];
  if (camera === 'front') return [{ ...STILL, ...all }];
  if (camera === 'orbit') {
    const bar = barLength(grid?.downbeats ?? []) ?? 2;
    const round = Math.min(Math.max(bar * ROUND.bars, ROUND.min), ROUND.max);
    return [{ ...FOLLOW, azimuth: 0, turn: ((plan.frames / plan.fps) * 2 * Math.PI) / round, ...all }];
  }
  const cuts = cutFrames(plan, grid);
  return cuts.map(({ frame, number }, i) => ({
    ...SEQUENCE[number % SEQUENCE.length],
    from: frame,
    to: cuts[i + 1]?.frame ?? plan.frames,
  }));
}

/** How a beat lights up the floor: at a downbeat, at another beat, and how fast it fades, per second. */
const GLOW = { downbeat: 0.9, beat: 0.45, fade: 4.5 };

/** The floor's glow at a time of the song, 0..1: that of the beats before, as far as it has not faded. */
export function glowAt(time: number, grid: BeatGrid | null): number {
  let glow = 0;
  for (const beat of grid?.beats ?? []) {
    if (beat > time) break;
    if (time - beat > 2) continue;
    const strength = grid!.downbeats.includes(beat) ? GLOW.downbeat : GLOW.beat;
    glow = Math.max(glow, strength * Math.exp(-GLOW.fade * (time - beat)));
  }
  return glow < 0.01 ? 0 : glow;
}
