import { describe, expect, it } from 'vitest';
import {
  chainPosition,
  danceThrough,
  jointChain,
  JointPath,
  neighbouringKeys,
  slerpThrough,
} from '../../web/core/joint-path';
import { emptyMotion, frameView } from '../../web/core/motion';
import { poseToQuaternions, quaternionsToPose, slerp } from '../../web/core/rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, PARENTS } from '../../web/core/skeleton';
import type { KeyPose, Motion } from '../../web/core/types';

/** A dance whose joints all swing, each at its own pace. */
function swinging(frames: number): Motion {
  const motion = emptyMotion(frames);
  for (let frame = 0; frame < frames; frame++) {
    const t = frame / motion.fps;
    const turns = Array.from({ length: JOINT_COUNT * 3 }, (_, i) => 0.7 * Math.sin(t * (1 + (i % 5)) + i));
    motion.quaternions.set(poseToQuaternions(turns), frame * JOINT_COUNT * 4);
    motion.root.set([Math.sin(t), 0.9 + 0.05 * Math.cos(3 * t), 0.3 * t], frame * 3);
  }
  return motion;
}

const pose = (joint: string, turn: [number, number, number]): number[] => {
  const rotations = new Array<number>(JOINT_COUNT * 3).fill(0);
  turn.forEach((angle, axis) => (rotations[jointIndex(joint) * 3 + axis] = angle));
  return rotations;
};
const key = (id: string, time: number, rotations: number[]): KeyPose => ({ id, time, rotations });
const standing = () => [0, 0.955, 0];

describe('the path of a joint', () => {
  it('follows the parents up to the pelvis', () => {
    const chain = jointChain(jointIndex('right_hand'));
    expect(chain[0]).toBe(0);
    chain.slice(1).forEach((joint, i) => expect(PARENTS[joint]).toBe(chain[i]));
    expect(jointChain(0)).toEqual([0]);
  });

  it('is where forward kinematics puts every joint', () => {
    const motion = swinging(40);
    const out = new Float32Array(3);
    for (let frame = 0; frame < motion.frames; frame += 3) {
      const { quaternions, root } = frameView(motion, frame);
      const joints = forwardKinematics(quaternions, root);
      for (let joint = 0; joint < JOINT_COUNT; joint++) {
        chainPosition(motion, frame, jointChain(joint), out);
        for (let k = 0; k < 3; k++) expect(out[k]).toBeCloseTo(joints[joint * 3 + k], 5);
      }
    }
  });

  it('computes each frame once: stepping through a 10-minute song costs one frame a step', () => {
    const motion = emptyMotion(10 * 60 * 30);
    const path = new JointPath(motion, jointIndex('left_hand'));
    expect(path.ensure(1000, 1121)).toBe(121);
    expect(path.ensure(1001, 1122)).toBe(1);
    expect(path.ensure(990, 1111)).toBe(10);
    expect(path.ensure(990, 1122)).toBe(0);
    expect(path.ensure(-60, 4)).toBe(4);
    expect(path.ensure(motion.frames - 2, motion.frames + 60)).toBe(2);
  });
});

describe('a dance through an edited pose', () => {
  it('passes through the pose at its frame and is unchanged out of its reach', () => {
    const motion = swinging(300);
    const edited = pose('right_shoulder', [0.2, 0.5, 1.2]);
    const { motion: stretch, first } = danceThrough(motion, [key('a', 5, edited)], 5, 2);
    expect(first).toBe(90);
    expect(stretch.frames).toBe(121);
    const at = quaternionsToPose(frameView(stretch, 150 - first).quaternions);
    edited.forEach((value, i) => expect(at[i]).toBeCloseTo(value, 5));
    for (const frame of [90, 110, 190, 210]) {
      expect([...frameView(stretch, frame - first).quaternions]).toEqual([...frameView(motion, frame).quaternions]);
    }
    // The dance itself stays as it is.
    expect(motion.quaternions).toEqual(swinging(300).quaternions);
  });

  it('keeps to its neighbours', () => {
    const motion = swinging(300);
    const before = quaternionsToPose(frameView(motion, 141).quaternions);
    const keys = [key('b', 4.7, before), key('a', 5, pose('left_hip', [-1.2, 0, 0]))];
    const { motion: stretch, first } = danceThrough(motion, keys, 5, 2);
    const there = quaternionsToPose(frameView(stretch, 141 - first).quaternions);
    before.forEach((value, i) => expect(there[i]).toBeCloseTo(value, 4));
  });

  it('is clipped to the song', () => {
    const motion = swinging(60);
    expect(danceThrough(motion, [], 0.5, 2)).toMatchObject({ first: 0, motion: { frames: 60 } });
  });
});

describe('SLERP between key poses', () => {
  const keys = [
    key('c', 3, pose('right_elbow', [0, 1.5, 0])),
    key('a', 1, pose('right_elbow', [0, 0, 0])),
    key('b', 2, pose('right_elbow', [0, 1, 0])),
  ];

  it('goes through each and evenly between, and nowhere else', () => {
    const stretch = slerpThrough(keys, 30, standing, 2, 2)!;
    expect(stretch.first).toBe(30);
    expect(stretch.motion.frames).toBe(61);
    const elbow = (frame: number) =>
      quaternionsToPose(frameView(stretch.motion, frame - stretch.first).quaternions)[
        jointIndex('right_elbow') * 3 + 1
      ];
    expect(elbow(30)).toBeCloseTo(0, 5);
    expect(elbow(45)).toBeCloseTo(0.5, 5);
    expect(elbow(60)).toBeCloseTo(1, 5);
    expect(elbow(75)).toBeCloseTo(1.25, 5);
    expect(elbow(90)).toBeCloseTo(1.5, 5);
  });

  it('takes only what is in reach', () => {
    const stretch = slerpThrough(keys, 30, standing, 2, 0.5)!;
    expect(stretch.first).toBe(45);
    expect(stretch.motion.frames).toBe(31);
    const [a, b] = [keys[1], keys[2]].map((each) => poseToQuaternions(each.rotations));
    const elbow = jointIndex('right_elbow') * 4;
    const wanted = slerp(a.subarray(elbow, elbow + 4), b.subarray(elbow, elbow + 4), 0.5);
    wanted.forEach((value, i) => expect(stretch.motion.quaternions[elbow + i]).toBeCloseTo(value, 6));
  });

  it('needs two key poses', () => {
    expect(slerpThrough(keys.slice(0, 1), 30, standing, 2, 2)).toBeNull();
    expect(slerpThrough(keys, 30, standing, 9, 2)).toBeNull();
  });
});

describe('neighbouring key poses', () => {
  const keys = [1, 2, 3].map((time) => key(`k${time}`, time, []));

  it('are those around a time, without the one on it', () => {
    const ids = (seconds: number) => {
      const { before, after } = neighbouringKeys(keys, seconds, 30);
      return [before?.id ?? null, after?.id ?? null];
    };
    expect(ids(1.5)).toEqual(['k1', 'k2']);
    expect(ids(2)).toEqual(['k1', 'k3']);
    expect(ids(2.01)).toEqual(['k1', 'k3']);
    expect(ids(0)).toEqual([null, 'k1']);
    expect(ids(5)).toEqual(['k3', null]);
    expect(neighbouringKeys([], 1, 30)).toEqual({ before: null, after: null });
  });
});
