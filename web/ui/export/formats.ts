/** The formats of the export panel: what each is for, and what can be chosen. */
import { estimateBytes, type MotionFormat } from '../../app/motion-formats';

/** Motion files, frame by frame, and the curves of a dance that has them. */
export type CardFormat = MotionFormat | 'curves';

/** A card of the panel. */
export interface FormatCard {
  format: CardFormat;
  name: string;
  /** Which program opens it. */
  text: string;
  /** A word to what is chosen below. */
  hint?: string;
  /** What can be chosen; frames per second and the part wherever there are frames. */
  choices: readonly ('units' | 'figure' | 'curves')[];
}

/** In the order of the panel. */
export const FORMAT_CARDS: readonly FormatCard[] = [
  {
    format: 'glb',
    name: 'GLB',
    text: 'A 3D figure that dances, for Blender, Unreal, Godot and the web.',
    choices: ['figure'],
  },
  {
    format: 'fbx',
    name: 'FBX',
    text: 'The dancing figure for Unity, Maya, 3ds Max and Cinema 4D.',
    hint: 'One unit is a centimetre, as in Maya and Unreal.',
    choices: ['figure'],
  },
  {
    format: 'bvh',
    name: 'BVH',
    text: 'The skeleton’s motion, for Blender, Maya, MotionBuilder and most animation programs.',
    hint: 'Most programs take one unit for a centimetre.',
    choices: ['units'],
  },
  {
    format: 'npz',
    name: 'SMPL (npz)',
    text: 'SMPL rotations for Python and machine learning, under the names of AIST++ and AMASS.',
    hint: 'Tools for AIST++ expect 60 frames per second. Translations are the pelvis’s place, in metres.',
    choices: [],
  },
  {
    format: 'json',
    name: 'JSON',
    text: 'Rotations, places, beats and key poses as plain text, for programs of your own.',
    choices: [],
  },
  {
    format: 'avatar',
    name: 'Your character (GLB)',
    text: 'Your own character, its file with the dance in it, for whatever opens the character.',
    hint: 'Everything else in the file stays as it is. Hair and skirts are swung by the program that shows it.',
    choices: [],
  },
  {
    format: 'curves',
    name: 'Curves',
    text: 'Keys at your key poses with curves between them, to go on editing in Blender, Unity or Unreal.',
    choices: ['curves', 'figure'],
  },
];

/** About how many bytes a file of curves has, measured on dances of ours; with our figure, the frames of its helper bones. */
export function curveBytes(as: 'glb' | 'json', keys: number, figureFrames: number): number {
  if (as === 'json') return 3000 + 5300 * keys;
  return (
    8000 +
    3700 * keys +
    (figureFrames > 0 ? estimateBytes('glb', figureFrames, true) - estimateBytes('glb', figureFrames, false) : 0)
  );
}

/** Bytes as people read them. */
export function sizeText(bytes: number): string {
  if (bytes < 1e5) return `${Math.max(1, Math.round(bytes / 1e3))} kB`;
  return bytes < 1e7 ? `${(bytes / 1e6).toFixed(1)} MB` : `${Math.round(bytes / 1e6)} MB`;
}
