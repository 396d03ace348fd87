/**
 * The opening demo: writes public/demo/demo.json (the project: song, grid, key poses) and public/demo/dance.bin (its dance, made by
 * the shipped model through onnxruntime-web in Node, with the very code that runs in the page):
 *   npx tsx export/content/demo.ts [--document-only]
 * Needs ffmpeg on the PATH to decode public/demo/song.mp3.
 */
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import * as ort from 'onnxruntime-web';
import { createDocument, DEFAULT_DIALS, type ProjectDocument } from '../../web/core/document';
import { parseDocument } from '../../web/core/document-read';
import { analyse, withGrid } from '../../web/core/features';
import { encodeMotion } from '../../web/core/formats/motion-binary';
import { beatHitRate, consistencyError, footSkate, jointSpeed, meanJerk } from '../../web/core/metrics';
import { spec } from '../../web/core/spec';
import type { BeatGrid, KeyPose, LibraryPose, SeedClip } from '../../web/core/types';
import { decodeWav, mixToMono } from '../../web/core/wav';
import { generateMotion } from '../../web/core/windows';
import { openSession } from '../../web/workers/onnx-session';

const folder = (path: string): string => fileURLToPath(new URL(`../../public/${path}`, import.meta.url));
const json = (path: string): unknown => JSON.parse(readFileSync(folder(path), 'utf8'));

/** The song is composed at this tempo with its first downbeat at 0 s (see song.py), so its grid is known, not estimated. */
const TEMPO = 120;
const BEATS = 120;
const BEATS_PER_BAR = 4;
const SEED_CLIP = 'two-step';

/** [bar, beat of the bar (0 = the downbeat), pose]: pictures where the song changes, grooves between them. */
const STORY: readonly (readonly [number, number, string])[] = [
  [1, 0, 'hip-lean'],
  [3, 0, 'easy-lean-back'],
  [4, 0, 'snap-low'],
  [6, 0, 'roll-the-arms'],
  [7, 2, 'b-boy-stance'],
  [8, 0, 'point-to-the-sky'],
  [10, 0, 'night-fever'],
  [12, 0, 'new-yorker'],
  [14, 0, 'block-it'],
  [16, 0, 'side-reach'],
  [18, 0, 'contraction'],
  [20, 0, 'open-release'],
  [22, 0, 'rock-forward'],
  [24, 0, 'cuban-hip'],
  [26, 0, 'point-across'],
  [29, 0, 'big-finish'],
];

function demoGrid(): BeatGrid {
  const beats = Array.from({ length: BEATS }, (_, i) => (i * 60) / TEMPO);
  return {
    tempo: TEMPO,
    beatsPerBar: BEATS_PER_BAR,
    beats,
    downbeats: beats.filter((_, i) => i % BEATS_PER_BAR === 0),
  };
}

function demoDocument(duration: number): ProjectDocument {
  const library = new Map(
    (json('library/poses.json') as { poses: LibraryPose[] }).poses.map((pose) => [pose.id, pose]),
  );
  const keyPoses = STORY.map(([bar, beat, id], i): KeyPose => {
    const pose = library.get(id);
    if (!pose) throw new Error(`The library has no pose "${id}".`);
    const time = ((bar * BEATS_PER_BAR + beat) * 60) / TEMPO;
    return { id: `k${i + 1}`, time, rotations: pose.rotations, name: pose.name };
  });
  const hash = createHash('sha256')
    .update(readFileSync(folder('demo/song.mp3')))
    .digest('hex');
  const song = { name: 'Warm Circuit', hash, duration, url: 'demo/song.mp3' };
  return { ...createDocument(song, { ...DEFAULT_DIALS, seedClip: SEED_CLIP }), grid: demoGrid(), keyPoses };
}

async function makeDance(document: ProjectDocument, mono: Float32Array, sampleRate: number): Promise<void> {
  const grid = document.grid ?? demoGrid();
  const features = withGrid(analyse(mono, sampleRate).features, grid);
  const { file } = json('models/manifest.json') as { file: string };
  ort.env.wasm.numThreads = 1;
  const session = await openSession(ort, 'wasm', readFileSync(folder(`models/${file}`)));
  const { clips } = json('library/seeds.json') as { clips: SeedClip[] };
  const seedClip = clips.find((clip) => clip.id === SEED_CLIP);
  if (!seedClip) throw new Error(`There is no starting clip "${SEED_CLIP}".`);
  const { keyStrength, variation, seed } = document.dials;
  const motion = await generateMotion(
    {
      features,
      grid,
      frames: Math.ceil((mono.length / sampleRate) * spec.fps),
      keyPoses: document.keyPoses,
      seedClip,
      otherClips: clips,
      options: { keyStrength, variation, seed, cleanFeet: true },
    },
    (inputs) => session.run(inputs),
  );
  await session.close();
  const bytes = encodeMotion(motion);
  writeFileSync(folder('demo/dance.bin'), bytes);
  const speed = jointSpeed(motion);
  const figures = {
    frames: motion.frames,
    bytes: bytes.length,
    consistencyError: consistencyError(motion, document.keyPoses),
    jointSpeed: speed.reduce((sum, value) => sum + value, 0) / speed.length,
    jerk: meanJerk(motion),
    beatHitRate: beatHitRate(motion, grid.beats, 3),
    footSkate: footSkate(motion),
  };
  console.log(
    `dance.bin: ${JSON.stringify(figures, (_, value: unknown) => (typeof value === 'number' ? +value.toPrecision(4) : value))}`,
  );
}

const { values } = parseArgs({ options: { 'document-only': { type: 'boolean', default: false } } });
const wav = execFileSync(
  'ffmpeg',
  ['-v', 'error', '-i', folder('demo/song.mp3'), '-f', 'wav', '-c:a', 'pcm_s16le', '-'],
  {
    maxBuffer: 1 << 28,
  },
);
const pcm = decodeWav(wav);
const mono = mixToMono(pcm.channels);
const document = demoDocument(mono.length / pcm.sampleRate);
const { repairs } = parseDocument(JSON.parse(JSON.stringify(document)));
if (repairs.length > 0) throw new Error(`The demo document is not sound: ${repairs.join(' ')}`);
writeFileSync(folder('demo/demo.json'), JSON.stringify(document) + '\n');
console.log(`demo.json: ${document.keyPoses.length} key poses, ${document.song?.duration} s`);
if (!values['document-only']) await makeDance(document, mono, pcm.sampleRate);
