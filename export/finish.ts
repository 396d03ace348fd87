/**
 * The page's own dances for the evaluation: whole clips through `generateMotion` (windows, joins, exact keys, rounded corners, accents,
 * clean feet) with the network on onnxruntime's WASM backend, as a browser runs it. evaluate.py writes the jobs and reads the dances:
 *
 *     npx tsx export/finish.ts JOBS.json
 *
 * Binary files are little-endian float32. A pose is 99 numbers: pelvis position, then 24 quaternions x y z w.
 */
import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import * as ort from 'onnxruntime-web';
import { spec } from '../web/core/spec';
import { JOINT_COUNT } from '../web/core/skeleton';
import type { KeyPose, Motion, SeedClip } from '../web/core/types';
import { generateMotion, type RunWindow } from '../web/core/windows';
import { openSession } from '../web/workers/onnx-session';

const POSE = JOINT_COUNT * 4;
const ROW = 3 + POSE;

/** One way to dance a task. */
interface Run {
  /** The dance is written to this file, beside the jobs. */
  out: string;
  keyStrength: number;
  variation: number;
  seed: number;
  cleanFeet: boolean;
  fillers: boolean;
}

/** Music, keys and an opening, danced in some ways. */
interface Job {
  frames: number;
  /** File: frames x 15. */
  features: string;
  tempo: number;
  beatsPerBar: 3 | 4;
  /** Seconds. */
  beats: number[];
  downbeats: number[];
  /** File: seedFrames x 99; without it the starting clip number `seedClip` opens the dance. */
  opening?: string;
  seedClip: number;
  keyFrames: number[];
  /** File: one row of 24 x 3 axis-angle numbers a key. */
  keyPoses: string;
  runs: Run[];
}

interface Jobs {
  model: string;
  /** The page's starting clips (public/library/seeds.json). */
  seedClips: string;
  jobs: Job[];
}

function floats(path: string): Float32Array {
  const bytes = readFileSync(path);
  return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
}

function toMotion(rows: Float32Array): Motion {
  const frames = rows.length / ROW;
  const motion = {
    fps: spec.fps,
    frames,
    root: new Float32Array(frames * 3),
    quaternions: new Float32Array(frames * POSE),
  };
  for (let t = 0; t < frames; t++) {
    motion.root.set(rows.subarray(t * ROW, t * ROW + 3), t * 3);
    motion.quaternions.set(rows.subarray(t * ROW + 3, (t + 1) * ROW), t * POSE);
  }
  return motion;
}

function toRows({ frames, root, quaternions }: Motion): Float32Array {
  const rows = new Float32Array(frames * ROW);
  for (let t = 0; t < frames; t++) {
    rows.set(root.subarray(t * 3, t * 3 + 3), t * ROW);
    rows.set(quaternions.subarray(t * POSE, (t + 1) * POSE), t * ROW + 3);
  }
  return rows;
}

/** Remembers what the network gave for a window: dances that differ only in what is done afterwards need it once. */
function remembering(run: RunWindow): RunWindow {
  const known = new Map<string, Float32Array>();
  return async (inputs) => {
    const hash = createHash('sha1');
    for (const values of Object.values(inputs)) {
      if (values instanceof Float32Array)
        hash.update(new Uint8Array(values.buffer, values.byteOffset, values.byteLength));
    }
    const key = hash.digest('hex');
    const rows = known.get(key) ?? (await run(inputs));
    known.set(key, rows);
    return rows.slice();
  };
}

async function dance(job: Job, folder: string, clips: SeedClip[], run: RunWindow): Promise<void> {
  const path = (name: string) => join(folder, name);
  const poses = floats(path(job.keyPoses));
  const size = JOINT_COUNT * 3;
  const keyPoses: KeyPose[] = job.keyFrames.map((frame, i) => ({
    id: `key ${i}`,
    time: frame / spec.fps,
    rotations: Array.from(poses.subarray(i * size, (i + 1) * size)),
  }));
  const data = floats(path(job.features));
  const { tempo, beatsPerBar, beats, downbeats, frames } = job;
  for (const { out, ...options } of job.runs) {
    const request = {
      features: { fps: spec.fps, names: spec.features.names, frames: data.length / spec.features.names.length, data },
      grid: { tempo, beatsPerBar, beats, downbeats },
      frames,
      keyPoses,
      seedClip: clips[job.seedClip],
      otherClips: clips,
      ...(job.opening ? { opening: toMotion(floats(path(job.opening))) } : {}),
      options,
    };
    writeFileSync(path(out), toRows(await generateMotion(request, run)));
  }
}

const [list] = process.argv.slice(2);
if (!list) throw new Error('Usage: npx tsx export/finish.ts JOBS.json');
const { model, seedClips, jobs } = JSON.parse(readFileSync(list, 'utf8')) as Jobs;
const { clips } = JSON.parse(readFileSync(seedClips, 'utf8')) as { clips: SeedClip[] };
ort.env.wasm.numThreads = 1;
const session = await openSession(ort, 'wasm', readFileSync(model));
for (const job of jobs) {
  await dance(
    job,
    dirname(list),
    clips,
    remembering((inputs) => session.run(inputs)),
  );
}
await session.close();
