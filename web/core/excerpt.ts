/** A stretch of a song as a song of its own, so that a dance to it takes only the windows of the stretch. */
import type { BeatGrid, Features, KeyPose } from './types';

/** What a dance to a stretch is made from; all times count from its start. */
export interface Excerpt {
  features: Features;
  grid: BeatGrid;
  keyPoses: KeyPose[];
  frames: number;
}

/**
 * Cuts frames [from, to) out of a song.
 * @param whole features, beats and key poses of the song
 */
export function excerpt(
  whole: { features: Features; grid: BeatGrid; keyPoses: readonly KeyPose[] },
  from: number,
  to: number,
): Excerpt {
  const { features, grid } = whole;
  const columns = features.names.length;
  const start = from / features.fps;
  const end = to / features.fps;
  const shift = (times: readonly number[]) => times.map((time) => time - start);
  return {
    features: {
      ...features,
      frames: Math.max(0, Math.min(features.frames, to) - from),
      data: features.data.slice(from * columns, to * columns),
    },
    grid: { ...grid, beats: shift(grid.beats), downbeats: shift(grid.downbeats) },
    keyPoses: whole.keyPoses
      .filter((key) => key.time >= start && key.time < end)
      .map((key) => ({ ...key, time: key.time - start })),
    frames: to - from,
  };
}
