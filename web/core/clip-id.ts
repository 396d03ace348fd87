import { sha256Hex } from './spec-hash';
import type { SeedClip } from './types';

/** The id of a starting clip of the visitor's own: the same poses and places have the same one. */
export function clipId(poses: SeedClip['poses'], root: SeedClip['root']): string {
  return `own-${sha256Hex(JSON.stringify([poses, root])).slice(0, 12)}`;
}
