/** The anatomy that the pose editor works with. */
import { clampRotation } from '../core/joint-limits';
import type { PoseMath } from './actions/pose-limits';

/** Joint limits and inverse kinematics of the core. */
export const poseMath: PoseMath = {
  clampRotation,
  // The solver comes with the stage; until then nothing needs it.
  reach: async (...wish) => (await import('../scene/ik-drag')).reachPose(...wish),
};
