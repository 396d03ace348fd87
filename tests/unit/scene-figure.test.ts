import { readFileSync } from 'node:fs';
import { gunzipSync } from 'node:zlib';
import { beforeAll, describe, expect, it } from 'vitest';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../../web/core/skeleton';
import { multiply, poseToQuaternions, rotateVector } from '../../web/core/rotation';
import { spec } from '../../web/core/spec';
import { figureParts } from '../../web/scene/bake/body';
import { weightsAt } from '../../web/scene/bake/weights';
import { buildFigure } from '../../web/scene/figure-asset';
import {
  decodeFigure,
  decodeLevels,
  encodeLevels,
  mirrorFigure,
  PARTS,
  type HalfFigure,
} from '../../web/scene/figure-file';
import { REST, REST_HEIGHT } from '../../web/scene/rest';
import { MIRRORED_BONES, SKIN_BONES, skinBone, SkinPose, twistAngle } from '../../web/scene/skin-bones';

const bytes = gunzipSync(readFileSync(new URL('../../web/scene/figure.bin', import.meta.url)));
let half: HalfFigure;
let coarse: HalfFigure;
let whole: HalfFigure;
beforeAll(() => {
  [half, coarse] = decodeLevels(bytes);
  whole = mirrorFigure(half);
});

/** Repeatable numbers in -1..1. */
function noise(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 31 - 1;
  };
}

function randomPose(seed: number): Float32Array {
  const random = noise(seed);
  return poseToQuaternions(Array.from({ length: JOINT_COUNT * 3 }, () => random() * 1.2));
}

describe('rest pose', () => {
  it('is the skeleton of the spec, standing with its toe joints at their height', () => {
    expect(REST_HEIGHT).toBeCloseTo(0.955, 6);
    spec.skeleton.offsets.forEach((offset, joint) => {
      const parent = spec.skeleton.parents[joint];
      for (let i = 0; i < 3; i++) {
        const from = parent < 0 ? [0, REST_HEIGHT, 0][i] : REST[parent * 3 + i];
        expect(REST[joint * 3 + i]).toBeCloseTo(from + offset[i], 6);
      }
    });
    expect(REST[jointIndex('left_foot') * 3 + 1]).toBeCloseTo(spec.skeleton.toeHeight, 6);
  });

  it('leaves the skin where it is', () => {
    const pose = new SkinPose();
    pose.set(poseToQuaternions(new Array(72).fill(0)), [0, REST_HEIGHT, 0]);
    const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    SKIN_BONES.forEach((_, bone) =>
      identity.forEach((value, i) => expect(pose.matrices[bone * 16 + i]).toBeCloseTo(value, 6)),
    );
  });
});

describe('figure.bin', () => {
  it('was baked from the body as it is described now', () => {
    // A stale file has vertices off the surface, or weights that the rules no longer give.
    const parts = figureParts();
    let checked = 0;
    for (let v = 0; v < half.parts.length; v += 61) {
      const [x, y, z] = half.positions.subarray(v * 3, v * 3 + 3);
      const part = parts.find(({ name }) => name === PARTS[half.parts[v]])!;
      expect(Math.abs(part.shape(x, y, z)), `${part.name} at ${x} ${y} ${z}`).toBeLessThan(0.003);
      const expected = new Map(weightsAt(part.name, x, y, z));
      for (let slot = 0; slot < 4; slot++) {
        const weight = half.weights[v * 4 + slot];
        if (weight > 0) expect(Math.abs(weight - (expected.get(half.bones[v * 4 + slot]) ?? 0))).toBeLessThan(0.02);
      }
      checked++;
    }
    expect(checked).toBeGreaterThan(150);
  });

  it('stands on the floor and reaches as far as a person', () => {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    whole.positions.forEach((value, i) => {
      low[i % 3] = Math.min(low[i % 3], value);
      high[i % 3] = Math.max(high[i % 3], value);
    });
    expect(Math.abs(low[1])).toBeLessThan(0.001);
    expect(high[1]).toBeGreaterThan(1.7);
    expect(high[1]).toBeLessThan(1.8);
    expect(high[0]).toBeCloseTo(-low[0], 6);
    expect(high[0]).toBeGreaterThan(0.85);
  });

  it('has smooth weights: at most four bones, adding up to 1, left ones mirrored to the right', () => {
    let worst = 0;
    for (let v = 0; v < whole.parts.length; v++) {
      const row = whole.weights.subarray(v * 4, v * 4 + 4);
      worst = Math.max(worst, Math.abs(row[0] + row[1] + row[2] + row[3] - 1));
    }
    expect(worst).toBeLessThan(1e-6);
    expect(whole.weights.every((weight) => weight >= 0)).toBe(true);
    expect(whole.bones.every((bone) => bone < SKIN_BONES.length)).toBe(true);
    const n = half.parts.length;
    let image = n;
    for (let v = 0; v < n && image < whole.parts.length; v++) {
      if (whole.positions[v * 3] !== -whole.positions[image * 3]) continue;
      if (whole.bones[image * 4] === MIRRORED_BONES[whole.bones[v * 4]]) image++;
    }
    expect(image).toBe(whole.parts.length);
  });

  it('is closed: every edge belongs to exactly two triangles', () => {
    const edges = new Map<number, number>();
    const n = whole.parts.length;
    for (let t = 0; t < whole.triangles.length; t += 3)
      for (let i = 0; i < 3; i++) {
        const [a, b] = [whole.triangles[t + i], whole.triangles[t + ((i + 1) % 3)]];
        edges.set(a * n + b, (edges.get(a * n + b) ?? 0) + 1);
      }
    let open = 0;
    for (const [key, count] of edges) {
      const reverse = (key % n) * n + Math.floor(key / n);
      if (count !== 1 || edges.get(reverse) !== 1) open++;
    }
    // Surface nets may join two sheets in one cell: a handful of such edges do not show.
    expect(open / edges.size).toBeLessThan(0.002);
  });

  it('survives writing and reading', () => {
    const [again, second] = decodeLevels(encodeLevels([half, coarse]));
    expect(second.triangles).toEqual(coarse.triangles);
    expect(again.triangles).toEqual(half.triangles);
    expect(again.bones).toEqual(half.bones);
    expect(again.positions.every((value, i) => Math.abs(value - half.positions[i]) < 2e-5)).toBe(true);
    expect(() => decodeLevels(bytes.subarray(0, 500))).toThrow('cut off');
    expect(() => decodeLevels(new Uint8Array(3))).toThrow('not a figure file');
    expect(() => decodeFigure(new Uint8Array(64))).toThrow('not a figure file');
  });

  it('becomes one geometry whose levels use their own vertices only, the coarse one at most a third of the fine one', () => {
    const { geometry, levels } = buildFigure(bytes);
    expect(levels.map(({ count }) => count)).toEqual([half.triangles.length * 2, coarse.triangles.length * 2]);
    expect(levels[1].count * 3).toBeLessThan(levels[0].count);
    expect(geometry.getAttribute('position').count).toBeLessThan(40_000);
    const index = geometry.getIndex()!.array;
    const fine = whole.parts.length;
    expect(index.slice(0, levels[1].start).every((v) => v < fine)).toBe(true);
    expect(index.slice(levels[1].start).every((v) => v >= fine)).toBe(true);
  });
});

