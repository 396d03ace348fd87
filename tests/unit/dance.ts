/** Made-up songs, clips and a network of plain interpolation: enough to make whole dances without a model. */
import { emptyMotion } from '../../web/core/motion';
import { quaternionToSixD, sixDToQuaternion, slerp } from '../../web/core/rotation';
import { jointIndex } from '../../web/core/skeleton';
import { spec } from '../../web/core/spec';
import type { BeatGrid, Features, KeyPose, Motion, SeedClip } from '../../web/core/types';
import type { GenerationRequest, WindowInputs } from '../../web/core/windows';

const { motionSize, rotationSize } = spec.model;

/** A steady grid in 4/4. */
export function steadyGrid(seconds: number, tempo = 120, first = 0.3): BeatGrid {
  const beats: number[] = [];
  for (let time = first; time < seconds; time += 60 / tempo) beats.push(time);
  return { tempo, beatsPerBar: 4, beats, downbeats: beats.filter((_, i) => i % 4 === 0) };
}

/** Features of a song with clicks on its beats and one held note. */
export function clickFeatures(seconds: number, grid: BeatGrid): Features {
  const frames = Math.ceil(seconds * spec.fps);
  const names = spec.features.names;
  const data = new Float32Array(frames * names.length);
  for (let t = 0; t < frames; t++) data[t * names.length] = 1;
  const mark = (time: number, name: string) => {
    const t = Math.round(time * spec.fps);
    if (t < frames) data[t * names.length + names.indexOf(name)] = 1;
  };
  for (const beat of grid.beats) {
    mark(beat, 'beat');
    mark(beat, 'onset');
  }
  for (const beat of grid.downbeats) mark(beat, 'downbeat');
  return { fps: spec.fps, names, frames, data };
}

/** A pose that is the T-pose but for some joints, axis-angle by joint name. */
export function poseWith(turns: Record<string, [number, number, number]>): number[] {
  const pose = new Array<number>(72).fill(0);
  for (const [name, turn] of Object.entries(turns)) turn.forEach((v, k) => (pose[jointIndex(name) * 3 + k] = v));
  return pose;
}

/** A step to the left and to the right with swinging arms: four beats, two poses a beat. */
export function stepClip(): SeedClip {
  const poses = Array.from({ length: 8 }, (_, i) => {
    const phase = (i / 8) * 2 * Math.PI;
    const [left, right] = [Math.max(0, Math.sin(phase)), Math.max(0, -Math.sin(phase))];
    return poseWith({
      left_hip: [-0.7 * left, 0, 0.1],
      left_knee: [1.2 * left, 0, 0],
      right_hip: [-0.7 * right, 0, -0.1],
      right_knee: [1.2 * right, 0, 0],
      left_shoulder: [0, 0.5 * Math.sin(phase), -1 + 0.4 * Math.cos(phase)],
      right_shoulder: [0, 0.5 * Math.sin(phase), 1 - 0.4 * Math.cos(phase)],
      spine1: [0.1 * Math.cos(2 * phase), 0, 0],
    });
  });
  return {
    id: 'step',
    name: 'Step',
    description: 'Test clip',
    beats: 4,
    rate: 2,
    poses,
    root: poses.map(() => [0, 0.95, 0]),
  };
}

/** Interpolation between the neighbouring keys, as the trained model's base; the root stands where the seed ends. */
export async function slerpNetwork(inputs: WindowInputs): Promise<Float32Array> {
  const { frames, seedFrames, keyPoses, toPrevious, toNext } = inputs;
  const rows = new Float32Array(frames * motionSize);
  const last = inputs.seed.subarray((seedFrames - 1) * motionSize, seedFrames * motionSize);
  const keyAt = (t: number) => keyPoses.subarray(t * rotationSize, (t + 1) * rotationSize);
  for (let t = 0; t < frames; t++) {
    const before = toPrevious[t] >= 0 ? keyAt(t - toPrevious[t]) : last;
    const after = toNext[t] >= 0 ? keyAt(t + toNext[t]) : before;
    const back = toPrevious[t] >= 0 ? toPrevious[t] : t + 1;
    const share = toNext[t] >= 0 ? back / Math.max(1, back + toNext[t]) : 0;
    for (let i = 0; i < rotationSize; i += 6) {
      const q = slerp(sixDToQuaternion(before.subarray(i, i + 6)), sixDToQuaternion(after.subarray(i, i + 6)), share);
      rows.set(Array.from(quaternionToSixD(q)), t * motionSize + i);
    }
    rows.set(last.subarray(rotationSize), t * motionSize + rotationSize);
  }
  return rows;
}

/** A request for a dance of some seconds; everything can be overridden. */
export function danceRequest(seconds: number, overrides: Partial<GenerationRequest> = {}): GenerationRequest {
  const grid = steadyGrid(seconds);
  return {
    features: clickFeatures(seconds, grid),
    grid,
    frames: Math.ceil(seconds * spec.fps),
    keyPoses: [],
    seedClip: stepClip(),
    options: { keyStrength: 1, variation: 0.4, seed: 1, cleanFeet: true },
    ...overrides,
  };
}

/** A key pose. */
export function key(time: number, rotations: number[]): KeyPose {
  return { id: `k${time}`, time, rotations };
}

/** A dance in which every joint swings smoothly, standing at the origin. */
export function swingingMotion(frames: number): Motion {
  const motion = emptyMotion(frames);
  for (let t = 0; t < frames; t++) {
    motion.root.set([0, 0.955, 0], t * 3);
    for (let joint = 1; joint < 24; joint++) {
      const half = 0.1 * Math.sin(t / 9 + joint);
      motion.quaternions.set([Math.sin(half), 0, 0, Math.cos(half)], (t * 24 + joint) * 4);
    }
  }
  return motion;
}
