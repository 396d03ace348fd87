import { describe, expect, it } from 'vitest';
import { cleanContacts, LOOKAHEAD } from '../../web/core/contact';
import { bodyTrack } from '../../web/core/contact-body';
import { jumpHeights, liftEnvelope } from '../../web/core/contact-floor';
import { moveFoot } from '../../web/core/contact-leg';
import { footSkate, jointPositions } from '../../web/core/metrics';
import { emptyMotion, sliceMotion } from '../../web/core/motion';
import { poseToQuaternions } from '../../web/core/rotation';
import { forwardKinematics, jointIndex } from '../../web/core/skeleton';
import { spec } from '../../web/core/spec';
import type { Motion } from '../../web/core/types';
import { poseWith } from './dance';

/** Walks on the spot with a pelvis that slides sideways and sinks: all that the clean-up is there for. */
function badDance(frames: number): Motion {
  const motion = emptyMotion(frames);
  for (let t = 0; t < frames; t++) {
    const left = Math.max(0, Math.sin(t / 8));
    const right = Math.max(0, -Math.sin(t / 8));
    const pose = poseWith({
      left_hip: [-0.6 * left, 0, 0],
      left_knee: [1.1 * left, 0, 0],
      right_hip: [-0.6 * right, 0, 0],
      right_knee: [1.1 * right, 0, 0],
    });
    motion.quaternions.set(poseToQuaternions(pose), t * 96);
    motion.root.set([t * 0.01, 0.955 - 0.03 * Math.sin(t / 20), 0], t * 3);
  }
  return motion;
}

const clean = (input: Motion, keys: number[] = []) => {
  const output = emptyMotion(input.frames);
  cleanContacts(input, output, 0, input.frames, { keys });
  return output;
};
const lowest = (motion: Motion) => Math.min(...bodyTrack(motion).ground.map((y, t) => motion.root[t * 3 + 1] - y));

describe('foot contact clean-up', () => {
  it('stops the sliding and keeps everything on the floor', () => {
    const input = badDance(240);
    const output = clean(input);
    expect(footSkate(input)).toBeGreaterThan(0.25);
    expect(footSkate(output)).toBeLessThan(0.03);
    expect(lowest(input)).toBeLessThan(-0.02);
    expect(lowest(output)).toBeGreaterThanOrEqual(0);
  });

  it('leaves the rotations of an exact key alone', () => {
    const input = badDance(120);
    const output = clean(input, [40, 77]);
    for (const frame of [40, 77]) {
      expect(sliceMotion(output, frame, frame + 1).quaternions).toEqual(
        sliceMotion(input, frame, frame + 1).quaternions,
      );
    }
    expect(sliceMotion(output, 20, 60).quaternions).not.toEqual(sliceMotion(input, 20, 60).quaternions);
  });

  it('gives the same floor and no jump at the seam when it works in stretches', () => {
    const input = badDance(240);
    const output = emptyMotion(240);
    const options = { keys: [] };
    const seen = { ...input, frames: 100 + LOOKAHEAD };
    const state = cleanContacts(seen, output, 0, 100, options);
    expect(state.frame).toBe(100);
    const kept = output.root.slice(0, 300);
    cleanContacts(input, output, 100, 240, { ...options, state });
    expect(output.root.slice(0, 300)).toEqual(kept);
    const toes = jointPositions(output);
    const speed = (t: number, joint: number) =>
      30 * Math.hypot(...[0, 1, 2].map((k) => toes[(t * 24 + joint) * 3 + k] - toes[((t - 1) * 24 + joint) * 3 + k]));
    const around = [99, 100, 101].map((t) => speed(t, 0));
    expect(Math.max(...around) - Math.min(...around)).toBeLessThan(0.15);
    expect(footSkate(output)).toBeLessThan(0.04);
  });

  it('leads a figure that walks away back to the stage', () => {
    const input = emptyMotion(3000);
    for (let t = 0; t < 3000; t++) {
      const phase = t / 8;
      const swing = (side: number) =>
        poseWith({
          left_hip: [-0.15 * Math.sin(phase) * side, 0, 0],
          left_knee: [0.9 * Math.max(0, Math.cos(phase)), 0, 0],
          right_hip: [0.15 * Math.sin(phase) * side, 0, 0],
          right_knee: [0.9 * Math.max(0, -Math.cos(phase)), 0, 0],
        });
      input.quaternions.set(poseToQuaternions(swing(1)), t * 96);
      input.root.set([0, 0.955, 0], t * 3);
    }
    const output = clean(input);
    let way = 0;
    let farthest = 0;
    for (let t = 1; t < 3000; t++) {
      const i = t * 3;
      way += Math.hypot(output.root[i] - output.root[i - 3], output.root[i + 2] - output.root[i - 1]);
      farthest = Math.max(farthest, Math.hypot(output.root[i], output.root[i + 2]));
    }
    expect(way).toBeGreaterThan(8);
    expect(farthest).toBeLessThan(3.5);
  });
});

describe('jumps', () => {
  const ground = new Float64Array(60).fill(0.9);
  it('keep their height when the pelvis rises for a time that a body can fly', () => {
    const jump = ground.map((y, t) => y + (t >= 20 && t <= 32 ? 0.3 * (1 - ((t - 26) / 7) ** 2) : 0));
    expect(Math.max(...jumpHeights(ground, jump))).toBeCloseTo(0.3, 5);
  });
  it('are not seen in floating or in legs that are drawn up', () => {
    expect(
      Math.max(
        ...jumpHeights(
          ground,
          ground.map((y) => y + 0.1),
        ),
      ),
    ).toBe(0);
    expect(
      Math.max(
        ...jumpHeights(
          ground,
          ground.map((y, t) => y + (t > 5 && t < 50 ? 0.2 : 0)),
        ),
      ),
    ).toBe(0);
    const drawnUp = ground.map((y, t) => y - (t >= 20 && t <= 32 ? 0.2 : 0));
    expect(Math.max(...jumpHeights(drawnUp, ground))).toBe(0);
  });
  it('lift smoothly and never too little', () => {
    const missing = new Float64Array(40);
    missing[20] = 0.05;
    const lift = liftEnvelope(missing);
    expect(lift[20]).toBe(0.05);
    expect(lift[15]).toBeGreaterThan(0);
    expect(lift[10]).toBe(0);
  });
});

describe('a moved leg', () => {
  const pose = poseWith({ left_hip: [-0.4, 0, 0.1], left_knee: [0.7, 0, 0], pelvis: [0.1, 0.8, 0] });
  it('puts the foot where it should go and keeps its direction', () => {
    const q = poseToQuaternions(pose);
    const before = forwardKinematics(q, [0, 1, 0]).slice();
    moveFoot(q, 0, [0.05, 0.04, -0.06]);
    const after = forwardKinematics(q, [0, 1, 0]);
    for (const name of ['left_ankle', 'left_foot']) {
      const i = jointIndex(name) * 3;
      [0.05, 0.04, -0.06].forEach((v, k) => expect(after[i + k] - before[i + k]).toBeCloseTo(v, 4));
    }
    const i = jointIndex('right_foot') * 3;
    expect(after.slice(i, i + 3)).toEqual(before.slice(i, i + 3));
  });
  it('reaches no further than it is long', () => {
    const q = poseToQuaternions(poseWith({}));
    moveFoot(q, 1, [0, -0.5, 0]);
    expect(q.every(Number.isFinite)).toBe(true);
    const toe = forwardKinematics(q, [0, 0.955, 0])[jointIndex('right_foot') * 3 + 1];
    expect(toe).toBeGreaterThan(spec.skeleton.toeHeight - 0.01);
  });
});
