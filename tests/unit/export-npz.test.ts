import { unzipSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { looksLikeMotionJson, readMotionJson, writeMotionJson } from '../../web/core/formats/motion-json';
import { readNpy } from '../../web/core/formats/npy-read';
import { writeNpy } from '../../web/core/formats/npy-write';
import { readNpz } from '../../web/core/formats/npz-read';
import { smplArrays, writeNpz } from '../../web/core/formats/npz-write';
import { angleBetween, axisAngleToQuaternion } from '../../web/core/rotation';
import { JOINT_COUNT } from '../../web/core/skeleton';
import { farthest, jointsOf, wildMotion } from './support/wild-motion';

describe('npy', () => {
  it('comes back as it was, in any shape', () => {
    for (const [shape, data] of [
      [[2, 3], Float32Array.of(1, 2, 3, 4, 5.5, -6)],
      [[], Float64Array.of(29.97)],
      [[4], Float64Array.of(1, 2, 3, 1e300)],
      [[0, 3], new Float32Array(0)],
    ] as const) {
      const bytes = writeNpy({ shape, data });
      const back = readNpy(bytes, 'x');
      expect(back.shape).toEqual([...shape]);
      expect([...back.data]).toEqual([...data]);
      // NEP 1: what comes before the numbers is a multiple of 64 bytes long.
      expect((bytes.length - data.byteLength) % 64).toBe(0);
    }
    expect(() => writeNpy({ shape: [2], data: new Float32Array(3) })).toThrow('shape');
  });
});

describe('SMPL npz', () => {
  const motion = wildMotion(40, 3, 60);

  it('has both houses’ names and shapes', () => {
    const files = unzipSync(writeNpz(motion));
    expect(Object.keys(files).sort()).toEqual(
      ['smpl_poses', 'smpl_trans', 'smpl_scaling', 'poses', 'trans', 'betas', 'gender', 'mocap_framerate']
        .map((name) => `${name}.npy`)
        .sort(),
    );
    const shape = (name: string) => readNpy(files[`${name}.npy`], name).shape;
    expect(shape('smpl_poses')).toEqual([40, 72]);
    expect(shape('poses')).toEqual([40, 156]);
    expect(shape('trans')).toEqual([40, 3]);
    expect(readNpy(files['mocap_framerate.npy'], 'rate').data[0]).toBe(60);
  });

  it('is the same file for the same dance', () => {
    expect(writeNpz(motion)).toEqual(writeNpz(motion));
  });

  it('is read back by our own reader, frame rate and all', () => {
    const [clip] = readNpz(writeNpz(motion)).clips;
    expect(clip.fps).toBe(60);
    expect(clip.frames).toBe(40);
    for (let i = 0; i < 40 * JOINT_COUNT; i++) {
      const [a, b] = [clip, motion].map(({ quaternions }) => quaternions.subarray(i * 4, i * 4 + 4));
      expect(angleBetween(a, b)).toBeLessThan(2e-6);
    }
  });

  it('stands on Z for AMASS: a quarter turn of the world brings it back', () => {
    const { poses, trans } = smplArrays(motion) as Record<string, { data: Float32Array }>;
    const back = axisAngleToQuaternion([-Math.PI / 2, 0, 0]);
    for (const frame of [0, 20, 39]) {
      const turned = axisAngleToQuaternion(poses.data.subarray(frame * 156, frame * 156 + 3));
      const root = motion.quaternions.subarray(frame * 96, frame * 96 + 4);
      const [x, y, z, w] = back;
      const [a, b, c, d] = turned;
      const product = [
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
      ];
      expect(angleBetween(product, root)).toBeLessThan(2e-6);
      const [px, py, pz] = motion.root.subarray(frame * 3, frame * 3 + 3);
      expect([...trans.data.subarray(frame * 3, frame * 3 + 3)]).toEqual([px, 0 - pz, py]);
    }
    expect(poses.data.subarray(66, 156).every((value) => value === 0)).toBe(true);
  });
});

describe('dance JSON', () => {
  const motion = wildMotion(20, 9);
  const notes = {
    song: { name: 'Löwe “1”', start: 1.5, tempo: 120, beatsPerBar: 4 as const, beats: [0, 0.5], downbeats: [0] },
    keyPoses: [{ time: 0.5, name: 'arms up' }, { time: 1 }],
  };

  it('comes back as it was', () => {
    const text = writeMotionJson(motion, notes);
    expect(looksLikeMotionJson(text)).toBe(true);
    const back = readMotionJson(text);
    expect(back.song).toEqual(notes.song);
    expect(back.keyPoses).toEqual(notes.keyPoses);
    expect(back.motion.fps).toBe(30);
    for (let frame = 0; frame < 20; frame++) {
      expect(farthest(jointsOf(back.motion, frame), jointsOf(motion, frame))).toBeLessThan(1e-4);
    }
  });

  it('is plain JSON with a row per frame', () => {
    const raw = JSON.parse(writeMotionJson(motion)) as { root: number[][]; rotations: number[][]; joints: string[] };
    expect(raw.root).toHaveLength(20);
    expect(raw.rotations[0]).toHaveLength(96);
    expect(raw.joints).toHaveLength(24);
  });

  it('says what is wrong', () => {
    const edit = (change: (raw: Record<string, unknown>) => void) => {
      const raw = JSON.parse(writeMotionJson(motion, notes)) as Record<string, unknown>;
      change(raw);
      return () => readMotionJson(JSON.stringify(raw));
    };
    expect(() => readMotionJson('{')).toThrow('damaged');
    expect(edit((raw) => (raw.version = 2))).toThrow('newer');
    expect(edit((raw) => (raw.frames = 21))).toThrow('21 frames');
    expect(edit((raw) => (raw.joints as string[]).reverse())).toThrow('another skeleton');
    expect(edit((raw) => ((raw.rotations as unknown[][])[3][5] = null))).toThrow('rotations.3');
    expect(edit((raw) => (raw.fps = 0))).toThrow('fps');
    expect(edit((raw) => (raw.format = 'other'))).toThrow('format');
  });
});
