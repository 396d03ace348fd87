/** Keeps poses within what a person can do, and says so. */
import { limitPose, type ClampJoint } from '../../core/pose-tools';
import type { PoseTools } from '../../core/types';
import { jointLabel } from '../../scene/pose-edit';
import type { Context } from '../context';

/** The anatomy behind the editor. */
export interface PoseMath {
  /** Nearest local rotation (x y z w) that a joint can take. */
  clampRotation: ClampJoint;
  /**
   * The pose after a joint was taken to a place, with the body following.
   * @param target world position, metres, of the figure standing on the floor
   */
  reach(rotations: readonly number[], joint: number, target: readonly number[], tools: PoseTools): Promise<number[]>;
}

/** Words for joints that stopped at their limits; empty when none did. */
export function limitWord(limited: readonly number[]): string {
  if (limited.length === 0) return '';
  if (limited.length > 2) return `${limited.length} joints stopped at their limits.`;
  const names = limited.map((joint, i) => (i === 0 ? jointLabel(joint) : jointLabel(joint).toLowerCase()));
  return `${names.join(' and ')} stopped at ${limited.length === 1 ? 'its limit' : 'their limits'}.`;
}

/**
 * Brings a pose inside the limits where the visitor wants them.
 * @param members the joints to look at, by default all
 */
export function withinTools(context: Context, math: PoseMath, rotations: number[], members?: Iterable<number>) {
  if (!context.state.poseTools.value.limits) return { rotations, limited: [] };
  return limitPose(rotations, math.clampRotation, members);
}
