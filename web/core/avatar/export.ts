/** An avatar's own file with the dance in it. */
import type { Motion } from '../types';
import type { AvatarRetargeter } from './retarget';

export interface AvatarGlbOptions {
  /** Name of the animation. */
  name: string;
  /** Kept with the animation, under `extras`. */
  extras?: Readonly<Record<string, unknown>>;
}

/**
 * The avatar's file with the dance as its first animation, one key per frame; all else stays as it is, VRM metadata too.
 * @param original the very bytes that the retargeter's rig was read from
 * @param motion at the wanted frame rate
 * @returns a .glb file
 * @throws Error when the dance has no frames or the file is damaged
 */
export function avatarGlb(
  original: Uint8Array,
  retargeter: AvatarRetargeter,
  motion: Motion,
  options: AvatarGlbOptions,
): Uint8Array<ArrayBuffer> {
  throw new Error(`Not yet: ${original.length}, ${retargeter.scale}, ${motion.frames}, ${options.name}.`);
}
