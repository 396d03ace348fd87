/** The camera's way for a dancer of another size than our figure's. */
import type { CameraView } from '../core/document';
import type { CameraPath } from './camera-path';

/** A dancer beside our figure, which has 1 and 1. */
export interface DancerSize {
  /** Height over our figure's. */
  size: number;
  /** How far it goes for a metre of the dance. */
  stride: number;
}

/**
 * Makes a camera path that was worked out for our figure fit another dancer: it goes where the dancer goes, and frames it as it would ours.
 * @param path changed in place
 * @param view the visitor's own view, which is kept as it is but for where the dancer is; null = any other camera
 */
export function fitPath(path: CameraPath, { size, stride }: DancerSize, view: CameraView | null): CameraPath {
  const { position, target, centre } = path;
  for (let frame = 0; frame < centre.length / 2; frame++)
    for (let axis = 0; axis < 3; axis++) {
      const at = frame * 3 + axis;
      if (view) {
        const shift = view.follows && axis !== 1 ? centre[frame * 2 + axis / 2] * (stride - 1) : 0;
        position[at] += shift;
        target[at] += shift;
        continue;
      }
      const way = position[at] - target[at];
      target[at] *= axis === 1 ? size : stride;
      position[at] = target[at] + way * size;
    }
  for (let i = 0; i < centre.length; i++) centre[i] *= stride;
  return path;
}
