/** The skin's helper bones as bones and animations of a GLB file. No three here: this runs in a worker. */
import { isStill, frameTimes } from '../core/formats/glb-motion';
import type { GlbHelper, GlbSampler } from '../core/formats/glb-write';
import { conjugate, multiply } from '../core/rotation';
import { JOINT_COUNT } from '../core/skeleton';
import type { Motion } from '../core/types';
import { boneTurn, SKIN_BONES } from './skin-bones';

const HELPERS = SKIN_BONES.filter(({ recipe }) => recipe.kind !== 'joint');
/** 1 in a normalised 16-bit integer. */
const ONE = 32767;

/**
 * A helper hangs on its joint, at the same place, so that the skin follows when somebody turns the joint; its own rotation is what the
 * skin has less (or more) than the joint.
 */
export const SKIN_HELPERS: readonly GlbHelper[] = HELPERS.map(({ name, joint }) => ({ name: `skin_${name}`, joint }));

/** For each skin bone the bone of the file: a joint, or 24 + helper. */
export const FILE_BONES: readonly number[] = SKIN_BONES.map((bone) =>
  bone.recipe.kind === 'joint' ? bone.joint : JOINT_COUNT + HELPERS.indexOf(bone),
);

/** The helpers' rotations, one key per frame, to 2e-5 radians; one that keeps still has one key. */
export function helperSamplers(motion: Motion, times: Float32Array = frameTimes(motion)): GlbSampler[] {
  const { frames, quaternions } = motion;
  const once = new Float32Array(1);
  const tracks = HELPERS.map(() => new Int16Array(frames * 4));
  const before = HELPERS.map(() => [0, 0, 0, 1]);
  for (let frame = 0; frame < frames; frame++) {
    const local = (joint: number) => {
      const at = (frame * JOINT_COUNT + joint) * 4;
      return [quaternions[at], quaternions[at + 1], quaternions[at + 2], quaternions[at + 3]];
    };
    HELPERS.forEach((bone, i) => {
      const turn = multiply(conjugate(local(bone.joint)), boneTurn(bone, local));
      const last = before[i];
      const away = turn[0] * last[0] + turn[1] * last[1] + turn[2] * last[2] + turn[3] * last[3] < 0;
      const scale = (away ? -ONE : ONE) / (Math.hypot(...turn) || 1);
      for (let k = 0; k < 4; k++) tracks[i][frame * 4 + k] = Math.round(turn[k] * scale);
      before[i] = turn.map((value) => value * scale);
    });
  }
  return tracks.map((values, i) => {
    const still = isStill(values);
    return {
      joint: JOINT_COUNT + i,
      path: 'rotation',
      times: still ? once : times,
      values: still ? values.slice(0, 4) : values,
      interpolation: 'LINEAR',
    };
  });
}
