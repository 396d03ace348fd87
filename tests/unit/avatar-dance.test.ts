import { describe, expect, it } from 'vitest';
import { AvatarRetargeter } from '../../web/core/avatar/retarget';
import { cleanContacts } from '../../web/core/contact';
import { HEEL_OFFSET } from '../../web/core/contact-body';
import { emptyMotion, frameView } from '../../web/core/motion';
import { REST_HEIGHT } from '../../web/core/rest';
import {
  angleBetween,
  axisAngleToQuaternion,
  multiply,
  poseToQuaternions,
  rotateVector,
  slerp,
} from '../../web/core/rotation';
import { jointIndex, worldRotations } from '../../web/core/skeleton';
import { spec } from '../../web/core/spec';
import type { Motion } from '../../web/core/types';
import { poseWith } from './dance';
import { anonymousGlb, LONG_LEGS, mixamoGlb, vrm0File, vrm1File } from './support/avatar-rigs';
import { stageAvatar, type AvatarStage } from './support/avatar-stage';
import { jointsOf, wildMotion } from './support/wild-motion';

const SIDES = ['left', 'right'] as const;
/** Frames between two key poses. */
const EVERY = 24;
/** Key poses of a dance: standing, a step, a deep bend, a kick, a turn of the back. */
const POSES = [
  poseWith({ left_shoulder: [0, 0, -1.2], right_shoulder: [0, 0, 1.2] }),
  poseWith({
    left_hip: [-0.9, 0, 0.1],
    left_knee: [1.4, 0, 0],
    left_shoulder: [0, 0.6, -0.8],
    right_shoulder: [0.3, -0.5, 0.4],
    right_elbow: [0, 1.2, 0],
  }),
  poseWith({
    left_hip: [-1, 0.2, 0.25],
    right_hip: [-1, -0.2, -0.25],
    left_knee: [1.6, 0, 0],
    right_knee: [1.6, 0, 0],
    left_ankle: [-0.6, 0, 0],
    right_ankle: [-0.6, 0, 0],
    spine1: [0.5, 0, 0],
    spine2: [0.3, 0.3, 0],
  }),
  poseWith({
    right_hip: [-1.5, 0, -0.2],
    left_knee: [0.2, 0, 0],
    left_hip: [-0.1, 0, 0.05],
    spine2: [-0.2, -0.4, 0.1],
    left_elbow: [0, -1.5, 0],
    neck: [0.2, 0.4, 0],
  }),
  poseWith({
    spine1: [0.1, 0.5, 0.1],
    spine3: [0, 0.4, 0],
    head: [0, 0.5, 0.2],
    left_collar: [0, 0, 0.2],
    left_shoulder: [0.2, 0, 1.2],
    right_shoulder: [0, 0, -0.9],
    right_wrist: [0, 0, -0.5],
  }),
];

/** Eight seconds with the feet cleaned: turning about slowly, then not, and at the end a deep bend that is held. */
function dance(): Motion {
  const frames = 8 * spec.fps;
  const raw = emptyMotion(frames);
  const poses = POSES.map((pose) => poseToQuaternions(pose));
  for (let t = 0; t < frames; t++) {
    const at = Math.floor(t / EVERY);
    const last = t >= 7 * EVERY;
    const [a, b] = last ? [poses[2], poses[2]] : [poses[at % poses.length], poses[(at + 1) % poses.length]];
    const share = (1 - Math.cos((Math.PI * (t % EVERY)) / EVERY)) / 2;
    for (let i = 0; i < 96; i += 4) {
      raw.quaternions.set(slerp(a.subarray(i, i + 4), b.subarray(i, i + 4), share), t * 96 + i);
    }
    const heading = axisAngleToQuaternion([0, Math.min(t / 120, 1), 0]);
    raw.quaternions.set(multiply(heading, raw.quaternions.subarray(t * 96, t * 96 + 4)), t * 96);
    raw.root[t * 3 + 1] = 0.95;
  }
  const clean = emptyMotion(frames);
  const keys = Array.from({ length: Math.ceil(frames / EVERY) }, (_, i) => i * EVERY);
  cleanContacts(raw, clean, 0, frames, { keys });
  return clean;
}
const motion = dance();

/** How far our foot is above the floor, where its ball is, and which way it points. */
function ourFoot(frame: number, side: 'left' | 'right') {
  const { ankle, toe } = spec.skeleton.feet[side];
  const joints = jointsOf(motion, frame);
  const turns = worldRotations(motion.quaternions.subarray(frame * 96, frame * 96 + 96));
  const turn = Array.from(turns.subarray(ankle * 4, ankle * 4 + 4));
  const heel = joints[ankle * 3 + 1] + rotateVector<number[]>(turn, HEEL_OFFSET)[1];
  const clear = Math.min(joints[toe * 3 + 1], heel) - spec.skeleton.toeHeight;
  return { clear, ball: [joints[toe * 3], joints[toe * 3 + 2]], turn };
}

