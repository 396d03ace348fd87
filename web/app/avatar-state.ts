/** Characters of the visitor's own, as the page shows them. */
import { signal } from '@preact/signals';
import type { AvatarFigure, AvatarSource } from '../scene/avatar';
import type { KeptAvatar } from './avatar-store';

/** A character that dances in the place of our figure. */
export interface AvatarInUse {
  id: string;
  name: string;
  /** What it is made from: can be posted to a worker. */
  source: AvatarSource;
  figure: AvatarFigure;
}

/** A bone that can be chosen. */
export interface BoneChoice {
  node: number;
  name: string;
}

/** Which bone is which, while the visitor looks through it. The character is on the stage meanwhile. */
export interface AvatarMapping extends AvatarInUse {
  bones: readonly BoneChoice[];
  /** Our joints that can have bones. */
  joints: readonly number[];
  /** For each of our 24 joints a node of the file; -1 = none. */
  map: readonly number[];
  /** What was guessed from names and places. */
  guess: readonly number[];
  /** The names said nothing: the guess is from places alone. */
  byShape: boolean;
  /** For each joint what is wrong with it, in a few words; null = nothing. */
  problems: readonly (string | null)[];
  /** What is wrong with the whole. */
  notes: readonly string[];
  /** True when the character can dance like this. */
  usable: boolean;
  /** The joint that is pointed at on the stage. */
  joint: number | null;
}

/** The signals. */
export function createAvatarState() {
  return {
    /** The character on stage; null = our own figure. */
    avatar: signal<AvatarInUse | null>(null),
    /** Those that can be chosen. */
    avatars: signal<readonly KeptAvatar[]>([]),
    /** Name of the file that is being opened, or null. */
    avatarJob: signal<string | null>(null),
    /** The dialog of bones, or null. */
    avatarMapping: signal<AvatarMapping | null>(null),
    /** A file that could be a character or a motion: which is asked. */
    avatarQuestion: signal<File | null>(null),
  };
}
