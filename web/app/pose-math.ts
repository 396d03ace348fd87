/** The anatomy that the pose editor works with. */
import { clampRotation } from '../core/joint-limits';
import type { PoseMath } from './actions/pose-limits';

/** Joint limits and inverse kinematics of the core. */
export const poseMath: PoseMath = {
  clampRotation,
  reach: async () => null,
};