describe('skin bones', () => {
  it('carry every joint to where forward kinematics puts it', () => {
    const pose = new SkinPose();
    for (let seed = 1; seed <= 40; seed++) {
      const quaternions = randomPose(seed);
      const root = [0.3 * seed, 1, -0.2];
      pose.set(quaternions, root);
      const expected = forwardKinematics(quaternions, root);
      expected.forEach((value, i) => expect(Math.abs(pose.joints[i] - value)).toBeLessThan(1e-5));
      // Each bone turns about its joint, so it takes the joint's rest position to its posed one.
      SKIN_BONES.forEach(({ joint }, bone) => {
        const m = pose.matrices.subarray(bone * 16, bone * 16 + 16);
        const [x, y, z] = REST.subarray(joint * 3, joint * 3 + 3);
        for (let i = 0; i < 3; i++)
          expect(Math.abs(m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i] - expected[joint * 3 + i])).toBeLessThan(
            1e-5,
          );
      });
    }
  });

  it('share a wrist twist out over the forearm and leave the upper arm alone', () => {
    const forearm = [0.26, 0.01, 0].map((c) => c / Math.hypot(0.26, 0.01));
    const rotations = new Array(72).fill(0);
    forearm.forEach((c, i) => (rotations[jointIndex('left_wrist') * 3 + i] = c * 1.4));
    const pose = new SkinPose();
    pose.set(poseToQuaternions(rotations), [0, 1, 0]);
    const angle = (name: string) => {
      const m = pose.matrices.subarray(skinBone(name) * 16, skinBone(name) * 16 + 16);
      return Math.acos(Math.min(1, (m[0] + m[5] + m[10] - 1) / 2));
    };
    expect(angle('left_upper3')).toBeCloseTo(0, 3);
    expect(angle('left_lower1')).toBeCloseTo(0, 3);
    expect(angle('left_lower2')).toBeCloseTo(0.7, 3);
    expect(angle('left_lower3')).toBeCloseTo(1.4, 3);
    expect(angle('left_palm')).toBeCloseTo(1.4, 3);
    expect(angle('right_lower3')).toBeCloseTo(0, 3);
  });

  it('split a rotation into swing and twist that multiply back', () => {
    const axis = [0.6, 0, 0.8];
    const random = noise(9);
    for (let i = 0; i < 50; i++) {
      const q = poseToQuaternions([random() * 2, random() * 2, random() * 2, ...new Array(69).fill(0)]).slice(0, 4);
      const angle = twistAngle(q, axis);
      const back = [...axis.map((c) => -c * Math.sin(angle / 2)), Math.cos(angle / 2)];
      // What is left after taking the twist off does not turn about the axis.
      expect(twistAngle(multiply(q, back), axis)).toBeCloseTo(0, 5);
      const swung = rotateVector(multiply(q, back), axis);
      const turned = rotateVector(q, axis);
      turned.forEach((c, j) => expect(c).toBeCloseTo(swung[j], 5));
    }
  });
});
