import { describe, expect, it } from 'vitest';
import { readGltf } from '../../web/core/formats/gltf-read';
import { mapHumanoid } from '../../web/core/formats/humanoid';
import { poseOfFrame } from '../../web/core/formats/pose-sequence';
import { axisAngleToQuaternion, conjugate, multiply, poseToQuaternions, rotateVector } from '../../web/core/rotation';
import { forwardKinematics, jointIndex } from '../../web/core/skeleton';
import { OWN_RIG, rigWorld, strangerRig, wildPose, type RigJoint } from './support/rigs';

type Quaternions = readonly (readonly number[])[];
interface Options {
  /** Times of the keys, seconds, and the local rotations at each. */
  keys?: { times: number[]; poses: Quaternions[]; mode?: 'LINEAR' | 'STEP' | 'CUBICSPLINE' };
  /** Rotations that the nodes stand in. */
  posed?: Quaternions;
  /** With a skin bound in the rest pose. */
  skin?: boolean;
  /** A node above the figure, as exporters put one to turn the axes. */
  above?: { rotation: number[]; scale: number };
  extensions?: Record<string, unknown>;
  /** Changes the JSON at the end. */
  edit?: (json: Record<string, unknown>) => void;
}

/** A GLB file by hand (glTF 2.0 specification, chapter 4): a JSON chunk and a binary chunk. */
function glb(rig: readonly RigJoint[], options: Options = {}): Uint8Array {
  const numbers: number[] = [];
  const accessors: object[] = [];
  const bufferViews: object[] = [];
  const store = (values: readonly number[], type: 'SCALAR' | 'VEC4' | 'MAT4', width: number): number => {
    bufferViews.push({ buffer: 0, byteOffset: numbers.length * 4, byteLength: values.length * 4 });
    numbers.push(...values);
    return (
      accessors.push({ bufferView: bufferViews.length - 1, componentType: 5126, count: values.length / width, type }) -
      1
    );
  };
  const rest = rig.map(() => [0, 0, 0, 1]);
  const posed = options.posed ?? rest;
  const nodes: Record<string, unknown>[] = rig.map(({ name, offset }, i) => {
    const children = [...rig.keys()].filter((each) => rig[each].parent === i);
    return { name, translation: offset, rotation: posed[i], ...(children.length ? { children } : {}) };
  });
  if (options.above) {
    const { rotation, scale } = options.above;
    nodes.push({ name: 'Armature', children: [0], rotation, scale: [scale, scale, scale] });
  }
  const json: Record<string, unknown> = { asset: { version: '2.0' }, nodes, accessors, bufferViews };
  if (options.skin) {
    const { positions } = rigWorld(rig, rest);
    const inverse = positions.flatMap(([x, y, z]) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1]);
    json.skins = [{ joints: [...rig.keys()], inverseBindMatrices: store(inverse, 'MAT4', 16) }];
  }
  if (options.keys) {
    const { times, poses, mode = 'LINEAR' } = options.keys;
    const input = store(times, 'SCALAR', 1);
    const samplers = rig.map((_, joint) => {
      const flat = [0, 0, 0, 0];
      const values = poses.flatMap((pose) =>
        mode === 'CUBICSPLINE' ? [...flat, ...pose[joint], ...flat] : [...pose[joint]],
      );
      return { input, output: store(values, 'VEC4', 4), interpolation: mode };
    });
    const channels = rig.map((_, joint) => ({ sampler: joint, target: { node: joint, path: 'rotation' } }));
    json.animations = [{ name: 'Dance', samplers, channels }];
  }
  if (options.extensions) json.extensions = options.extensions;
  json.buffers = [{ byteLength: numbers.length * 4 }];
  options.edit?.(json);
  const text = new TextEncoder().encode(JSON.stringify(json));
  const padded = Math.ceil(text.length / 4) * 4;
  const bytes = new Uint8Array(12 + 8 + padded + 8 + numbers.length * 4);
  const view = new DataView(bytes.buffer);
  [0x46546c67, 2, bytes.length, padded, 0x4e4f534a].forEach((word, i) => view.setUint32(i * 4, word, true));
  bytes.fill(0x20, 20, 20 + padded);
  bytes.set(text, 20);
  view.setUint32(20 + padded, numbers.length * 4, true);
  view.setUint32(24 + padded, 0x004e4942, true);
  numbers.forEach((value, i) => view.setFloat32(28 + padded + i * 4, value, true));
  return bytes;
}