const LIMBS = SIDES.flatMap((side) => [
  { arm: true, bone: [`${side}_shoulder`, `${side}_elbow`] },
  { arm: true, bone: [`${side}_elbow`, `${side}_wrist`] },
  { arm: false, bone: [`${side}_hip`, `${side}_knee`] },
  { arm: false, bone: [`${side}_knee`, `${side}_ankle`] },
]);

/** Between a bone of ours and the avatar's, degrees. */
function angleOf(stage: AvatarStage, joints: Float32Array, [from, to]: string[]): number {
  const [a, b] = [jointIndex(from) * 3, jointIndex(to) * 3];
  const ours = [0, 1, 2].map((k) => joints[b + k] - joints[a + k]);
  const theirs = stage.place(to).sub(stage.place(from)).normalize().toArray();
  const dot = ours.reduce((sum, value, k) => sum + value * theirs[k], 0) / Math.hypot(...ours);
  return (Math.acos(Math.min(1, dot)) * 180) / Math.PI;
}

const AVATARS: [string, () => Uint8Array<ArrayBuffer>][] = [
  ['Mixamo’s names, long legs, centimetres', () => mixamoGlb()],
  ['VRM 0, small, looking back', () => vrm0File()],
  ['VRM 1, broad, arms hanging', () => vrm1File()],
  [
    'no names, standing in another pose',
    () => anonymousGlb(undefined, { posed: { leftUpperArm: [0.5, 0.1, 0, 0.86] } }),
  ],
  ['transforms as matrices', () => mixamoGlb({ matrices: true })],
];

describe.each(AVATARS)('an avatar (%s)', (_, file) => {
  it('stands where we stand, with the soles on the floor and its limbs as ours', async () => {
    const stage = await stageAvatar(file());
    const { scale } = stage.retargeter;
    const most = { floating: 0, sinking: 0, sliding: 0, pivoting: 0, arms: 0, legs: 0, keyLegs: 0, hips: 0, jump: 0 };
    const raise = (what: keyof typeof most, value: number) => (most[what] = Math.max(most[what], value));
    let before: Record<string, { at: number[]; ours: number[]; turn: number[] }> = {};
    let hipsBefore: number[] | null = null;
    let standing = 0;
    for (let t = 0; t < motion.frames; t++) {
      stage.show(motion, t);
      const joints = jointsOf(motion, t);
      const now: typeof before = {};
      for (const side of SIDES) {
        const { clear, ball, turn } = ourFoot(t, side);
        const place = stage.place(`${side}_foot`);
        now[side] = { at: [place.x, place.z], ours: ball, turn };
        const sole = stage.sole(side);
        raise('sinking', -sole);
        if (clear < 0.005) raise('floating', sole);
        const last = before[side];
        // Our foot stands: its ball keeps its place.
        if (!last || clear > 0.03 || Math.hypot(ball[0] - last.ours[0], ball[1] - last.ours[1]) * motion.fps > 0.002)
          continue;
        const speed = Math.hypot(place.x - last.at[0], place.z - last.at[1]) * motion.fps;
        const turns = angleBetween(turn, last.turn) * motion.fps > 0.2;
        raise(turns ? 'pivoting' : 'sliding', speed);
        if (!turns) standing++;
      }
      before = now;
      for (const { arm, bone } of LIMBS) {
        const angle = angleOf(stage, joints, bone);
        raise(arm ? 'arms' : 'legs', angle);
        if (!arm && t % EVERY === 0) raise('keyLegs', angle);
      }
      const middle = stage.place('left_hip').add(stage.place('right_hip')).divideScalar(2).toArray();
      const ours = [0, 1, 2].map((k) => (joints[3 + k] + joints[6 + k]) / 2);
      raise('hips', Math.abs(middle[1] - scale * ours[1]));
      if (hipsBefore) raise('jump', Math.hypot(...middle.map((value, k) => value - scale * ours[k] - hipsBefore![k])));
      hipsBefore = middle.map((value, k) => value - scale * ours[k]);
    }
    expect(standing).toBeGreaterThan(motion.fps);
    // Metres.
    expect(most.floating).toBeLessThan(0.0075);
    expect(most.sinking).toBeLessThan(0.001);
    // Metres per second; a foot that turns on its ball turns about a point up to a few centimetres beside the avatar's.
    expect(most.sliding).toBeLessThan(0.01);
    expect(most.pivoting).toBeLessThan(0.02);
    // Degrees.
    expect(most.arms).toBeLessThan(0.01);
    expect(most.keyLegs).toBeLessThan(3);
    expect(most.legs).toBeLessThan(8);
    // The hips follow ours, without a jump from frame to frame.
    expect(most.hips).toBeLessThan(0.06);
    expect(most.jump).toBeLessThan(0.02);
  });
});

