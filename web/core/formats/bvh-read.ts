/**
 * BVH motion capture files (the text format of Biovision; Meredith and Maddock 2001, "Motion capture file formats explained", section 3):
 * a tree of joints with offsets, then one line of channel values per frame. Rotations are Euler angles in degrees, applied in the order
 * in which their channels are listed.
 */
import { multiply, type Numbers } from '../rotation';
import { JOINT_COUNT } from '../skeleton';
import { axisOf, frameStep, meanUp, turnUpright, type PoseClips, type PoseSequence } from './pose-sequence';
import { Retargeter } from './retarget';

const MAX_JOINTS = 1000;
const MAX_DEPTH = 200;
const RADIANS = Math.PI / 180;
/** How surely the head is over the feet along an axis: cosine. */
const UPRIGHT = 0.75;
/** End sites have no name in the file. */
const END = 'End Site';

interface Joint {
  name: string;
  parent: number;
  offset: [number, number, number];
  /** Axis and place among the values of a frame, in order. */
  turns: { axis: number; value: number }[];
}

interface Hierarchy {
  joints: Joint[];
  /** Values per frame. */
  channels: number;
  /** First line after `MOTION`. */
  next: number;
}

const number = (text: string | undefined, line: number): number => {
  const value = text === undefined || text === '' ? NaN : Number(text);
  if (!Number.isFinite(value))
    throw new Error(`Line ${line + 1} of the BVH file should hold numbers: the file is damaged.`);
  return value;
};

function readHierarchy(lines: readonly string[]): Hierarchy {
  const joints: Joint[] = [];
  const open: number[] = [];
  let pending = -1;
  let channels = 0;
  let roots = 0;
  let skipped = false;
  for (let i = 1; i < lines.length; i++) {
    // A brace may stand at the end of its joint's line.
    const inline = lines[i].length > 1 && lines[i].endsWith('{');
    const line = inline ? lines[i].slice(0, -1).trim() : lines[i];
    const [word, ...rest] = line.split(/\s+/);
    const key = word.toUpperCase();
    if (key === 'MOTION') {
      if (open.length > 0 || joints.length === 0) break;
      return { joints, channels, next: i + 1 };
    }
    if (key === 'ROOT' || key === 'JOINT' || key === 'END') {
      if (key === 'ROOT') skipped = roots++ > 0;
      if (joints.length >= MAX_JOINTS || open.length >= MAX_DEPTH) {
        throw new Error('This BVH file has more joints than any body: it cannot be read.');
      }
      // Of several figures the first is read; the others count only for their channels.
      const name = key === 'END' || skipped ? END : rest.join(' ');
      pending = joints.push({ name, parent: open.at(-1) ?? -1, offset: [0, 0, 0], turns: [] }) - 1;
    } else if (key === 'OFFSET') {
      const at = open.at(-1);
      if (at === undefined) break;
      joints[at].offset = [number(rest[0], i), number(rest[1], i), number(rest[2], i)];
    } else if (key === 'CHANNELS') {
      const at = open.at(-1);
      const count = number(rest[0], i);
      if (at === undefined || count !== rest.length - 1 || count > 12) break;
      for (const channel of rest.slice(1)) {
        const turn = /^([XYZ])rotation$/i.exec(channel);
        if (turn) joints[at].turns.push({ axis: 'XYZ'.indexOf(turn[1].toUpperCase()), value: channels });
        channels += 1;
      }
    }
    if (inline || key === '{') {
      if (pending < 0) break;
      open.push(pending);
      pending = -1;
    } else if (key === '}' && open.pop() === undefined) break;
  }
  throw new Error('The joints of this BVH file could not be read: it is damaged or cut off.');
}

function restPositions(joints: readonly Joint[]): Float64Array {
  const positions = new Float64Array(joints.length * 3);
  joints.forEach(({ parent, offset }, joint) => {
    for (let k = 0; k < 3; k++) positions[joint * 3 + k] = (parent < 0 ? 0 : positions[parent * 3 + k]) + offset[k];
  });
  return positions;
}

/** World rotations of all joints from one frame's values. */
function worldTurns(joints: readonly Joint[], values: Numbers, out: Float64Array): void {
  const turn = [0, 0, 0, 1];
  joints.forEach(({ parent, turns }, joint) => {
    const world = parent < 0 ? [0, 0, 0, 1] : Array.from(out.subarray(parent * 4, parent * 4 + 4));
    for (const { axis, value } of turns) {
      const half = (values[value] * RADIANS) / 2;
      turn.fill(0);
      turn[axis] = Math.sin(half);
      turn[3] = Math.cos(half);
      multiply(world, turn, world);
    }
    out.set(world, joint * 4);
  });
}

/** The way up: of the rest pose, where that stands on +Y; else of the motion, whose world may be another than the rest pose's. */
function upOf(rest: Numbers, sequence: PoseSequence): Numbers {
  const standing = axisOf(rest, UPRIGHT);
  if (standing && standing[1] === 1) return standing;
  return axisOf(meanUp(sequence), UPRIGHT) ?? standing ?? [0, 1, 0];
}

/**
 * Reads a BVH file.
 * @param text - The whole file.
 * @throws Error with a sentence for the visitor when it is none, damaged, or no human body
 */
export function readBvh(text: string): PoseClips {
  const lines = text.split(/\r\n|\r|\n/).flatMap((line) => line.trim() || []);
  if (lines[0]?.toUpperCase() !== 'HIERARCHY')
    throw new Error('This is no BVH file: it does not begin with HIERARCHY.');
  const { joints, channels, next } = readHierarchy(lines);
  const frames = number(/^frames:\s*(\d+)$/i.exec(lines[next] ?? '')?.[1], next);
  const seconds = number(/^frame time:\s*(\S+)$/i.exec(lines[next + 1] ?? '')?.[1], next + 1);
  if (frames < 1) throw new Error('This BVH file has no frames.');
  const first = next + 2;
  // The count is not believed before the lines are there.
  if (lines.length - first < frames) {
    throw new Error(
      `This BVH file should have ${frames} frames but ends after ${Math.max(0, lines.length - first)}: it is cut off.`,
    );
  }
  const retargeter = new Retargeter({
    names: joints.map((joint) => joint.name),
    parents: joints.map((joint) => joint.parent),
    positions: restPositions(joints),
    rotations: Float64Array.from({ length: joints.length * 4 }, (_, i) => (i % 4 === 3 ? 1 : 0)),
  });
  const step = frameStep(frames);
  const kept = Math.ceil(frames / step);
  const quaternions = new Float32Array(kept * JOINT_COUNT * 4);
  const world = new Float64Array(joints.length * 4);
  for (let frame = 0; frame < kept; frame++) {
    const line = first + frame * step;
    const values = lines[line].split(/\s+/).map((value) => number(value, line));
    if (values.length < channels) {
      throw new Error(`Frame ${frame * step + 1} of the BVH file has ${values.length} values instead of ${channels}.`);
    }
    worldTurns(joints, values, world);
    retargeter.pose(world, quaternions, frame * JOINT_COUNT * 4);
  }
  const fps = seconds > 0 ? 1 / seconds / step : 0;
  const clip: PoseSequence = { name: '', fps, frames: kept, quaternions };
  turnUpright(clip, upOf(retargeter.up, clip));
  return { kind: 'BVH', clips: [clip] };
}