const unit = (v: readonly number[]) => v.map((value) => value / Math.hypot(...v));
const close = (a: readonly number[], b: readonly number[], digits = 4) =>
  a.forEach((value, i) => expect(value).toBeCloseTo(b[i], digits));

/** Checks that the limbs of a pose point where the source's do. */
function expectSameLimbs(rig: readonly RigJoint[], local: Quaternions, pose: readonly number[], turn = [0, 0, 0, 1]) {
  const map = mapHumanoid({ names: rig.map(({ name }) => name), parents: rig.map(({ parent }) => parent) });
  const theirs = rigWorld(rig, local).positions;
  const ours = forwardKinematics(poseToQuaternions(pose), [0, 0, 0]);
  for (const side of ['left', 'right'])
    for (const [from, to] of [
      ['shoulder', 'elbow'],
      ['elbow', 'wrist'],
      ['hip', 'knee'],
      ['knee', 'ankle'],
    ]) {
      const [a, b] = [jointIndex(`${side}_${from}`), jointIndex(`${side}_${to}`)];
      close(
        unit([0, 1, 2].map((k) => ours[b * 3 + k] - ours[a * 3 + k])),
        rotateVector<number[]>(turn, unit(theirs[map[b]].map((value, k) => value - theirs[map[a]][k]))),
      );
    }
}

const rig = strangerRig('mixamo');
const still = rig.map(() => [0, 0, 0, 1]);
const [one, two] = [wildPose(rig, 11), wildPose(rig, 12)];

