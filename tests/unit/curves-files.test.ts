import { readFileSync } from 'node:fs';
import { gunzipSync } from 'node:zlib';
import { validateBytes } from 'gltf-validator';
import { AnimationMixer, Vector3, type Object3D } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { describe, expect, it } from 'vitest';
import { knotTimes, sampleCurves, type CurveDance } from '../../web/core/curves';
import { applyEdits } from '../../web/core/curves-edit';
import { generateCurves } from '../../web/core/curves-dance';
import { curveSamplers, smoothSlopes, writeCurvesGlb } from '../../web/core/formats/curves-glb';
import { channelNames, readCurvesJson, writeCurvesJson } from '../../web/core/formats/curves-json';
import { writeGlb } from '../../web/core/formats/glb-write';
import { TIMBRE_SIZE } from '../../web/core/mfcc';
import { forwardKinematics, JOINTS } from '../../web/core/skeleton';
import { buildFigure } from '../../web/scene/figure-asset';
import { figureForGlb } from '../../web/scene/figure-glb';
import { helperSamplers } from '../../web/scene/skin-samplers';
import { fourPoses } from '../e2e/support/page';
import { danceRequest, key } from './dance';
import { fakeIntervals } from './support/curves';

/** A dance with shape: tension, continuity, bias and a bent knot. */
async function bent(): Promise<CurveDance> {
  const { features, ...rest } = danceRequest(6);
  const timbre = new Float32Array(features.frames * TIMBRE_SIZE);
  const keyPoses = fourPoses().map((pose, i) => key(1 + i, pose));
  const { curves } = await generateCurves({ ...rest, keyPoses, features: { ...features, timbre } }, fakeIntervals);
  const k = curves.anchors.indexOf('k2');
  const [from, to] = [curves.anchors[k], curves.anchors[k + 1]];
  return applyEdits(curves, [
    {
      from,
      to,
      track: 'right_shoulder',
      tension: -0.5,
      continuity: 0.6,
      bias: -0.3,
      knots: [
        [0.3, 0, 0.4],
        [0, -0.5, 0],
      ],
    },
    {
      from,
      to,
      track: 'root',
      tension: 0.5,
      knots: [
        [0.1, 0, 0],
        [0, 0.05, 0.2],
      ],
    },
  ]);
}

/** Farthest that a joint is from its place on our stage when three plays the file, and how far any moves, metres. */
async function inThree(curves: CurveDance, change: (values: Float32Array, times: Float32Array) => Float32Array) {
  const samplers = curveSamplers(curves).map((each) => ({
    ...each,
    values: change(each.values as Float32Array, each.times),
  }));
  const { scene, animations } = await new GLTFLoader().parseAsync(writeGlb({ name: 'a dance', samplers }).buffer, '');
  expect(animations[0].name).toBe('a dance');
  const mixer = new AnimationMixer(scene);
  mixer.clipAction(animations[0]).play();
  const nodes = JOINTS.map((name) => scene.getObjectByName(name) as Object3D);
  const at = new Vector3();
  const motion = sampleCurves(curves, 120);
  const first = forwardKinematics(motion.quaternions.subarray(0, 96), motion.root.subarray(0, 3));
  let [worst, moved] = [0, 0];
  for (let t = 0; t < Math.floor(animations[0].duration * 120) - 1; t += 7) {
    mixer.setTime(t / 120);
    scene.updateMatrixWorld(true);
    const [turns, root] = [motion.quaternions.subarray(t * 96, t * 96 + 96), motion.root.subarray(t * 3, t * 3 + 3)];
    const ours = forwardKinematics(turns, root);
    nodes.forEach((node, joint) => {
      node.getWorldPosition(at);
      const own = new Vector3().fromArray(ours, joint * 3);
      worst = Math.max(worst, at.distanceTo(own));
      moved = Math.max(moved, own.distanceTo(new Vector3().fromArray(first, joint * 3)));
    });
  }
  return { worst, moved };
}

