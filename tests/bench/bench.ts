/**
 * npm run bench: speed, sizes and memory of the built page in headless Chromium, beside Python doing the same work in the same run.
 * Prints a Markdown table. `--suggest` measures the suggestions alone. `--quick` takes fewer runs and leaves WebGPU out (minutes on a software adapter); `--no-python` leaves the references out,
 * `--timeline` measures the timeline alone.
 */
import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { cpus, tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium, type Page } from '@playwright/test';
import { CHROMIUM_FLAGS, ensureChromium, installedChromium } from '../chromium.mjs';
import { wav } from '../e2e/support/songs';
import { asset, sizes } from './downloads';
import { benchSuggest } from './suggest';
import { benchTimeline, MINUTES, timelineRows } from './timeline';
import { timeWindows } from './window';

const top = dirname(dirname(dirname(fileURLToPath(import.meta.url))));
const dist = join(top, 'dist');
const PORT = 4181;
const ORIGIN = `http://127.0.0.1:${PORT}/`;
const SECONDS = 180;
const timelineOnly = process.argv.includes('--timeline');
const suggestOnly = process.argv.includes('--suggest');
const quick = process.argv.includes('--quick');
const runs = quick ? 3 : 9;
const spec = JSON.parse(readFileSync(join(top, 'web/core/spec.json'), 'utf8')) as {
  model: { seedFrames: number; musicFrames: number };
};

const median = (values: number[]) => values.slice().sort((a, b) => a - b)[Math.floor(values.length / 2)];
const rows: [string, string, string][] = [];
const report = (what: string, value: string, beside = '') => {
  rows.push([what, value, beside]);
  console.error(`${what}: ${value}${beside ? ` (${beside})` : ''}`);
};
const megabytes = (bytes: number) => `${(bytes / 1e6).toFixed(1)} MB`;

/** Highest resident memory of any page of a Chromium that runs now, bytes; only where /proc tells. */
function peakMemory(): number {
  if (!existsSync('/proc')) return 0;
  let most = 0;
  for (const pid of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      const command = readFileSync(`/proc/${pid}/cmdline`, 'utf8');
      if (!command.includes('--type=renderer')) continue;
      most = Math.max(
        most,
        1024 * Number(/VmHWM:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'))?.[1] ?? 0),
      );
    } catch {
      // The process ended while we looked.
    }
  }
  return most;
}

/** Seconds by Python, or undefined where its environment cannot be made. */
function references(wavPath: string): { librosa_seconds: number; model_seconds: Record<string, number> } | undefined {
  if (process.argv.includes('--no-python')) return undefined;
  const python = join(top, 'export/.venv/bin/python');
  try {
    if (!existsSync(python)) execFileSync('python3', ['-m', 'venv', join(top, 'export/.venv')]);
    execFileSync(python, ['-m', 'pip', 'install', '-q', '-r', 'export/requirements-bench.txt'], {
      cwd: top,
      stdio: 'inherit',
    });
    const args = [
      'export/bench_reference.py',
      '--wav',
      wavPath,
      '--model',
      'public/models/light.onnx',
      '--runs',
      String(runs),
    ];
    return JSON.parse(execFileSync(python, args, { cwd: top, encoding: 'utf8' }).trim().split('\n').pop()!);
  } catch (error) {
    console.error(`No Python reference: ${(error as Error).message}`);
    return undefined;
  }
}

/** Durations of what the page measured under a name, milliseconds. */
const measured = (page: Page, name: string) =>
  page.evaluate((name) => performance.getEntriesByName(`posebeat:${name}`).map((entry) => entry.duration), name);