describe('the retargeter', () => {
  it('takes legs for the measure: height of the hips over the sole', async () => {
    const { retargeter, place, show, sole } = await stageAvatar(mixamoGlb());
    const still = { ...emptyMotion(1), root: Float32Array.of(0, REST_HEIGHT, 0) };
    show(still, 0);
    const { thigh, shin, ankleHeight } = LONG_LEGS;
    expect(place('left_hip').y).toBeCloseTo(thigh + shin + ankleHeight, 1.5);
    expect(sole('left')).toBeCloseTo(0, 6);
    expect(sole('right')).toBeCloseTo(0, 6);
    expect(retargeter.height).toBeGreaterThan(1.7);
    expect(retargeter.height).toBeLessThan(2.1);
    expect(retargeter.displayScale).toBe(1);
  });

  it('is the same for a body in centimetres, which it says how to show', async () => {
    const armature = { rotation: [0, 0, 0, 1], scale: 100 };
    // The same numbers as if the bones themselves were given in centimetres.
    const small = await stageAvatar(mixamoGlb());
    const scene = mixamoGlb({ armature: { ...armature, scale: 1 } });
    const same = await stageAvatar(scene);
    expect(same.retargeter.scale).toBeCloseTo(small.retargeter.scale, 5);
    const large = await stageAvatar(anonymousGlb({ ...LONG_LEGS, ...scaled(100) }));
    expect(large.retargeter.scale).toBeCloseTo(small.retargeter.scale * 100, 0);
    expect(large.retargeter.height * large.retargeter.displayScale).toBeGreaterThan(1.4);
    expect(large.retargeter.height * large.retargeter.displayScale).toBeLessThan(2);
  });

  it('looks the way we look, whichever way the file looks', async () => {
    for (const [, file] of AVATARS) {
      const { place, show } = await stageAvatar(file());
      show({ ...emptyMotion(1), root: Float32Array.of(0, REST_HEIGHT, 0) }, 0);
      expect(place('left_shoulder').x).toBeGreaterThan(place('right_shoulder').x);
      expect(place('left_foot').z).toBeGreaterThan(place('left_ankle').z);
    }
  });

  it('gives a frame by its pose alone, leaves the pose as it is, and is quick', async () => {
    const { retargeter } = await stageAvatar(vrm1File());
    const pose = frameView(motion, 60);
    const before = Array.from(pose.quaternions);
    const a = retargeter.frame(pose, retargeter.createFrame());
    const b = retargeter.createFrame();
    const start = performance.now();
    for (let t = 0; t < motion.frames; t++) retargeter.frame(frameView(motion, t), b);
    // A frame of the screen has 16 ms; this machine may be busy.
    expect((performance.now() - start) / motion.frames).toBeLessThan(2);
    retargeter.frame(pose, b);
    expect(b).toEqual(a);
    expect(Array.from(pose.quaternions)).toEqual(before);
  });

  it('keeps the feet above the floor and every number finite in the wildest poses', async () => {
    const stage = await stageAvatar(mixamoGlb());
    const wild = wildMotion(200, 5);
    for (let t = 0; t < wild.frames; t++) {
      const { rotations, hips } = stage.show(wild, t);
      expect([...rotations, ...hips].every(Number.isFinite)).toBe(true);
      for (let i = 0; i < rotations.length; i += 4)
        expect(Math.hypot(...rotations.subarray(i, i + 4))).toBeCloseTo(1, 5);
    }
  });

  it('makes do without a mesh, toes, collars, neck, wrists and most of the back', async () => {
    const stage = await stageAvatar(mixamoGlb({ bare: true }));
    const bones = [...stage.bones];
    for (const part of ['foot', 'collar', 'wrist']) for (const side of SIDES) bones[jointIndex(`${side}_${part}`)] = -1;
    for (const joint of ['neck', 'spine1', 'spine2', 'head']) bones[jointIndex(joint)] = -1;
    const retargeter = new AvatarRetargeter(stage.rig, bones);
    expect(retargeter.scale).toBeCloseTo(stage.retargeter.scale, 1);
    const frame = retargeter.frame(frameView(motion, 30), retargeter.createFrame());
    expect([...frame.rotations, ...frame.hips].every(Number.isFinite)).toBe(true);
  });

  it('refuses a mapping that is wrong', async () => {
    const { rig, bones } = await stageAvatar(mixamoGlb());
    const broken = [...bones];
    broken[jointIndex('left_knee')] = -1;
    expect(() => new AvatarRetargeter(rig, broken)).toThrow('Choose the bone for the left knee.');
  });
});

/** The long-legged body with all lengths times a factor. */
function scaled(factor: number): typeof LONG_LEGS {
  const plain = new Set(['backBones', 'armDrop']);
  return Object.fromEntries(
    Object.entries(LONG_LEGS).map(([name, value]) => [name, plain.has(name) ? value : value * factor]),
  ) as unknown as typeof LONG_LEGS;
}
