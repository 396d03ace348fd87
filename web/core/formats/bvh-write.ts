/**
 * BVH files: our 24 joints, end sites at the head, hands and toes, the rest pose a true T-pose (Y up, facing +Z, arms along X), one line
 * per frame. Every joint has the channels Zrotation Yrotation Xrotation, degrees; the root has Xposition Yposition Zposition before them.
 */
import { JOINT_COUNT, jointIndex, JOINTS, OFFSETS, PARENTS } from '../skeleton';
import type { Motion } from '../types';
import { quaternionToZyx } from './euler-zyx';

/** How a BVH file is written. */
export interface BvhOptions {
  /** Metres or centimetres; most animation programs take a BVH unit for a centimetre. */
  units: 'm' | 'cm';
  /** Hears of the progress, 0..1. */
  progress?: (fraction: number) => void;
}

/** Where the body ends beyond its last joints, metres, from the figure's surface: only for programs that draw bones. */
const TIPS: readonly (readonly [string, readonly [number, number, number]])[] = [
  ['head', [0, 0.19, 0]],
  ['left_foot', [0, -0.01, 0.085]],
  ['right_foot', [0, -0.01, 0.085]],
  ['left_hand', [0.09, -0.01, 0]],
  ['right_hand', [-0.09, -0.01, 0]],
];
const TURNS = 'Zrotation Yrotation Xrotation';
const DEGREES = 180 / Math.PI;
/** Digits after the point: a millionth of a degree, a micrometre or less. */
const DIGITS = 6;
/** Frames between two words on the progress. */
const STEP = 500;

/** Fixed digits without a minus on zero. */
const fixed = (value: number) => {
  const text = value.toFixed(DIGITS);
  return text === '-0.000000' ? '0.000000' : text;
};

/**
 * Writes a BVH file at the dance's own frame rate.
 * @throws Error when the dance has no frames
 */
export function writeBvh(motion: Motion, { units, progress }: BvhOptions): string {
  const { frames, fps, root, quaternions } = motion;
  if (frames < 1) throw new Error('The dance has no frames yet: generate it first.');
  const scale = units === 'cm' ? 100 : 1;
  const order: number[] = [];
  const lines = ['HIERARCHY', ...branch(0, 0, scale, order)];
  lines.push('MOTION', `Frames: ${frames}`, `Frame Time: ${(1 / fps).toFixed(10)}`);
  const angles = JOINTS.map((): [number, number, number] => [0, 0, 0]);
  for (let frame = 0; frame < frames; frame++) {
    const values: string[] = [];
    for (let k = 0; k < 3; k++) values.push(fixed(root[frame * 3 + k] * scale));
    for (const joint of order) {
      const at = (frame * JOINT_COUNT + joint) * 4;
      angles[joint] = quaternionToZyx(quaternions.subarray(at, at + 4), angles[joint]);
      for (const angle of angles[joint]) values.push(fixed(angle * DEGREES));
    }
    lines.push(values.join(' '));
    if (frame % STEP === STEP - 1) progress?.(frame / frames);
  }
  return `${lines.join('\n')}\n`;
}

/** A joint and all below it; `order` gets the joints in the order of their channels. */
function branch(joint: number, depth: number, scale: number, order: number[]): string[] {
  order.push(joint);
  const tab = '\t'.repeat(depth);
  const place = (offset: readonly number[]) => offset.map((value) => fixed(value * scale)).join(' ');
  const children = [...JOINTS.keys()].filter((each) => PARENTS[each] === joint);
  const tip = TIPS.find(([name]) => jointIndex(name) === joint)?.[1];
  return [
    `${tab}${depth === 0 ? 'ROOT' : 'JOINT'} ${JOINTS[joint]}`,
    `${tab}{`,
    // The root's place is in its channels: an offset as well would count twice in some readers.
    `${tab}\tOFFSET ${place(OFFSETS[joint])}`,
    `${tab}\tCHANNELS ${depth === 0 ? `6 Xposition Yposition Zposition ${TURNS}` : `3 ${TURNS}`}`,
    ...children.flatMap((child) => branch(child, depth + 1, scale, order)),
    ...(tip ? [`${tab}\tEnd Site`, `${tab}\t{`, `${tab}\t\tOFFSET ${place(tip)}`, `${tab}\t}`] : []),
    `${tab}}`,
  ];
}
