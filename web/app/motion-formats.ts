/** Motion files: which there are and what they are made from. What writes them is in `motion-file.ts`, for the worker alone. */
import type { GlbFigure } from '../core/formats/glb-write';
import type { MotionNotes } from '../core/formats/motion-json';
import type { Motion } from '../core/types';
import type { AvatarSource } from '../scene/avatar';

/** Formats of motion files; `avatar` is the visitor's own character with the dance. */
export const MOTION_FORMATS = ['bvh', 'glb', 'fbx', 'npz', 'json', 'avatar'] as const;
/** One of them. */
export type MotionFormat = (typeof MOTION_FORMATS)[number];
/** Frame rates that are offered. */
export const FRAME_RATES = [24, 30, 60, 120] as const;

/** All that a file is made from. */
export interface MotionFileRequest {
  format: MotionFormat;
  /** The part of the dance that is wanted. */
  motion: Motion;
  /** Frames per second of the file. */
  fps: number;
  /** BVH: what a unit of length is. */
  units: 'm' | 'cm';
  /** Name of the animation. */
  name: string;
  notes: MotionNotes;
  /** GLB and FBX: the figure that dances; missing = the skeleton alone. */
  figure?: GlbFigure;
  /** `avatar`: the character. */
  avatar?: AvatarSource;
}

/** What browsers call the formats. */
export const MOTION_TYPES: Readonly<Record<MotionFormat, string>> = {
  bvh: 'text/plain',
  glb: 'model/gltf-binary',
  fbx: 'application/octet-stream',
  npz: 'application/zip',
  json: 'application/json',
  avatar: 'model/gltf-binary',
};

/** What a file's name ends with. */
export const extensionOf = (format: MotionFormat): string => (format === 'avatar' ? 'glb' : format);

/** Bytes per frame and of the rest, measured on dances of ours. */
const SIZES: Readonly<Record<MotionFormat, { frame: number; rest: number }>> = {
  bvh: { frame: 745, rest: 3000 },
  glb: { frame: 400, rest: 8000 },
  fbx: { frame: 660, rest: 84_000 },
  npz: { frame: 540, rest: 3000 },
  json: { frame: 920, rest: 2500 },
  // And the character's own file.
  avatar: { frame: 370, rest: 5000 },
};
/** What the figure adds: its mesh and its helper bones. */
const FIGURE: Readonly<Partial<typeof SIZES>> = {
  glb: { frame: 330, rest: 1_500_000 },
  fbx: { frame: 925, rest: 3_000_000 },
};

/** About how many bytes a file will have. */
export function estimateBytes(format: MotionFormat, frames: number, figure: boolean): number {
  const sizes = [SIZES[format], ...(figure && FIGURE[format] ? [FIGURE[format]] : [])];
  return sizes.reduce((sum, { frame, rest }) => sum + frame * frames + rest, 0);
}
