/** What the overlays of the stage show, worked out from the state: no graphics here. */
import { lowerBound } from '../../app/snapping';
import type { PoseDraft } from '../../app/pose-state';
import type { Dance } from '../../app/state';
import { danceThrough, neighbouringKeys, slerpThrough, type Stretch } from '../../core/joint-path';
import { poseToQuaternions } from '../../core/rotation';
import { spec } from '../../core/spec';
import type { BeatGrid, KeyPose, Motion } from '../../core/types';
import { standingRoot } from '../../scene/body-points';
import type { Ghost } from '../../scene/onion';
import { PATH_CAPACITY, PATH_MARK, type PathPicture } from '../../scene/path-picture';

/** How far a path reaches to either side of the playhead, seconds. */
export const REACH = 2;
/** Small dots are this many frames apart. */
const TICK = 3;

/** When the edited pose is danced: at its key pose's time, or for a new one at the playhead. */
export function draftTime(draft: PoseDraft, keyPoses: readonly KeyPose[], time: number): number {
  return keyPoses.find((key) => key.id === draft.keyId)?.time ?? time;
}

/** The key poses as they will be once the edited pose is kept. */
export function keysWithDraft(draft: PoseDraft, keyPoses: readonly KeyPose[], time: number): KeyPose[] {
  const edited = keyPoses.find((key) => key.id === draft.keyId);
  const others = keyPoses.filter((key) => key !== edited);
  return [...others, { ...edited, id: 'draft', time: edited?.time ?? time, rotations: draft.rotations }];
}

/**
 * The neighbours of a time as ghosts. In the editor both stand where the edited pose stands; in the dance each is where it is danced.
 * @param motion the dance they are placed on; null: the centre of the stage
 * @param upToDate the dance was made through these poses, so that its height (a jump) is theirs too
 */
export function ghostsAround(
  keyPoses: readonly KeyPose[],
  time: number,
  motion: Motion | null,
  upToDate: boolean,
): Ghost[] {
  const { before, after } = neighbouringKeys(keyPoses, time, spec.fps);
  const ghosts: Ghost[] = [];
  const add = (key: KeyPose | null, kind: Ghost['kind']) => {
    if (!key) return;
    const root = standingRoot(poseToQuaternions(key.rotations));
    if (motion) {
      const frame = Math.min(Math.round(key.time * motion.fps), motion.frames - 1);
      root[0] = motion.root[frame * 3];
      root[2] = motion.root[frame * 3 + 2];
      if (upToDate) root[1] = motion.root[frame * 3 + 1];
    }
    ghosts.push({ rotations: key.rotations, root, kind });
  };
  add(before, 'before');
  add(after, 'after');
  return ghosts;
}

/**
 * What the dance will do around the edited pose, moved to where that pose is shown: the dance corrected to the pose, or SLERP between the
 * key poses where there is no dance through them yet. Null where neither says anything.
 */
export function draftStretch(
  draft: PoseDraft,
  keyPoses: readonly KeyPose[],
  dance: Dance | null,
  time: number,
): Stretch | null {
  const at = draftTime(draft, keyPoses, time);
  const keys = keysWithDraft(draft, keyPoses, time);
  const motion = dance && dance.kind !== 'preview' && dance.motion.frames > 1 ? dance.motion : null;
  const stretch = motion
    ? danceThrough(motion, keys, at, REACH)
    : slerpThrough(keys, spec.fps, standingRoot, at, REACH);
  if (!stretch) return null;
  const { root, frames, fps } = stretch.motion;
  const middle = Math.min(Math.max(0, Math.round(at * fps) - stretch.first), frames - 1);
  const shown = standingRoot(poseToQuaternions(draft.rotations));
  const shift = shown.map((value, k) => value - root[middle * 3 + k]);
  for (let i = 0; i < root.length; i++) root[i] += shift[i % 3];
  return stretch;
}

/** An empty picture with room for any path. */
export function createPicture(): PathPicture {
  return { points: new Float32Array(PATH_CAPACITY * 3), marks: new Uint8Array(PATH_CAPACITY), count: 0, now: 0 };
}

/**
 * Fills a picture with frames [from, to) of a path.
 * @param first frame of the song that is point 0 of `points`
 * @param time the playhead, seconds
 */
export function fillPicture(
  picture: PathPicture,
  points: Float32Array,
  first: number,
  from: number,
  to: number,
  time: number,
  fps: number,
): void {
  picture.count = Math.max(0, Math.min(to - from, PATH_CAPACITY));
  picture.now = time * fps - from;
  const offset = (from - first) * 3;
  for (let i = 0; i < picture.count * 3; i++) picture.points[i] = points[offset + i];
}

/** Marks the frames [from, from + count) of a picture: dots, beats, key poses. */
export function markPicture(
  picture: PathPicture,
  from: number,
  fps: number,
  grid: BeatGrid | null,
  keyPoses: readonly KeyPose[],
): void {
  const { marks, count } = picture;
  for (let i = 0; i < count; i++) marks[i] = (from + i) % TICK === 0 ? PATH_MARK.tick : PATH_MARK.none;
  const beats = grid?.beats ?? [];
  for (let i = lowerBound(beats, (from - 0.5) / fps); i < beats.length; i++) {
    const frame = Math.round(beats[i] * fps) - from;
    if (frame >= count) break;
    if (frame >= 0) marks[frame] = PATH_MARK.beat;
  }
  for (const key of keyPoses) {
    const frame = Math.round(key.time * fps) - from;
    if (frame >= 0 && frame < count) marks[frame] = PATH_MARK.key;
  }
}
