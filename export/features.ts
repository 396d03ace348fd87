/**
 * Music features of wav files, with the very code that runs in the browser:
 *   npx tsx export/features.ts --out <folder> [--danceformer] <song.wav>...
 * Writes for each song NAME.f32 (frames x 15 float32, little-endian, row-major) and NAME.json
 * {frames, fps, names, tempo, beatsPerBar, beats, downbeats, sampleRate, milliseconds}; times in seconds.
 * With --danceformer the columns are those of the key pose model (web/core/beat-features.ts: MFCC, differences, energy, chroma, onset).
 */
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, extname, join } from 'node:path';
import { parseArgs } from 'node:util';
import { frameFeatures } from '../web/core/beat-features';
import { analyse } from '../web/core/features';
import { spec } from '../web/core/spec';
import { decodeWav, mixToMono } from '../web/core/wav';

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { out: { type: 'string' }, danceformer: { type: 'boolean' } },
});
if (!values.out || positionals.length === 0) {
  console.error('usage: npx tsx export/features.ts --out <folder> [--danceformer] <song.wav>...');
  process.exit(2);
}
mkdirSync(values.out, { recursive: true });
for (const path of positionals) {
  const pcm = decodeWav(readFileSync(path));
  const mono = mixToMono(pcm.channels);
  const begun = performance.now();
  const { features, grid } = analyse(mono, pcm.sampleRate);
  const milliseconds = Math.round(performance.now() - begun);
  const target = join(values.out, basename(path, extname(path)));
  const { frames, fps } = features;
  const data = values.danceformer ? frameFeatures(features) : features.data;
  const names = values.danceformer ? spec.danceformer.featureNames : features.names;
  writeFileSync(`${target}.f32`, new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
  writeFileSync(
    `${target}.json`,
    JSON.stringify({ frames, fps, names, ...grid, sampleRate: pcm.sampleRate, milliseconds }),
  );
  const seconds = mono.length / pcm.sampleRate;
  console.log(
    `${basename(path)}: ${seconds.toFixed(1)} s, ${grid.tempo.toFixed(1)} BPM, ${grid.beatsPerBar}/4, ` +
      `${grid.beats.length} beats, ${((seconds * 1000) / milliseconds).toFixed(0)} x real time`,
  );
}
