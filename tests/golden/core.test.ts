import { describe, expect, it } from 'vitest';
import { headingOf, localFrameAt, toLocalRows } from '../../web/core/localframe';
import * as M from '../../web/core/metrics';
import type { Motion } from '../../web/core/types';
import * as R from '../../web/core/rotation';
import { forwardKinematics, mirrorPose, worldRotations } from '../../web/core/skeleton';
import { specHash } from '../../web/core/spec';
import { keyDistances } from '../../web/core/window-plan';
import { key } from '../unit/dance';
import { agree, golden } from './golden';

type Rows = number[][];

describe('what Python and TypeScript must agree on', () => {
  it('the fingerprint of the spec', () => {
    expect(specHash).toBe(golden<{ specHash: string }>('spec').specHash);
  });

  it('rotations', () => {
    const g = golden<{
      tolerance: number;
      axisAngle: Rows;
      quaternion: Rows;
      sixD: Rows;
      axisAngleBack: Rows;
      heading: number[];
    }>('rotations');
    g.axisAngle.forEach((aa, i) => {
      const q = R.axisAngleToQuaternion(aa);
      expect(R.angleBetween(q, g.quaternion[i])).toBeLessThan(g.tolerance);
      agree(R.quaternionToSixD(q), g.sixD[i], g.tolerance);
      expect(R.angleBetween(R.sixDToQuaternion(g.sixD[i]), q)).toBeLessThan(g.tolerance);
      // At half a turn both axes are right, so compare the rotations.
      expect(R.angleBetween(R.axisAngleToQuaternion(g.axisAngleBack[i]), q)).toBeLessThan(g.tolerance);
      expect(Math.cos(headingOf(q) - g.heading[i])).toBeGreaterThan(1 - g.tolerance);
    });
  });

  it('SLERP', () => {
    const { slerp, tolerance } = golden<{
      tolerance: number;
      slerp: { from: Rows; to: Rows; fraction: number[]; result: Rows; angle: number[] };
    }>('rotations');
    slerp.from.forEach((from, i) => {
      const between = R.slerp(from, slerp.to[i], slerp.fraction[i]);
      expect(R.angleBetween(between, slerp.result[i])).toBeLessThan(tolerance);
      expect(R.angleBetween(from, slerp.to[i])).toBeCloseTo(slerp.angle[i], 5);
    });
  });

  it('forward kinematics and the mirror', () => {
    const g = golden<{
      tolerance: number;
      axisAngle: Rows;
      root: Rows;
      positions: Rows[];
      worldQuaternions: Rows[];
      mirroredAxisAngle: Rows;
    }>('kinematics');
    g.axisAngle.forEach((pose, i) => {
      const q = R.poseToQuaternions(pose);
      agree(forwardKinematics(q, g.root[i]), g.positions[i].flat(), g.tolerance);
      const world = worldRotations(q);
      g.worldQuaternions[i].forEach((turn, joint) => {
        expect(R.angleBetween(world.subarray(joint * 4, joint * 4 + 4), turn)).toBeLessThan(g.tolerance);
      });
      agree(
        R.quaternionsToSixD(R.poseToQuaternions(mirrorPose(pose))),
        R.quaternionsToSixD(R.poseToQuaternions(g.mirroredAxisAngle[i])),
        g.tolerance,
      );
    });
  });

  it('the distances to the keys on either side', () => {
    const g = golden<{ frames: number; keyFrames: number[]; toPrevious: number[]; toNext: number[] }>('positional');
    const mask = new Float32Array(g.frames);
    for (const frame of g.keyFrames) mask[frame] = 1;
    const { toPrevious, toNext } = keyDistances(mask);
    expect(Array.from(toPrevious)).toEqual(g.toPrevious);
    expect(Array.from(toNext)).toEqual(g.toNext);
  });

  it('measures and the local frame', () => {
    const g = golden<{
      tolerance: number;
      quaternions: Rows;
      root: Rows;
      keyFrames: number[];
      keyPoses: Rows;
      beatFrames: number[];
      consistencyError: number;
      smoothness: number;
      meanJerk: number;
      motionBeatFrames: number[];
      beatHitRate: number[];
      footSkate: number;
      localFrame: { seedFrames: number; firstFrame: number[]; lastFrame: number[] };
    }>('metrics');
    const motion: Motion = {
      fps: 30,
      frames: g.root.length,
      root: Float32Array.from(g.root.flat()),
      quaternions: Float32Array.from(g.quaternions.flat()),
    };
    const relative = (actual: number, expected: number, tolerance: number) =>
      expect(Math.abs(actual / expected - 1)).toBeLessThan(tolerance);
    const keys = g.keyFrames.map((frame, i) => key(frame / 30, g.keyPoses[i]));
    relative(M.consistencyError(motion, keys), g.consistencyError, g.tolerance);
    // The mean is a difference of large numbers near zero (paper A's eq. 16), so rounding shows.
    relative(M.smoothness(motion), g.smoothness, 0.01);
    relative(M.meanJerk(motion), g.meanJerk, 0.005);
    relative(M.footSkate(motion), g.footSkate, g.tolerance);
    agree(
      M.motionBeats(motion).map((time) => time * 30),
      g.motionBeatFrames,
      1e-6,
    );
    const beats = g.beatFrames.map((frame) => frame / 30);
    agree(
      [1, 2, 3, 4, 5].map((delta) => M.beatHitRate(motion, beats, delta)),
      g.beatHitRate,
      1e-9,
    );
    const rows = toLocalRows(motion, 0, motion.frames, localFrameAt(motion, g.localFrame.seedFrames - 1));
    agree(rows.subarray(0, 147), g.localFrame.firstFrame, g.tolerance);
    agree(rows.subarray(rows.length - 147), g.localFrame.lastFrame, g.tolerance);
  });
});
