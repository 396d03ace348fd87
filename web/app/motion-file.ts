/** A dance as a file for other programs. No page is needed for it: this runs in a worker. */
import { writeBvh } from '../core/formats/bvh-write';
import { frameTimes, motionSamplers } from '../core/formats/glb-motion';
import { writeGlb } from '../core/formats/glb-write';
import { writeMotionJson } from '../core/formats/motion-json';
import { writeNpz } from '../core/formats/npz-write';
import { resampleMotion } from '../core/motion-resample';
import { helperSamplers } from '../scene/skin-samplers';
import type { MotionFileRequest } from './motion-formats';

/**
 * Writes the file.
 * @param progress hears of it, 0..1
 * @throws Error when the dance has no frames
 */
export async function writeMotionFile(
  request: MotionFileRequest,
  progress: (fraction: number) => void = () => undefined,
): Promise<Uint8Array<ArrayBuffer>> {
  const { format, units, name, notes, figure, avatar } = request;
  const motion = resampleMotion(request.motion, request.fps);
  // The rest is mostly the writing, which is measured where it takes long.
  progress(0.1);
  const text = (content: string) => new TextEncoder().encode(content);
  if (format === 'bvh')
    return text(writeBvh(motion, { units, progress: (fraction) => progress(0.1 + fraction * 0.9) }));
  if (format === 'npz') return writeNpz(motion, notes.origin);
  if (format === 'json') return text(writeMotionJson(motion, notes));
  if (format === 'avatar') {
    if (!avatar) throw new Error('There is no character of your own on the stage: choose one first.');
    const { writeAvatar } = await import('./avatar-export');
    return writeAvatar(avatar, motion, name, notes.origin);
  }
  const times = frameTimes(motion);
  const samplers = [...motionSamplers(motion, times), ...(figure ? helperSamplers(motion, times) : [])];
  progress(0.6);
  const glb = writeGlb({ name, samplers, figure, ...(notes.origin ? { extras: { posebeat: notes.origin } } : {}) });
  if (format === 'glb') return glb;
  // The writer brings three along: nobody loads it who wants no FBX.
  const { glbToFbx } = await import('../scene/fbx-file');
  return glbToFbx(glb, motion.fps);
}