async function benchWindows(native: Record<string, number> | undefined): Promise<void> {
  const browser = await chromium.launch({
    executablePath: installedChromium(),
    args: [...CHROMIUM_FLAGS, '--enable-unsafe-webgpu'],
  });
  const url = (path: string) => ORIGIN + path;
  for (const [backend, threads] of [
    ['wasm', 1],
    ['wasm', 2],
    ['webgpu', 1],
  ] as const) {
    if (quick && backend === 'webgpu') continue;
    const page = await browser.newPage();
    // A plain file of the site: isolated by its headers, with nothing of the app running.
    await page.goto(url('models/manifest.json'));
    const adapter = await page.evaluate(async () => {
      const found = await navigator.gpu?.requestAdapter();
      return found
        ? [found.info.vendor, found.info.architecture, found.info.description].filter(Boolean).join(' ')
        : '';
    });
    if (backend === 'webgpu' && !adapter) {
      report('One window on WebGPU', 'no adapter here');
      continue;
    }
    const flavour = backend === 'webgpu' ? 'jspi' : 'wasm';
    const loader = backend === 'webgpu' ? /^ort-wasm-simd-threaded\.jspi-.*\.mjs$/ : /^ort-wasm-simd-threaded-.*\.mjs$/;
    const binary =
      backend === 'webgpu' ? /^ort-wasm-simd-threaded\.jspi-.*\.wasm$/ : /^ort-wasm-simd-threaded-.*\.wasm$/;
    // The TypeScript runner names functions through a helper that the page does not have.
    await page.evaluate('globalThis.__name = (value) => value');
    const times = await page.evaluate(timeWindows, {
      ortUrl: url(asset(dist, new RegExp(`^ort\\.${flavour}\\.min-.*\\.js$`))),
      mjsUrl: url(asset(dist, loader)),
      wasmUrl: url(asset(dist, binary)),
      modelUrl: url('models/light.onnx'),
      backend,
      threads,
      ...spec.model,
      warmUp: backend === 'webgpu' ? 0 : 6,
      runs: backend === 'webgpu' ? 1 : runs,
    });
    const reference = native?.[String(threads)];
    const ratio = reference
      ? `${(median(times) / 1000 / reference).toFixed(1)} x native (${(reference * 1000).toFixed(0)} ms)`
      : '';
    const where = backend === 'webgpu' ? `WebGPU, ${adapter}` : `WASM, ${threads} thread${threads > 1 ? 's' : ''}`;
    report(
      `One window (${spec.model.seedFrames} + ${spec.model.musicFrames} frames), ${where}`,
      `${median(times).toFixed(0)} ms`,
      backend === 'wasm' ? ratio : '',
    );
    await page.close();
  }
  await browser.close();
}

