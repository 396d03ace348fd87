import { strToU8, zipSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { readBvh } from '../../web/core/formats/bvh-read';
import { mapHumanoid, plainName } from '../../web/core/formats/humanoid';
import { readNpz } from '../../web/core/formats/npz-read';
import { poseOfFrame, suggestFrames, type PoseSequence } from '../../web/core/formats/pose-sequence';
import { axisAngleToQuaternion, multiply, poseToQuaternions, rotateVector } from '../../web/core/rotation';
import { forwardKinematics, JOINTS, jointIndex, worldRotations } from '../../web/core/skeleton';
import { bvhText, npy, OWN_RIG, rigWorld, strangerRig, turnedRig, wildPose, type RigJoint } from './support/rigs';

const STILL = (rig: readonly RigJoint[]) => rig.map(() => [0, 0, 0, 1]);
const unit = (v: readonly number[]) => v.map((value) => value / Math.hypot(...v));
const between = (p: ArrayLike<number>, a: number, b: number) => unit([0, 1, 2].map((k) => p[b * 3 + k] - p[a * 3 + k]));
const expectClose = (a: readonly number[], b: readonly number[], digits = 5) =>
  a.forEach((value, i) => expect(value).toBeCloseTo(b[i], digits));

/** Bones of arms and legs: their joints in our skeleton. */
const BONES = ['left', 'right'].flatMap((side) =>
  [
    ['shoulder', 'elbow'],
    ['elbow', 'wrist'],
    ['hip', 'knee'],
    ['knee', 'ankle'],
  ].map((ends) => ends.map((end) => jointIndex(`${side}_${end}`)) as [number, number]),
);

/** Checks that every limb of a pose points where the source's does, and that the middle of the body is turned like the source's. */
function expectSamePose(
  rig: readonly RigJoint[],
  local: readonly (readonly number[])[],
  pose: readonly number[],
  turn = [0, 0, 0, 1],
) {
  const map = mapHumanoid({ names: rig.map(({ name }) => name), parents: rig.map(({ parent }) => parent) });
  const theirs = rigWorld(rig, local);
  const quaternions = poseToQuaternions(pose);
  const ours = forwardKinematics(quaternions, [0, 0, 0]);
  for (const [a, b] of BONES) {
    const [p, q] = [theirs.positions[map[a]], theirs.positions[map[b]]];
    expectClose(between(ours, a, b), rotateVector<number[]>(turn, unit(q.map((value, k) => value - p[k]))), 4);
  }
  return { map, theirs, world: worldRotations(quaternions) };
}

describe('names of joints', () => {
  it.each([
    ['mixamorig:LeftUpLeg', 'left', 'upleg'],
    ['mixamorigRightHandMiddle1', 'right', 'handmiddle1'],
    ['upper_arm.L', 'left', 'upperarm'],
    ['upper_armR', 'right', 'upperarm'],
    ['Bip01 R Calf', 'right', 'calf'],
    ['lShldr', 'left', 'shldr'],
    ['J_Bip_L_UpperArm', 'left', 'upperarm'],
    ['clavicle_r', 'right', 'clavicle'],
    ['left_hip', 'left', 'hip'],
    ['LHipJoint', 'left', 'hip'],
    ['spine_01', null, 'spine01'],
    ['Hips', null, 'hips'],
    ['Collar', null, 'collar'],
  ])('%s is read', (name, side, stem) => expect(plainName(name)).toEqual({ side, stem }));

  it('tells our own names, Mixamo’s, CMU’s and Unreal’s', () => {
    expect(mapHumanoid({ names: JOINTS, parents: OWN_RIG.map(({ parent }) => parent) })).toEqual(
      JOINTS.map((_, i) => i),
    );
    for (const naming of ['mixamo', 'cmu', 'unreal'] as const) {
      const rig = strangerRig(naming);
      const map = mapHumanoid({ names: rig.map(({ name }) => name), parents: rig.map(({ parent }) => parent) });
      const missing = JOINTS.filter((_, joint) => map[joint] < 0);
      expect(missing).toEqual(['left_hand', 'right_hand']);
      expect(new Set(map.filter((joint) => joint >= 0)).size).toBe(22);
    }
  });
  it('says what is missing of what is no body', () => {
    expect(() => mapHumanoid({ names: ['Hips', 'Tail'], parents: [-1, 0] })).toThrow(
      /left hip, left knee, left shoulder/,
    );
  });
});

describe('BVH files', () => {
  it('give the very rotations when the skeleton is ours', () => {
    const local = STILL(OWN_RIG);
    local[jointIndex('left_elbow')] = axisAngleToQuaternion([0, -Math.PI / 2, 0]);
    local[jointIndex('right_hip')] = axisAngleToQuaternion([-0.6, 0.2, 0.1]);
    local[0] = axisAngleToQuaternion([0, 1, 0]);
    const { kind, clips } = readBvh(bvhText(OWN_RIG, [STILL(OWN_RIG), local], 1 / 120));
    expect(kind).toBe('BVH');
    expect(clips[0]).toMatchObject({ frames: 2 });
    expect(clips[0].fps).toBeCloseTo(120, 6);
    expectClose(poseOfFrame(clips[0], 0), new Array<number>(72).fill(0));
    const wanted = new Array<number>(72).fill(0);
    wanted[1] = 1;
    wanted[jointIndex('left_elbow') * 3 + 1] = -Math.PI / 2;
    [-0.6, 0.2, 0.1].forEach((value, k) => (wanted[jointIndex('right_hip') * 3 + k] = value));
    expectClose(poseOfFrame(clips[0], 1), wanted);
  });

  it.each(['mixamo', 'cmu', 'unreal'] as const)(
    'of another body in an A-pose, named by %s, keep where its limbs point',
    (naming) => {
      const rig = strangerRig(naming);
      const frames = [STILL(rig), wildPose(rig, 1), wildPose(rig, 2), wildPose(rig, 3)];
      const [clip] = readBvh(bvhText(rig, frames)).clips;
      frames.forEach((local, frame) => {
        const { map, theirs, world } = expectSamePose(rig, local, poseOfFrame(clip, frame));
        for (const name of ['pelvis', 'spine1', 'spine2', 'spine3', 'neck', 'head', 'left_collar', 'right_foot']) {
          const joint = jointIndex(name);
          const same = Math.abs(
            multiplyDot(theirs.rotations[map[joint]], Array.from(world.slice(joint * 4, joint * 4 + 4))),
          );
          expect(same, name).toBeCloseTo(1, 6);
        }
      });
    },
  );

  it('stand upright when Z is up, and face where they faced', () => {
    const up = axisAngleToQuaternion([Math.PI / 2, 0, 0]);
    const rig = turnedRig(strangerRig('cmu'), up);
    const frames = [STILL(rig), wildPose(rig, 4)];
    const [clip] = readBvh(bvhText(rig, frames)).clips;
    const back = axisAngleToQuaternion([-Math.PI / 2, 0, 0]);
    frames.forEach((local, frame) => expectSamePose(rig, local, poseOfFrame(clip, frame), back));
    // Their -Y, where the face was, is our +Z.
    expectClose(poseOfFrame(clip, 0).slice(0, 3), [0, 0, 0]);
  });

  it('keep a rest pose that faces elsewhere', () => {
    const aside = axisAngleToQuaternion([0, Math.PI / 2, 0]);
    const rig = turnedRig(strangerRig('mixamo'), aside);
    const [clip] = readBvh(bvhText(rig, [STILL(rig), wildPose(rig, 5)])).clips;
    expectClose(poseOfFrame(clip, 0).slice(0, 3), [0, Math.PI / 2, 0]);
    expectSamePose(rig, wildPose(rig, 5), poseOfFrame(clip, 1));
  });

  it('do not stand up a body that lies in a world where Y is up', () => {
    const local = STILL(OWN_RIG);
    local[0] = axisAngleToQuaternion([Math.PI / 2, 0, 0]);
    const [clip] = readBvh(bvhText(OWN_RIG, [local, local])).clips;
    expectClose(poseOfFrame(clip, 0).slice(0, 3), [Math.PI / 2, 0, 0]);
  });

  const good = bvhText(OWN_RIG, [STILL(OWN_RIG), STILL(OWN_RIG)]);
  it.each([
    ['nothing', '', /does not begin with HIERARCHY/],
    ['another text', 'hello', /does not begin with HIERARCHY/],
    ['joints cut off', good.slice(0, 700), /damaged or cut off/],
    ['motion cut off', good.slice(0, -300), /values instead of|ends after/],
    ['more frames than lines', good.replace('Frames: 2', 'Frames: 2000000000'), /cut off/],
    ['no frames', good.replace('Frames: 2', 'Frames: 0'), /no frames/],
    ['NaN', good.replace(/\n0 0 0 /, '\n0 NaN 0 '), /should hold numbers/],
    ['Infinity', good.replace(/\n0 0 0 /, '\n0 1e999 0 '), /should hold numbers/],
    ['no time', good.replace(/Frame Time: \S+/, 'Frame Time: x'), /should hold numbers/],
    ['channels that are none', good.replace('CHANNELS 3', 'CHANNELS 300'), /damaged/],
    ['too deep', `HIERARCHY\n${'ROOT a\n{\n'.repeat(500)}`, /more joints/],
    ['no body', good.replace(/left_knee/, 'thing'), /left knee/],
  ])('with %s say so', (_, text, message) => expect(() => readBvh(text)).toThrow(message));

  it('survive any cut and any wrong byte with a sentence', () => {
    for (let i = 0; i < 200; i++) {
      const at = Math.floor((i / 200) * good.length);
      for (const text of [good.slice(0, at), `${good.slice(0, at)}\u0000${good.slice(at + 3)}`]) {
        try {
          expect(readBvh(text).clips[0].quaternions.every(Number.isFinite)).toBe(true);
        } catch (error) {
          expect((error as Error).message).toMatch(/\.$/);
        }
      }
    }
  });
});

function multiplyDot(a: readonly number[], b: readonly number[]): number {
  return a.reduce((sum, value, i) => sum + value * b[i], 0);
}

describe('npz files', () => {
  const frame = (seed: number, joints: number) =>
    Array.from({ length: joints * 3 }, (_, i) => Math.sin(seed * 3.7 + i * 1.3) * (i < 3 ? 0.2 : 0.5));
  const zip = (parts: Record<string, Uint8Array>) =>
    zipSync(Object.fromEntries(Object.entries(parts).map(([name, bytes]) => [`${name}.npy`, bytes])));

  it('of AIST++ give the very rotations, in every number type and order', () => {
    const frames = [frame(1, 24), frame(2, 24), frame(3, 24)];
    const rows = frames.flat();
    const columns = Array.from({ length: 72 }, (_, i) => frames.map((each) => each[i])).flat();
    for (const bytes of [
      npy(rows, [3, 72]),
      npy(rows, [3, 72], { type: '<f4' }),
      npy(rows, [3, 72], { type: '>f4' }),
      npy(columns, [3, 72], { fortran: true }),
      npy(rows, [3, 24, 3]),
    ]) {
      const { kind, clips } = readNpz(
        zip({ smpl_poses: bytes, smpl_trans: npy(new Array<number>(9).fill(0), [3, 3]) }),
      );
      expect(kind).toBe('SMPL');
      expect(clips[0]).toMatchObject({ frames: 3, fps: 60 });
      frames.forEach((wanted, i) => expectClose(poseOfFrame(clips[0], i), wanted));
    }
  });

  it.each([156, 165])('of AMASS with %i numbers stand upright, hands left out', (width) => {
    const body = frame(4, width / 3);
    // Z up: the body stands by a quarter turn about X before its own turn.
    const upright = multiply(axisAngleToQuaternion([Math.PI / 2, 0, 0]), axisAngleToQuaternion(body.slice(0, 3)));
    const half = Math.acos(upright[3]);
    const root = upright.slice(0, 3).map((value) => (value / Math.sin(half)) * 2 * half);
    const values = [...root, ...body.slice(3)];
    const file = zip({
      poses: npy([...values, ...values], [2, width]),
      trans: npy(new Array<number>(6).fill(0), [2, 3]),
      mocap_framerate: npy([120], [], { type: '<i8' }),
    });
    const [clip] = readNpz(file).clips;
    expect(clip).toMatchObject({ fps: 120, frames: 2 });
    expectClose(poseOfFrame(clip, 1), [...body.slice(0, 66), 0, 0, 0, 0, 0, 0]);
  });

  it.each<[string, Uint8Array, RegExp]>([
    ['nothing', new Uint8Array(0), /no npz file/],
    ['a text', strToU8('hello there'), /no npz file/],
    ['other arrays', zip({ markers: npy([1], [1]) }), /found: markers/],
    ['the wrong shape', zip({ poses: npy(frame(1, 10), [1, 30]) }), /1 x 30/],
    ['no frames', zip({ poses: npy([], [0, 72]) }), /no frames/],
    ['NaN', zip({ poses: npy([...frame(1, 24).slice(1), NaN], [1, 72]) }), /not finite/],
    ['a huge count', zip({ poses: npy(frame(1, 24), [1e9, 72]) }), /too long/],
    ['fewer numbers than it says', zip({ poses: npy(frame(1, 24), [7, 72]) }), /cut off/],
    ['objects inside', zip({ poses: npy([1], [1], { type: '|O' as '<f8' }) }), /no plain numbers/],
    ['no array inside', zip({ poses: strToU8('not numpy at all') }), /damaged/],
    ['a rate of nothing', zip({ poses: npy(frame(1, 24), [1, 72]), mocap_framerate: npy([0], []) }), /make no sense/],
  ])('with %s say so', (_, bytes, message) => expect(() => readNpz(bytes)).toThrow(message));

  it('survive any cut and any wrong byte with a sentence', () => {
    const good = zip({ poses: npy(frame(1, 24), [1, 72]) });
    for (let i = 0; i < good.length; i += 3) {
      const changed = good.slice();
      changed[i] ^= 0xff;
      for (const bytes of [good.slice(0, i), changed]) {
        try {
          expect(readNpz(bytes).clips[0].quaternions.every(Number.isFinite)).toBe(true);
        } catch (error) {
          expect((error as Error).message).toMatch(/\.$/);
        }
      }
    }
  });
});

describe('suggested frames', () => {
  /** Arms swing between two holds, `hold` frames still at the end of each swing. */
  const swinging = (frames: number, period: number): PoseSequence => {
    const quaternions = new Float32Array(frames * 96);
    for (let t = 0; t < frames; t++) {
      const pose = new Array<number>(72).fill(0);
      pose[jointIndex('left_shoulder') * 3 + 2] = Math.cos((t / period) * Math.PI);
      quaternions.set(poseToQuaternions(pose), t * 96);
    }
    return { name: '', fps: 30, frames, quaternions };
  };
  it('are where the body is held', () => {
    const frames = suggestFrames(swinging(151, 30), 4);
    expect(frames).toHaveLength(4);
    for (const at of frames) expect(Math.min(at % 30, 30 - (at % 30))).toBeLessThanOrEqual(3);
  });
  it('are all of few, and spread over what never rests', () => {
    expect(suggestFrames(swinging(3, 30), 6)).toEqual([0, 1, 2]);
    const spread = suggestFrames({ ...swinging(300, 1e9) }, 6);
    expect(spread.length).toBeGreaterThanOrEqual(4);
    expect(spread).toEqual([...spread].sort((a, b) => a - b));
  });
});
