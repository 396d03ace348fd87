/**
 * Speed of the song analysis in Chromium, and of librosa doing the same work on the same file in the same run:
 *   node tests/bench/analyse.mjs <song> [--python <interpreter with librosa>] [--runs 3] [--port 5311]
 * Prints one JSON object; times in milliseconds, `timesRealTime` = seconds of song per second of work (best run).
 */
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { chromium } from '@playwright/test';
import { createServer } from 'vite';

const FLAGS = ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const LIBROSA = `
import sys, time, warnings
warnings.filterwarnings("ignore")
import librosa
y, sr = librosa.load(sys.argv[1], sr=22050)
best = 1e9
for _ in range(int(sys.argv[2])):
    begun = time.perf_counter()
    librosa.feature.chroma_cens(y=y, sr=sr)
    onset = librosa.onset.onset_strength(y=y, sr=sr)
    librosa.beat.beat_track(onset_envelope=onset, sr=sr)
    best = min(best, time.perf_counter() - begun)
print(best * 1000)
`;

/**
 * Decodes and analyses a song in a fresh page, off the main thread.
 * @param {string} song path of a sound file
 * @param {{runs?: number, port?: number}} options
 * @returns {Promise<{seconds: number, decode: number, head: number, analyse: number, worker: number, longestTask: number, timesRealTime: number}>}
 */
export async function benchAnalyse(song, { runs = 3, port = 5311 } = {}) {
  const server = await createServer({ configFile: resolve('vite.config.ts'), server: { port }, logLevel: 'error' });
  await server.listen();
  const executablePath = existsSync('/usr/bin/chromium') ? '/usr/bin/chromium' : undefined;
  const browser = await chromium.launch({ args: FLAGS, executablePath });
  try {
    const page = await browser.newPage();
    const origin = `http://localhost:${port}`;
    await page.route('**/bench.html', (route) => route.fulfill({ contentType: 'text/html', body: '<!doctype html>' }));
    await page.route('**/bench-song', (route) => route.fulfill({ body: readFileSync(song) }));
    await page.goto(`${origin}/bench.html`);
    const results = [];
    for (let run = 0; run < runs; run++) {
      results.push(
        await page.evaluate(async () => {
          const { AnalyseClient } = await import('/workers/analyse-client.ts');
          const { decodeSong } = await import('/audio/decode.ts');
          const bytes = await (await fetch('/bench-song')).arrayBuffer();
          let longestTask = 0;
          const observer = new PerformanceObserver((list) => {
            for (const entry of list.getEntries()) longestTask = Math.max(longestTask, entry.duration);
          });
          observer.observe({ entryTypes: ['longtask'] });
          const begun = performance.now();
          const buffer = await decodeSong(bytes);
          const decoded = performance.now();
          const client = new AnalyseClient();
          let head = 0;
          const result = await client.analyse(buffer, { onHead: () => (head = performance.now() - decoded) });
          const analyse = performance.now() - decoded;
          client.dispose();
          observer.disconnect();
          return {
            seconds: buffer.duration,
            decode: decoded - begun,
            head,
            analyse,
            worker: result.milliseconds,
            longestTask,
            frames: result.features.frames,
            tempo: result.grid.tempo,
          };
        }),
      );
    }
    const best = results.reduce((a, b) => (a.analyse < b.analyse ? a : b));
    return { ...best, timesRealTime: (best.seconds * 1000) / best.analyse };
  } finally {
    await browser.close();
    await server.close();
  }
}

/** Milliseconds that librosa takes for chroma_cens, onset_strength and beat_track (best of the runs, after loading). */
export function benchLibrosa(song, python, runs = 3) {
  return Number(execFileSync(python, ['-c', LIBROSA, song, String(runs)], { encoding: 'utf8' }));
}

if (process.argv[1] === import.meta.filename) {
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: {
      python: { type: 'string' },
      runs: { type: 'string', default: '3' },
      port: { type: 'string', default: '5311' },
    },
  });
  const runs = Number(values.runs);
  const ours = await benchAnalyse(positionals[0], { runs, port: Number(values.port) });
  const librosa = values.python ? benchLibrosa(positionals[0], values.python, runs) : undefined;
  console.log(JSON.stringify({ ...ours, librosa, ratioToLibrosa: librosa && librosa / ours.analyse }, null, 1));
}