async function benchPage(wavPath: string, librosa: number | undefined): Promise<void> {
  const browser = await chromium.launch({
    executablePath: installedChromium(),
    args: [
      ...CHROMIUM_FLAGS,
      '--autoplay-policy=no-user-gesture-required',
      // Drawing in software would take the cores that are measured; on a graphics processor it does not.
      '--disable-3d-apis',
    ],
  });
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  const fetched: string[] = [];
  page.on('request', (request) => {
    const { origin, pathname, protocol } = new URL(request.url());
    if (protocol === 'http:' && `${origin}/` === ORIGIN)
      fetched.push(pathname === '/' ? 'index.html' : decodeURIComponent(pathname.slice(1)));
  });
  await page.goto(ORIGIN);
  await page.evaluate(() => window.posebeat.ready);
  await page.waitForTimeout(3000);
  const opening = new Set(fetched);
  // First the analysis alone, through the API, which loads no model.
  await page.evaluate(() => {
    const input = Object.assign(document.createElement('input'), { type: 'file', id: 'bench' });
    document.body.append(input);
  });
  await page.locator('#bench').setInputFiles(wavPath);
  const song = () =>
    page.evaluate(() => window.posebeat.loadSong(document.querySelector<HTMLInputElement>('#bench')!.files![0]));
  for (let i = 0; i < 3; i++) await song();
  const alone = median(await measured(page, 'analyse'));
  await page.reload();
  await page.evaluate(() => window.posebeat.ready);
  await page.evaluate(() => {
    const tasks: number[] = [];
    (window as unknown as { longTasks: number[] }).longTasks = tasks;
    new PerformanceObserver((list) => tasks.push(...list.getEntries().map((entry) => entry.duration))).observe({
      type: 'longtask',
    });
  });
  const [chooser] = await Promise.all([
    page.waitForEvent('filechooser'),
    page
      .getByText(/^(Drop a song|New song)$/)
      .first()
      .click(),
  ]);
  await chooser.setFiles(wavPath);
  await page.waitForFunction(() => performance.getEntriesByName('posebeat:whole-dance').length > 0, undefined, {
    timeout: 300_000,
  });
  const [decode] = await measured(page, 'decode');
  const [analyse] = await measured(page, 'analyse');
  const [first] = await measured(page, 'first-dance');
  const [whole] = await measured(page, 'whole-dance');
  const tasks = await page.evaluate(() => (window as unknown as { longTasks: number[] }).longTasks);
  report(
    'Analysis of a 3-minute song in the worker',
    `${((SECONDS * 1000) / alone).toFixed(0)} x real time`,
    librosa
      ? `${(librosa / (alone / 1000)).toFixed(2)} x librosa's speed (librosa ${(SECONDS / librosa).toFixed(0)} x real time)`
      : '',
  );
  report('The same while the model is loaded beside it', `${((SECONDS * 1000) / analyse).toFixed(0)} x real time`);
  report('Decoding it', `${decode.toFixed(0)} ms`);
  report('From drop to the figure dancing to it', `${(first / 1000).toFixed(1)} s`);
  report('From drop to the whole dance of 3 minutes', `${(whole / 1000).toFixed(1)} s`);
  report(
    'Main-thread tasks over 50 ms meanwhile',
    String(tasks.length),
    tasks.length ? `longest ${Math.max(...tasks).toFixed(0)} ms` : '',
  );
  report('Peak memory of the page (resident)', megabytes(peakMemory()));
  for (const { name, raw, gzip, brotli } of [
    sizes('Download: opening page with its demo', dist, opening),
    sizes('Download: until the first dance to one’s own song', dist, fetched),
  ]) {
    report(name, `${megabytes(raw)} raw`, `gzip ${megabytes(gzip)}, brotli ${megabytes(brotli)}`);
  }
  await browser.close();
}

ensureChromium();
if (!existsSync(join(dist, 'index.html'))) execFileSync('npm', ['run', 'build'], { cwd: top, stdio: 'inherit' });
const folder = mkdtempSync(join(tmpdir(), 'posebeat-bench-'));
const wavPath = join(folder, 'three-minutes.wav');
writeFileSync(wavPath, wav({ seconds: SECONDS, tempo: 122, channels: 2 }));
const python = timelineOnly || suggestOnly ? undefined : references(wavPath);
const server = spawn('npx', ['vite', 'preview', '--port', String(PORT), '--strictPort', '--host', '127.0.0.1'], {
  cwd: top,
  stdio: 'ignore',
  detached: true,
});
try {
  for (let i = 0; i < 100 && !(await fetch(ORIGIN).catch(() => undefined)); i++) {
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
  if (!timelineOnly && !suggestOnly) {
    await benchWindows(python?.model_seconds);
    await benchPage(wavPath, python?.librosa_seconds);
  }
  if (!timelineOnly) for (const row of await benchSuggest(ORIGIN, wavPath, quick ? 1 : 3)) report(...row);
  const longPath = join(folder, 'ten-minutes.wav');
  writeFileSync(longPath, wav({ seconds: MINUTES * 60, tempo: 122, sampleRate: 22_050 }));
  if (!suggestOnly) for (const row of timelineRows(await benchTimeline(ORIGIN, longPath))) report(...row);
} finally {
  process.kill(-server.pid!);
}
console.log(
  `\nMeasured on ${cpus().length} cores (${cpus()[0].model.trim()}), ${timelineOnly || suggestOnly ? '' : `medians of ${runs} windows, `}page without its 3D stage unless a row says so.\n`,
);
console.log('| What | Figure | Beside it |\n|---|---|---|');
for (const row of rows) console.log(`| ${row.join(' | ')} |`);
