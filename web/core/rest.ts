/** The figure standing in the rest T-pose. */
import { forwardKinematics, JOINT_COUNT, jointIndex } from './skeleton';
import { spec } from './spec';

const identity = new Float32Array(JOINT_COUNT * 4).map((_, i) => (i % 4 === 3 ? 1 : 0));
const unplaced = forwardKinematics(identity, [0, 0, 0]);

/** Height of the pelvis of the figure standing in the rest pose, metres. */
export const REST_HEIGHT: number = spec.skeleton.toeHeight - unplaced[jointIndex('left_foot') * 3 + 1];

/** Joint positions of the rest T-pose standing on the floor at the origin, 24 x 3, metres. */
export const REST: Float32Array = forwardKinematics(identity, [0, REST_HEIGHT, 0]);
