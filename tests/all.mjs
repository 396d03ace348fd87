/**
 * Every check, in one go: type check, lint, unit + golden + property tests, build, end-to-end in headless Chromium, pytest.
 * All steps run even when one fails, so that one run tells everything. `--only name[,name]` runs some of them.
 */
import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { ensureChromium } from './chromium.mjs';

const top = dirname(dirname(fileURLToPath(import.meta.url)));
const venv = join(top, 'export', '.venv');
const python = join(venv, 'bin', 'python');

function run(command, args, options = {}) {
  const { status, error } = spawnSync(command, args, { cwd: top, stdio: 'inherit', ...options });
  if (error) throw error;
  if (status !== 0) throw new Error(`${command} ${args.join(' ')} ended with ${status}`);
}

/** The Python environment of export/, made anew only when its pinned requirements changed. */
function ensurePython() {
  const requirements = readFileSync(join(top, 'export', 'requirements.txt'), 'utf8');
  const stamp = join(venv, 'requirements.stamp');
  if (existsSync(stamp) && readFileSync(stamp, 'utf8') === requirements) return;
  run(process.env.PYTHON ?? 'python3', ['-m', 'venv', venv]);
  run(python, [
    '-m',
    'pip',
    'install',
    '--quiet',
    '--disable-pip-version-check',
    '-r',
    join('export', 'requirements.txt'),
  ]);
  writeFileSync(stamp, requirements);
}

const steps = {
  typecheck: () => run('npx', ['tsc', '--noEmit']),
  lint: () => run('npm', ['run', '--silent', 'lint']),
  unit: () => run('npx', ['vitest', 'run']),
  build: () => run('npm', ['run', '--silent', 'build']),
  e2e: () => {
    ensureChromium();
    run('npx', ['playwright', 'test']);
  },
  pytest: () => {
    ensurePython();
    run(python, ['-m', 'pytest', '-q', 'export/tests']);
  },
};

const only = process.argv.includes('--only')
  ? process.argv[process.argv.indexOf('--only') + 1].split(',')
  : Object.keys(steps);
const results = [];
for (const name of only) {
  console.log(`\n=== ${name}`);
  const start = Date.now();
  let problem = '';
  try {
    steps[name]();
  } catch (error) {
    problem = error.message;
  }
  results.push({ name, seconds: (Date.now() - start) / 1000, problem });
}

console.log('\n=== summary');
for (const { name, seconds, problem } of results) {
  console.log(
    `${problem ? 'FAILED' : 'ok    '} ${name.padEnd(10)} ${seconds.toFixed(1).padStart(6)} s${problem ? `  ${problem}` : ''}`,
  );
}
const failed = results.filter((result) => result.problem).length;
console.log(`${results.length - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
