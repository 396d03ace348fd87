/** What a visitor changes on the curves of a dance. Edits lie on top of the generated curves, so a dance that is made anew keeps them. */
import { alignKnots, CHANNELS, copyCurves, INNER_KNOTS, rotationChannel, SHAPE_SIZE } from './curves';
import type { CurveAnchor, CurveDance, CurveTrack, Shape } from './curves';
import type { Warp } from './grid-ripple';
import { axisAngleToQuaternion, multiply } from './rotation';
import { JOINTS } from './skeleton';
import type { KeyPose } from './types';

/** Three numbers: a turn (radians, about the joint's own axes) or a way (metres). */
export type Triple = [number, number, number];

/** A change to the curve of one joint between two neighbouring key knots. */
export interface CurveEdit {
  /** The key knots; a beat is counted from the song's first one, so that the edit goes along when the beats are re-timed. */
  from: CurveAnchor;
  to: CurveAnchor;
  /** Name of a joint, or `root` for the way of the pelvis. */
  track: string;
  /** What is added to each inner knot: a turn after its own, or a way. */
  knots?: [Triple, Triple];
  /** -1..1, in place of the generated ones. */
  tension?: number;
  continuity?: number;
  bias?: number;
}

/** Of a dance that nobody has changed anything of. */
export const NO_EDITS: readonly CurveEdit[] = [];
/** The handles of a curve's shape, in the order of {@link Shape}. */
export const SHAPE_NAMES = ['tension', 'continuity', 'bias'] as const satisfies readonly (keyof Shape)[];
/** Beats this close are the same one: fillers lie on whole frames, beats between them. */
const SAME_BEAT = 0.02;

/** The name of a track in documents and files. */
export function trackName(track: CurveTrack): string {
  return track === 'root' ? 'root' : JOINTS[track];
}

/** The track of a name; null when there is none. */
export function trackOf(name: string): CurveTrack | null {
  if (name === 'root') return 'root';
  const joint = JOINTS.indexOf(name);
  return joint < 0 ? null : joint;
}

/** First channel of a track and how many it has. */
export function channelsOf(track: CurveTrack): { first: number; count: number } {
  return track === 'root' ? { first: 0, count: 3 } : { first: rotationChannel(track), count: 4 };
}

/** True when two anchors mean the same key knot. */
export function sameAnchor(a: CurveAnchor, b: CurveAnchor): boolean {
  return typeof a === 'number' && typeof b === 'number' ? Math.abs(a - b) < SAME_BEAT : a === b;
}

/** The interval that an edit is for; -1 where the dance has none between these key knots. */
export function intervalOf({ anchors }: CurveDance, { from, to }: Pick<CurveEdit, 'from' | 'to'>): number {
  for (let i = 0; i + 1 < anchors.length; i++) {
    if (sameAnchor(anchors[i], from) && sameAnchor(anchors[i + 1], to)) return i;
  }
  return -1;
}

/** The edit of a track in an interval, if there is one. */
export function findEdit(
  edits: readonly CurveEdit[],
  curves: CurveDance,
  interval: number,
  track: CurveTrack,
): CurveEdit | undefined {
  const [from, to] = [curves.anchors[interval], curves.anchors[interval + 1]];
  const name = trackName(track);
  return edits.find((edit) => edit.track === name && sameAnchor(edit.from, from) && sameAnchor(edit.to, to));
}

/** True when an edit changes nothing. */
export function isBlank({ knots, tension, continuity, bias }: CurveEdit): boolean {
  const still = !knots || knots.every((triple) => triple.every((value) => value === 0));
  return still && tension === undefined && continuity === undefined && bias === undefined;
}

/**
 * A list of edits with one put in the place of the former of its track and interval; a blank one only takes the former away.
 * @returns the same list when nothing changes
 */
export function withEdit(edits: readonly CurveEdit[], edit: CurveEdit): readonly CurveEdit[] {
  const same = (other: CurveEdit) =>
    other.track === edit.track && sameAnchor(other.from, edit.from) && sameAnchor(other.to, edit.to);
  const index = edits.findIndex(same);
  if (index < 0) return isBlank(edit) ? edits : [...edits, edit];
  return isBlank(edit) ? edits.filter((_, i) => i !== index) : edits.map((other, i) => (i === index ? edit : other));
}

/** Curves with the edits on them; edits whose key knots are not there wait until they are. The given curves stay as they are. */
export function applyEdits(curves: CurveDance, edits: readonly CurveEdit[]): CurveDance {
  if (edits.length === 0) return curves;
  const made = copyCurves(curves);
  let turned = false;
  for (const edit of edits) {
    const interval = intervalOf(curves, edit);
    const track = trackOf(edit.track);
    if (interval < 0 || track === null) continue;
    edit.knots?.forEach((change, n) => changeKnot(made, interval, n, track, change));
    turned ||= edit.knots !== undefined && track !== 'root';
    SHAPE_NAMES.forEach((name, which) => {
      const value = edit[name];
      if (value === undefined) return;
      const { first, count } = channelsOf(track);
      const at = (interval * SHAPE_SIZE + which) * CHANNELS + first;
      made.shape.fill(value, at, at + count);
    });
  }
  return turned ? alignKnots(made) : made;
}

function changeKnot(curves: CurveDance, interval: number, n: number, track: CurveTrack, change: Triple): void {
  const { first, count } = channelsOf(track);
  const at = (interval * INNER_KNOTS + n) * CHANNELS + first;
  const knot = curves.inner.subarray(at, at + count);
  if (track === 'root') for (let c = 0; c < 3; c++) knot[c] += change[c];
  else multiply(knot, axisAngleToQuaternion(change), knot);
}

/** Edits whose beats are moved along when other beats take the place of the former. The same list when none moves. */
export function rippleEdits(
  edits: readonly CurveEdit[],
  before: (beat: number) => number,
  warp: Warp,
  after: (time: number) => number,
): readonly CurveEdit[] {
  let changed = false;
  const move = (anchor: CurveAnchor): CurveAnchor => {
    if (typeof anchor === 'string') return anchor;
    const beat = tidyBeat(after(warp(before(anchor))));
    changed ||= beat !== anchor;
    return beat;
  };
  const moved = edits.map((edit) => ({ ...edit, from: move(edit.from), to: move(edit.to) }));
  return changed ? moved : edits;
}

/** A beat as anchors have it: a whole one where it nearly is. */
export function tidyBeat(beat: number): number {
  const whole = Math.round(beat);
  return Math.abs(beat - whole) < SAME_BEAT ? whole + 0 : Math.round(beat * 1e4) / 1e4;
}

/** Edits without those that begin or end at a key pose that is no more: its id may be given again. The same list when all stay. */
export function withoutOrphans(edits: readonly CurveEdit[], keys: readonly KeyPose[]): readonly CurveEdit[] {
  const ids = new Set(keys.map((key) => key.id));
  const known = (anchor: CurveAnchor) => typeof anchor === 'number' || ids.has(anchor);
  const kept = edits.filter(({ from, to }) => known(from) && known(to));
  return kept.length === edits.length ? edits : kept;
}
