/** A character's own file with the dance in it. No page is needed for it: this runs in a worker. */
import { avatarGlb } from '../core/avatar/export';
import { AvatarRetargeter } from '../core/avatar/retarget';
import { readAvatarRig } from '../core/avatar/rig';
import type { MotionOrigin } from '../core/formats/motion-origin';
import type { Motion } from '../core/types';
import type { AvatarSource } from '../scene/avatar';

/**
 * Writes the file.
 * @param motion at the wanted frame rate
 * @param name of the animation
 * @throws Error when the dance has no frames or the file is damaged
 */
export function writeAvatar(
  { bytes, map }: AvatarSource,
  motion: Motion,
  name: string,
  origin?: MotionOrigin,
): Uint8Array<ArrayBuffer> {
  const retargeter = new AvatarRetargeter(readAvatarRig(bytes), [...map]);
  return avatarGlb(bytes, retargeter, motion, { name, ...(origin ? { extras: { posebeat: origin } } : {}) });
}
