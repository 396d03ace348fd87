/**
 * Writes a dance of curves by the shipped models with the page's own writers, and beside it where its joints are at the keys and between
 * them, sampled from the curves' analytic form. `npx tsx export/tests/curve_files.ts FOLDER`
 */
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { danceTo } from '../../tests/bench/dances';
import { synthesise } from '../../tests/e2e/support/songs';
import { knotTimes, sampleCurves, type CurveDance } from '../../web/core/curves';
import { writeCurvesGlb } from '../../web/core/formats/curves-glb';
import { writeCurvesJson } from '../../web/core/formats/curves-json';
import { forwardKinematics, JOINT_COUNT } from '../../web/core/skeleton';

const SECONDS = 8;
const POSE = JOINT_COUNT * 4;

const [folder] = process.argv.slice(2);
if (!folder) throw new Error('Usage: npx tsx export/tests/curve_files.ts FOLDER');
mkdirSync(folder, { recursive: true });
const { curves, keyPoses } = await danceTo({ samples: synthesise({ seconds: SECONDS }), rate: 44100 });

/** World places of the joints at a time, 24 x 3. */
function joints(dance: CurveDance, time: number): number[] {
  // One frame, `time` seconds after the start.
  const { quaternions, root } = sampleCurves({ ...dance, times: dance.times.map((each) => each - time) }, 1, 1);
  return Array.from(forwardKinematics(quaternions.subarray(0, POSE), root.subarray(0, 3)));
}

const knots = [...knotTimes(curves)];
const middles = knots.slice(1).map((time, i) => (time + knots[i]) / 2);
const at = (times: number[]) => ({ times, joints: times.map((time) => joints(curves, time)) });
writeFileSync(join(folder, 'curves.glb'), writeCurvesGlb(curves, 'a dance of curves'));
writeFileSync(join(folder, 'curves.json'), writeCurvesJson(curves));
writeFileSync(
  join(folder, 'curves-truth.json'),
  JSON.stringify({ keyPoses: keyPoses.map(({ time }) => time), knots: at(knots), middles: at(middles) }),
);
