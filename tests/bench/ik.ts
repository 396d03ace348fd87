/**
 * npx tsx tests/bench/ik.ts: inverse kinematics, measured. Prints a Markdown table: 200 random reachable goals per limb from one standing
 * pose, then smooth paths in steps of 1.5 cm, on which no joint may flip.
 */
import { createIkSolver } from '../../web/core/ik';
import { pinnedFeet, runTrials, standing } from '../unit/support/ik-trials';

const limbs = ['left hand', 'right hand', 'left foot', 'right foot'];
const rows = limbs.map((name, limb) => runTrials(createIkSolver(), limb, { name }));
const pins = pinnedFeet(standing());
for (const limb of [0, 1])
  rows.push(runTrials(createIkSolver(), limb, { name: `${limbs[limb]}, both feet pinned`, pins }));

console.log(
  '| Goal | within 1 cm | median, worst error | beyond limits | path ends reached | worst turn per frame | solve from afar | following |',
);
console.log('|---|---|---|---|---|---|---|---|');
for (const row of rows) {
  console.log(
    `| ${row.name} | ${row.solved} of ${row.targets} | ${(row.medianError * 1000).toFixed(2)}, ${(row.worstError * 1000).toFixed(1)} mm | ` +
      `${row.worstExcess.toFixed(2)} deg | ${row.arrived} of ${row.paths} | ${row.worstTurn.toFixed(1)} deg | ${row.coldTime.toFixed(2)} ms | ${row.warmTime.toFixed(2)} ms |`,
  );
  if (process.argv.includes('--where')) console.error(row.name, row.turned);
}