describe('glTF files', () => {
  it('give the very rotations when the skeleton is ours, at 60 frames a second', () => {
    const own = OWN_RIG.map(() => [0, 0, 0, 1]);
    const bent = [...own];
    bent[jointIndex('right_knee')] = axisAngleToQuaternion([1.2, 0, 0]);
    const { kind, clips } = readGltf(glb(OWN_RIG, { keys: { times: [0, 1], poses: [own, bent] } }));
    expect(kind).toBe('glTF');
    expect(clips).toHaveLength(1);
    const [clip] = clips;
    expect(clip.name).toBe('Dance');
    expect(clip.frames).toBe(Math.round(clip.fps) + 1);
    const knee = jointIndex('right_knee') * 3;
    for (const frame of [0, (clip.frames - 1) / 2, clip.frames - 1]) {
      const pose = poseOfFrame(clip, frame);
      expect(pose[knee]).toBeCloseTo((1.2 * frame) / (clip.frames - 1), 5);
      expect(Math.hypot(...pose.filter((_, i) => i !== knee))).toBeLessThan(1e-5);
    }
  });

  it('of another body keep where its limbs point', () => {
    const [clip] = readGltf(glb(rig, { keys: { times: [0.5, 1.5], poses: [one, two] } })).clips;
    expectSameLimbs(rig, one, poseOfFrame(clip, 0));
    expectSameLimbs(rig, two, poseOfFrame(clip, clip.frames - 1));
  });

  it('without an animation give the pose in which the figure stands, against the pose it was bound in', () => {
    const { clips } = readGltf(glb(rig, { posed: one, skin: true }));
    expect(clips).toHaveLength(1);
    expect(clips[0]).toMatchObject({ frames: 1, fps: 0 });
    expectSameLimbs(rig, one, poseOfFrame(clips[0], 0));
  });

  it('are turned by a node above the figure', () => {
    const rotation = axisAngleToQuaternion([0, Math.PI / 3, 0]);
    const bytes = glb(rig, { posed: one, skin: true, above: { rotation, scale: 0.01 } });
    expectSameLimbs(rig, one, poseOfFrame(readGltf(bytes).clips[0], 0), rotation);
  });

  it('with a Z-up skeleton under a node that turns it stand upright', () => {
    const up = axisAngleToQuaternion([Math.PI / 2, 0, 0]);
    const zUp = rig.map((joint) => ({
      ...joint,
      offset: rotateVector(up, joint.offset) as unknown as RigJoint['offset'],
    }));
    const back = conjugate(up);
    const bytes = glb(zUp, {
      keys: { times: [0, 1], poses: [still, two] },
      skin: true,
      above: { rotation: back, scale: 1 },
    });
    const [clip] = readGltf(bytes).clips;
    close(poseOfFrame(clip, 0).slice(0, 3), [0, 0, 0]);
    expectSameLimbs(zUp, two, poseOfFrame(clip, clip.frames - 1), back);
  });

  it('hold steps and follow cubic splines', () => {
    const [step] = readGltf(glb(rig, { keys: { times: [0, 1], poses: [one, two], mode: 'STEP' } })).clips;
    expectSameLimbs(rig, one, poseOfFrame(step, step.frames - 2));
    expectSameLimbs(rig, two, poseOfFrame(step, step.frames - 1));
    const [cubic] = readGltf(glb(rig, { keys: { times: [0, 1], poses: [one, two], mode: 'CUBICSPLINE' } })).clips;
    expectSameLimbs(rig, two, poseOfFrame(cubic, cubic.frames - 1));
    // Flat tangents: in the middle the spline is half way, as the straight line is.
    const middle = rig.map((_, i) => {
      const sum = one[i].map((value, k) => value + two[i][k] * Math.sign(one[i][3] * two[i][3]));
      return unit(sum);
    });
    expectSameLimbs(rig, middle, poseOfFrame(cubic, (cubic.frames - 1) / 2));
  });
});

describe('VRM files', () => {
  const bones: Record<string, string> = {
    hips: 'mixamorig:Hips',
    spine: 'mixamorig:Spine',
    chest: 'mixamorig:Spine1',
    upperChest: 'mixamorig:Spine2',
    neck: 'mixamorig:Neck',
    head: 'mixamorig:Head',
  };
  for (const side of ['Left', 'Right'])
    for (const [bone, name] of [
      ['Shoulder', 'Shoulder'],
      ['UpperArm', 'Arm'],
      ['LowerArm', 'ForeArm'],
      ['Hand', 'Hand'],
      ['UpperLeg', 'UpLeg'],
      ['LowerLeg', 'Leg'],
      ['Foot', 'Foot'],
      ['Toes', 'ToeBase'],
    ])
      bones[side.toLowerCase() + bone] = `mixamorig:${side}${name}`;
  const node = (bone: string) => rig.findIndex(({ name }) => name === bones[bone]);
  // The nodes' own names say nothing: the humanoid does.
  const anonymous = rig.map((joint, i) => ({ ...joint, name: `J${i}` }));

  it('of version 1 are told by their humanoid', () => {
    const humanBones = Object.fromEntries(Object.keys(bones).map((bone) => [bone, { node: node(bone) }]));
    const extensions = { VRMC_vrm: { specVersion: '1.0', humanoid: { humanBones } } };
    const { kind, clips } = readGltf(glb(anonymous, { extensions, posed: two }));
    expect(kind).toBe('VRM');
    expectSameLimbs(rig, two, poseOfFrame(clips[0], 0));
  });

  it('with an animation alone (.vrma) are told by their humanoid too, and come back whole', () => {
    const humanBones = Object.fromEntries(Object.keys(bones).map((bone) => [bone, { node: node(bone) }]));
    const extensions = { VRMC_vrm_animation: { specVersion: '1.0', humanoid: { humanBones } } };
    const keys = { times: [0, 0.5, 2], poses: [still, one, two] };
    const { kind, clips } = readGltf(glb(anonymous, { extensions, keys }));
    const [clip] = clips;
    expect(kind).toBe('VRM');
    expect((clip.frames - 1) / clip.fps).toBeCloseTo(2, 5);
    expectSameLimbs(rig, one, poseOfFrame(clip, Math.round(0.5 * clip.fps)));
    expectSameLimbs(rig, two, poseOfFrame(clip, clip.frames - 1));
  });

  it('of version 0 look ahead although their space looks back', () => {
    const about = axisAngleToQuaternion([0, Math.PI, 0]);
    const backward = anonymous.map((joint) => ({
      ...joint,
      offset: rotateVector(about, joint.offset) as unknown as RigJoint['offset'],
    }));
    const humanBones = Object.keys(bones).map((bone) => ({ bone, node: node(bone) }));
    const keys = { times: [0, 1], poses: [still, one] };
    const { clips } = readGltf(glb(backward, { extensions: { VRM: { humanoid: { humanBones } } }, keys }));
    close(poseOfFrame(clips[0], 0).slice(0, 3), [0, 0, 0]);
    const named = backward.map((joint, i) => ({ ...joint, name: rig[i].name }));
    expectSameLimbs(named, one, poseOfFrame(clips[0], clips[0].frames - 1), multiply(about, [0, 0, 0, 1]));
  });
});

