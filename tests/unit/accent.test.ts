import { describe, expect, it } from 'vitest';
import { accentBeats } from '../../web/core/accent';
import { beatPhase } from '../../web/core/beat-phase';
import { jointSpeed } from '../../web/core/metrics';
import { emptyMotion } from '../../web/core/motion';
import { axisAngleToQuaternion } from '../../web/core/rotation';
import { steadyGrid } from './dance';

/** An arm that turns by an angle that depends on the frame. */
function arm(frames: number, angle: (t: number) => number) {
  const motion = emptyMotion(frames);
  for (let t = 0; t < frames; t++) {
    motion.root.set([t, 1, 0], t * 3);
    motion.quaternions.set(Array.from(axisAngleToQuaternion([0, 0, angle(t)])), (t * 24 + 16) * 4);
  }
  return motion;
}

describe('accents on the beat', () => {
  const bent = accentBeats(
    arm(150, (t) => t * 0.02),
    beatPhase(steadyGrid(5, 120, 0.5)),
  );
  it('leave what is on a beat where it is and move the rest by less than a frame', () => {
    for (const frame of [15, 30, 45, 60]) expect(bent.root[frame * 3]).toBeCloseTo(frame, 4);
    for (let t = 1; t < 149; t++) expect(Math.abs(bent.root[t * 3] - t)).toBeLessThan(0.85);
  });
  it('do not move what is on the frame of a key pose, on the beat or off it', () => {
    const keyed = accentBeats(
      arm(150, (t) => t * 0.02),
      beatPhase(steadyGrid(5, 120, 0.5)),
      [119, 134],
      100,
    );
    for (const frame of [19, 34]) expect(keyed.root[frame * 3]).toBeCloseTo(frame, 6);
    const order = Array.from({ length: 149 }, (_, t) => keyed.root[(t + 1) * 3] - keyed.root[t * 3]);
    expect(Math.min(...order)).toBeGreaterThan(0.3);
  });
  it('slow down on beats and hurry in between', () => {
    const speed = jointSpeed(bent);
    expect(speed[30] / speed[37]).toBeLessThan(0.6);
    expect(speed[45] / speed[52]).toBeLessThan(0.6);
  });
});
