import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { emptyMotion } from '../../web/core/motion';
import { angleBetween, axisAngleToQuaternion } from '../../web/core/rotation';
import { JOINT_COUNT, jointIndex } from '../../web/core/skeleton';
import { FASTEST, limitTurns } from '../../web/core/turn-limit';
import type { Motion } from '../../web/core/types';

const DEGREES = Math.PI / 180;
const ELBOW = jointIndex('left_elbow');

/** A dance in which one joint turns about an axis by angles, radians. */
function turning(angles: readonly number[], axis = [0, 1, 0], joint = ELBOW): Motion {
  const motion = emptyMotion(angles.length);
  angles.forEach((angle, t) =>
    axisAngleToQuaternion(
      axis.map((each) => each * angle),
      motion.quaternions.subarray((t * JOINT_COUNT + joint) * 4, (t * JOINT_COUNT + joint) * 4 + 4),
    ),
  );
  return motion;
}

const rotation = ({ quaternions }: Motion, t: number, joint = ELBOW) =>
  quaternions.subarray((t * JOINT_COUNT + joint) * 4, (t * JOINT_COUNT + joint) * 4 + 4);
const steps = (motion: Motion, joint = ELBOW) =>
  Array.from({ length: motion.frames - 1 }, (_, t) =>
    angleBetween(rotation(motion, t, joint), rotation(motion, t + 1, joint)),
  );
const copy = (motion: Motion): Motion => ({
  ...motion,
  root: motion.root.slice(),
  quaternions: motion.quaternions.slice(),
});

describe('turns that no joint makes', () => {
  it('begin at 25 degrees from frame to frame', () => {
    expect(FASTEST / DEGREES).toBeCloseTo(25, 9);
  });

  it('are spread over the frames around them, the shortest way', () => {
    const motion = turning(Array.from({ length: 60 }, (_, t) => (t < 30 ? 0 : 137 * DEGREES)));
    const before = copy(motion);
    limitTurns(motion);
    expect(Math.max(...steps(motion))).toBeLessThanOrEqual(FASTEST);
    // All on the way from the one to the other, none to and fro.
    const angles = Array.from({ length: 60 }, (_, t) => angleBetween(rotation(before, 0), rotation(motion, t)));
    angles.slice(1).forEach((angle, t) => expect(angle).toBeGreaterThanOrEqual(angles[t] - 1e-6));
    // Half-way where the jump was, by symmetry.
    expect((angles[29] + angles[30]) / 2 / DEGREES).toBeCloseTo(68.5, 1);
    // 137 / 25 = 5.5 frames of spread reach 16.4 frames.
    for (const t of [0, 5, 10, 12, 47, 50, 59]) expect(rotation(motion, t)).toEqual(rotation(before, t));
  });

  it('leave other joints and slower turns to the bit', () => {
    const quick = turning(Array.from({ length: 40 }, (_, t) => 24 * DEGREES * t));
    const before = copy(quick);
    limitTurns(quick);
    expect(quick).toEqual(before);
    const motion = turning([0, 0, 0, 0, 0, 0, 2, 2, 2, 2, 2, 2]);
    const still = rotation(motion, 6, ELBOW + 1).slice();
    limitTurns(motion);
    for (let t = 0; t < motion.frames; t++) expect(rotation(motion, t, ELBOW + 1)).toEqual(still);
  });

  it('are spread at the ends of a dance, too, and where a joint flips there and back', () => {
    for (const angles of [
      [3, ...new Array<number>(40).fill(0)],
      [...new Array<number>(40).fill(0), 3],
      [...new Array<number>(20).fill(0), 2.5, ...new Array<number>(20).fill(0)],
    ]) {
      const motion = turning(angles);
      limitTurns(motion);
      expect(Math.max(...steps(motion))).toBeLessThanOrEqual(FASTEST);
    }
  });

  it('never remain, whatever the jumps, and rotations stay rotations', () => {
    const jump = fc.record({ at: fc.integer({ min: 1, max: 118 }), by: fc.double({ min: -3, max: 3, noNaN: true }) });
    fc.assert(
      fc.property(
        fc.array(jump, { maxLength: 6 }),
        fc.tuple(fc.integer({ min: -3, max: 3 }), fc.integer({ min: 1, max: 3 }), fc.integer({ min: -3, max: 3 })),
        (jumps, direction) => {
          const length = Math.hypot(...direction);
          const motion = turning(
            Array.from({ length: 120 }, (_, t) =>
              jumps.reduce((sum, { at, by }) => sum + (t >= at ? by : 0), 0.3 * Math.sin(t / 6)),
            ),
            direction.map((each) => each / length),
          );
          limitTurns(motion);
          expect(Math.max(...steps(motion))).toBeLessThanOrEqual(FASTEST * (1 + 1e-9));
          for (let t = 0; t < 120; t++) expect(Math.hypot(...rotation(motion, t))).toBeCloseTo(1, 5);
        },
      ),
      { numRuns: 60 },
    );
  });
});
