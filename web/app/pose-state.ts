/** The pose editor, as the page shows it. */
import { signal } from '@preact/signals';
import { DEFAULT_TOOLS } from '../core/default-tools';
import type { PoseClips } from '../core/formats/pose-sequence';
import type { Limb } from '../core/pose-tools';
import type { PoseTools } from '../core/types';

/** A copied pose, or a limb of one. */
export interface PoseClip {
  rotations: readonly number[];
  /** The limb that was copied; null for the whole pose. */
  limb: Limb | null;
  name: string;
}

/** An animation file that a pose is being taken from. */
export interface PoseImport extends PoseClips {
  /** The file's name. */
  file: string;
  /** Which animation of the file. */
  clip: number;
  frame: number;
}

/** A blend that is being tried in the editor. */
export interface PoseBlend {
  /** Name of the other pose. */
  name: string;
  /** 0..1. */
  amount: number;
}

/** The pose in the editor. */
export interface PoseDraft {
  rotations: number[];
  /** The key pose being edited, or null for a new one. */
  keyId: string | null;
  name: string;
  joint: number | null;
  canUndo: boolean;
  canRedo: boolean;
}

/** The signals. */
export function createPoseState() {
  return {
    /** The pose in the editor; null = it is closed. */
    draft: signal<PoseDraft | null>(null),
    poseTools: signal<PoseTools>(DEFAULT_TOOLS),
    /** What was copied in the pose editor last. */
    poseClip: signal<PoseClip | null>(null),
    poseBlend: signal<PoseBlend | null>(null),
    /** How wild random variations are, 0..1. */
    variationAmount: signal(0.4),
    /** A short word on what just happened to the pose, shown over the stage. */
    poseWord: signal(''),
    poseImport: signal<PoseImport | null>(null),
    /** Name of the animation file that is being read, or null. */
    poseImportJob: signal<string | null>(null),
  };
}
