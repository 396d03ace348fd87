/** A dance shown to another song while its own is not at hand. */
import type { ProjectDocument } from './document';
import { parseDocument } from './document-read';
import { beatPosition, firstBar, timeAtBeat } from './grid-edit';
import { snapTime } from './snap';
import type { KeyPose } from './types';

/** A first key pose later than this is brought forward, seconds, where the project says nothing of its beats. */
const LATEST_START = 4;

/**
 * A project put on another's song: bar for bar where both have beats, else to the nearest half beats. Key poses beyond the song's end
 * go, and so does what only its own song has (ranges, trim, changed curves). Bars before the first key pose are left out but for one.
 *
 * @param other - The project whose song there is; its beats are used.
 */
export function standIn(document: ProjectDocument, other: ProjectDocument): ProjectDocument {
  const { curveEdits, ...rest } = document;
  void curveEdits;
  return parseDocument({
    ...rest,
    song: other.song,
    grid: other.grid,
    trim: null,
    ranges: [],
    keyPoses: moved(document, other),
  }).document;
}

function moved({ keyPoses, grid }: ProjectDocument, other: ProjectDocument): KeyPose[] {
  if (keyPoses.length === 0) return keyPoses;
  const end = other.song?.duration ?? Infinity;
  const inside = (keys: KeyPose[]) => keys.filter(({ time }) => time >= 0 && time <= end);
  if (!grid || !other.grid) {
    const [{ time: first }] = keyPoses;
    const earlier = first > LATEST_START ? first - LATEST_START / 2 : 0;
    const early = inside(keyPoses.map((key) => ({ ...key, time: key.time - earlier })));
    return early.map((key) => ({ ...key, time: snapTime(other.grid, key.time, 'half') }));
  }
  const target = other.grid;
  const places = keyPoses.map(({ time }) => beatPosition(grid, time) - firstBar(grid));
  const left = Math.max(0, Math.floor(places[0] / grid.beatsPerBar) - 1) * grid.beatsPerBar;
  return inside(keyPoses.map((key, i) => ({ ...key, time: timeAtBeat(target, firstBar(target) + places[i] - left) })));
}
