import type { PoseTools } from './types';

/** How the pose editor works when it is first opened. */
export const DEFAULT_TOOLS: Readonly<PoseTools> = {
  mode: 'rotate',
  space: 'local',
  limits: true,
  mirror: false,
  pins: new Set(),
  balance: false,
};