describe('curves as JSON', () => {
  it('come back as they were', async () => {
    const curves = await bent();
    const back = readCurvesJson(writeCurvesJson(curves));
    expect(back.anchors).toEqual(curves.anchors);
    const [a, b] = [sampleCurves(back, 60), sampleCurves(curves, 60)];
    expect(a.frames).toBe(b.frames);
    for (const part of ['root', 'quaternions'] as const) {
      a[part].forEach((value, i) => expect(Math.abs(value - b[part][i])).toBeLessThan(2e-5));
    }
    const raw = JSON.parse(writeCurvesJson(curves)) as { channels: string[]; keys: object[]; intervals: object[] };
    expect(raw.channels).toEqual(channelNames());
    expect(raw.channels).toHaveLength(99);
    expect(raw.intervals).toHaveLength(raw.keys.length - 1);
  });

  it('are refused with a reason where they are damaged, newer or of another body', async () => {
    const text = writeCurvesJson(await bent());
    const broken = (edit: (raw: Record<string, never>) => void) => {
      const raw = JSON.parse(text) as Record<string, never>;
      edit(raw);
      return () => readCurvesJson(JSON.stringify(raw));
    };
    expect(() => readCurvesJson(text.slice(0, -20))).toThrow('cut off');
    expect(() => readCurvesJson('{"format":"posebeat-motion"}')).toThrow('no file of curves');
    expect(broken((raw) => Object.assign(raw, { version: 2 }))).toThrow('newer');
    expect(broken((raw) => Object.assign(raw, { joints: ['hip'] }))).toThrow('another skeleton');
    expect(broken((raw) => (raw.intervals as unknown[]).pop())).toThrow('intervals');
    expect(broken((raw) => ((raw.keys as { time: number }[])[1].time = 0))).toThrow('order');
    expect(broken((raw) => ((raw.intervals as { tension: number[] }[])[0].tension[5] = 1.5))).toThrow(
      'intervals.0.tension',
    );
    expect(broken((raw) => ((raw.keys as { values: unknown[] }[])[0].values[3] = null))).toThrow('keys.0.values');
  });
});

describe('curves as GLB', () => {
  it('have cubic splines with keys at the key poses and inner knots, all unit quaternions', async () => {
    const curves = await bent();
    const samplers = curveSamplers(curves);
    expect(samplers).toHaveLength(25);
    const times = Array.from(knotTimes(curves), Math.fround);
    for (const { interpolation, times: own, values, path } of samplers) {
      expect(interpolation).toBe('CUBICSPLINE');
      expect(times.filter((time) => !own.includes(time))).toEqual([]);
      if (path !== 'rotation') continue;
      for (let i = 0; i < own.length; i++) {
        expect(Math.hypot(...values.subarray(i * 12 + 4, i * 12 + 8))).toBeCloseTo(1, 5);
      }
    }
    // Most joints need no further keys, and have their times in common.
    const plain = samplers.filter(({ times: own }) => own.length === times.length);
    expect(plain.length).toBeGreaterThan(samplers.length / 2);
    expect(new Set(plain.map(({ times: own }) => own)).size).toBe(1);
  });

  it('is valid to Khronos’ validator, with our figure too', async () => {
    const curves = await bent();
    const figure = buildFigure(gunzipSync(readFileSync(new URL('../../web/scene/figure.bin', import.meta.url))));
    const body = { figure: figureForGlb(figure), helpers: helperSamplers(sampleCurves(curves, 30)) };
    for (const extras of [{}, body]) {
      const { issues } = await validateBytes(writeCurvesGlb(curves, 'a dance', extras), { maxIssues: 100 });
      expect(issues.messages.filter(({ code }) => code !== 'UNUSED_OBJECT')).toEqual([]);
      expect(issues.numErrors + issues.numWarnings).toBe(0);
    }
  });

  it('move in three as on our stage, between the keys too', async () => {
    const curves = await bent();
    const { worst, moved } = await inThree(curves, (values) => values);
    expect(moved).toBeGreaterThan(0.3);
    expect(worst).toBeLessThan(1e-3);
  });

  it('are near to it in a program that drops the tangents and lays a smooth spline through the keys', async () => {
    const { worst } = await inThree(await bent(), (values, times) => {
      const width = values.length / times.length / 3;
      const out = values.slice();
      for (let c = 0; c < width; c++) {
        const own = Float64Array.from(times, (_, i) => values[(i * 3 + 1) * width + c]);
        const slopes = smoothSlopes(Float64Array.from(times), own);
        slopes.forEach((slope, i) => (out[i * 3 * width + c] = out[(i * 3 + 2) * width + c] = slope));
      }
      return out;
    });
    expect(worst).toBeLessThan(0.01);
  });

  it('need two key poses', async () => {
    const { times, ...rest } = await bent();
    expect(() => curveSamplers({ ...rest, times: times.slice(0, 1) })).toThrow('two key poses');
  });
});