describe('wrong glTF files', () => {
  const keys = { times: [0, 1], poses: [one, two] };
  const edited = (edit: Options['edit']) => glb(rig, { keys, skin: true, edit });
  type Json = Record<string, never>;
  it.each<[string, Uint8Array, RegExp]>([
    ['nothing', new Uint8Array(0), /damaged/],
    ['a text', new TextEncoder().encode('hello'), /damaged/],
    ['another JSON', new TextEncoder().encode('{"a":1}'), /damaged/],
    ['an old version', edited((json) => (json.asset = { version: '1.0' })), /glTF 1.0/],
    ['no body', glb([{ name: 'Cube', parent: -1, offset: [0, 0, 0] }]), /not one that Posebeat can read/],
    [
      'a node that is its own child',
      edited((json) => ((json as Json).nodes[0] = { children: [0] } as never)),
      /no tree/,
    ],
    ['a child that is nowhere', edited((json) => ((json as Json).nodes[3] = { children: [9999] } as never)), /no tree/],
    ['a huge accessor', edited((json) => ((json.accessors as { count: number }[])[1].count = 4e9)), /damaged/],
    [
      'a view outside',
      edited((json) => ((json.bufferViews as { byteOffset: number }[])[1].byteOffset = 1e9)),
      /damaged/,
    ],
    [
      'numbers in a second file',
      edited((json) => ((json.buffers as { uri: string }[])[0].uri = 'https://a.b/c.bin')),
      /second file/,
    ],
    [
      'compressed numbers',
      edited(
        (json) => ((json.bufferViews as { extensions: object }[])[1].extensions = { EXT_meshopt_compression: {} }),
      ),
      /without compression/,
    ],
    ['NaN', glb(rig, { keys: { times: [0, 1], poses: [one, two.map(() => [NaN, 0, 0, 1])] } }), /damaged/],
    ['cut off', edited(undefined).slice(0, 3000), /damaged/],
  ])('with %s say so', (_, bytes, message) => expect(() => readGltf(bytes)).toThrow(message));

  it('survive any wrong byte with a sentence', () => {
    const good = edited(undefined);
    for (let i = 0; i < good.length; i += 41) {
      const changed = good.slice();
      changed[i] ^= 0xff;
      try {
        for (const clip of readGltf(changed).clips) expect(clip.quaternions.every(Number.isFinite)).toBe(true);
      } catch (error) {
        expect((error as Error).message).toMatch(/\.$/);
      }
    }
  });
});
