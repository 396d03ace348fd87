/**
 * Every check, in one go: type check, lint, pytest, unit + golden + property tests, build, end-to-end in headless Chromium.
 * All steps run even when one fails, so that one run tells everything. `--only name[,name]` runs some of them.
 */
import { spawn } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { ensureChromium } from './chromium.mjs';

const top = dirname(dirname(fileURLToPath(import.meta.url)));
const venv = join(top, 'export', '.venv');
const python = join(venv, 'bin', 'python');

/** Runs a command; what it prints comes at once, or with `quiet` when it is over, so that two at a time do not mix their lines. */
function run(command, args, { quiet = false } = {}) {
  return new Promise((resolve, reject) => {
    const child = spawn(command, args, { cwd: top, stdio: quiet ? ['ignore', 'pipe', 'pipe'] : 'inherit' });
    const printed = [];
    for (const stream of [child.stdout, child.stderr]) stream?.on('data', (part) => printed.push(part));
    child.on('error', reject);
    child.on('close', (status) => {
      process.stdout.write(Buffer.concat(printed));
      if (status === 0) resolve();
      else reject(new Error(`${command} ${args.join(' ')} ended with ${status}`));
    });
  });
}

/** The Python environment of export/, made anew only when its pinned requirements changed. */
async function ensurePython(options) {
  const requirements = readFileSync(join(top, 'export', 'requirements.txt'), 'utf8');
  const stamp = join(venv, 'requirements.stamp');
  if (existsSync(stamp) && readFileSync(stamp, 'utf8') === requirements) return;
  await run(process.env.PYTHON ?? 'python3', ['-m', 'venv', venv], options);
  const pip = ['-m', 'pip', 'install', '--quiet', '--disable-pip-version-check'];
  await run(python, [...pip, '-r', join('export', 'requirements.txt')], options);
  writeFileSync(stamp, requirements);
}

const steps = {
  typecheck: (options) => run('npx', ['tsc', '--noEmit'], options),
  lint: (options) => run('npm', ['run', '--silent', 'lint'], options),
  pytest: async (options) => {
    await ensurePython(options);
    await run(python, ['-m', 'pytest', '-q', 'export/tests'], options);
  },
  unit: (options) => run('npx', ['vitest', 'run'], options),
  build: (options) => run('npm', ['run', '--silent', 'build'], options),
  e2e: async (options) => {
    ensureChromium();
    await run('npx', ['playwright', 'test'], options);
  },
};
/** Stages, one after another; the lanes of a stage run side by side, the steps of a lane one after another. */
const STAGES = [[['typecheck', 'lint', 'unit'], ['pytest']], [['build', 'e2e']]];

const only = process.argv.includes('--only')
  ? process.argv[process.argv.indexOf('--only') + 1].split(',')
  : Object.keys(steps);
const unknown = only.filter((name) => !(name in steps));
if (unknown.length > 0) throw new Error(`There is no step "${unknown}"; there are ${Object.keys(steps).join(', ')}.`);
const results = [];

async function step(name, options) {
  const start = Date.now();
  let problem = '';
  try {
    await steps[name](options);
  } catch (error) {
    problem = error.message;
  }
  results.push({ name, seconds: (Date.now() - start) / 1000, problem });
}

const begun = Date.now();
for (const stage of STAGES) {
  const lanes = stage.map((lane) => lane.filter((name) => only.includes(name))).filter((lane) => lane.length > 0);
  if (lanes.length === 0) continue;
  console.log(`\n=== ${lanes.map((lane) => lane.join(', ')).join('; beside it ')}`);
  await Promise.all(
    lanes.map(async (lane) => {
      for (const name of lane) await step(name, { quiet: lanes.length > 1 });
    }),
  );
}

console.log('\n=== summary');
for (const { name, seconds, problem } of results) {
  console.log(
    `${problem ? 'FAILED' : 'ok    '} ${name.padEnd(10)} ${seconds.toFixed(1).padStart(6)} s${problem ? `  ${problem}` : ''}`,
  );
}
const failed = results.filter((result) => result.problem).length;
console.log(
  `${results.length - failed} passed, ${failed} failed, ${((Date.now() - begun) / 1000).toFixed(1)} s in all`,
);
process.exit(failed ? 1 : 0);
