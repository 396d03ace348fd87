/**
 * How far poses go beyond the joints' ranges, by the page's own table:
 *   npx tsx export/limits.ts <quaternions.f32>    (poses x 24 x 4 float32, little-endian)
 * Prints JSON {poses, beyond, joints, worst}: poses, those with a joint more than 5 degrees out, share of joints out, most degrees.
 */
import { readFileSync } from 'node:fs';
import { limitExcess } from '../web/core/joint-limits';
import { JOINT_COUNT } from '../web/core/skeleton';

/** A few degrees beyond a clinic's range are common in recorded dance too. */
const SLACK = 5;
const bytes = readFileSync(process.argv[2]);
const data = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4);
const poses = data.length / (JOINT_COUNT * 4);
let [beyond, joints, worst] = [0, 0, 0];
for (let p = 0; p < poses; p++) {
  let out = false;
  for (let j = 1; j < JOINT_COUNT; j++) {
    const at = (p * JOINT_COUNT + j) * 4;
    const excess = limitExcess(j, data.subarray(at, at + 4));
    if (excess > SLACK) {
      out = true;
      joints += 1;
    }
    worst = Math.max(worst, excess);
  }
  if (out) beyond += 1;
}
console.log(JSON.stringify({ poses, beyond, joints: joints / (poses * (JOINT_COUNT - 1)), worst }));
