/** A path to draw, apart from how it is drawn: what the page prepares without loading any graphics. */

/** Most frames of a path that are drawn. */
export const PATH_CAPACITY = 256;

/** What lies on a frame of a path. */
export const PATH_MARK = { none: 0, tick: 1, beat: 2, key: 3 } as const;

/** A joint's way through time, a point a frame. The arrays may be written again after they were handed over. */
export interface PathPicture {
  /** x, y, z of each frame, metres. */
  points: Float32Array;
  /** One {@link PATH_MARK} a frame. */
  marks: Uint8Array;
  /** Frames in use. */
  count: number;
  /** The playhead, in frames from the first; need not be whole. */
  now: number;
}
