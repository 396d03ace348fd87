/**
 * The `.posebeat` file: the project document alone as JSON text, or a zip of `project.json` and the song's own bytes.
 * Saves of older versions (JSON) open as well; which of the two it is shows in the first bytes, not in the name.
 */
import { zipSync } from 'fflate';
import * as v from 'valibot';
import type { ProjectDocument } from '../document';
import { parseDocument } from '../document-read';
import { isZip, zipEntries } from './zip-read';

/** Name of the document inside the zip. */
const DOCUMENT_ENTRY = 'project.json';
/** Name of the song inside the zip, with the extension that its file had. */
const SONG_ENTRY = /^song(\.[a-z0-9]{1,5})?$/i;
/** Larger documents are no project of a person: 5000 key poses have some 8 MB. */
const MAX_DOCUMENT_BYTES = 50e6;
/** Largest song that goes into a project, bytes: half an hour of uncompressed stereo. */
export const MAX_SONG_BYTES = 320e6;
/** Larger files are refused before they are read. */
export const MAX_PROJECT_BYTES = MAX_SONG_BYTES + MAX_DOCUMENT_BYTES;
/** A fixed date: the same project always gives the same bytes. */
const SAVED_AT = new Date(1980, 0, 1);

/** The dance that a project had when it was saved, to tell whether it was made the same again. It is no part of the document. */
export interface SavedMotion {
  /** Of the quantised motion (motion-quantised.ts), SHA-256. */
  motionHash: string;
  /** What made it; empty where that is no longer known. */
  model: string;
  backend: string;
}

const savedMotion = v.object({
  motionHash: v.pipe(v.string(), v.maxLength(128)),
  model: v.pipe(v.string(), v.maxLength(200)),
  backend: v.pipe(v.string(), v.maxLength(50)),
});

/** What a project file held. */
export interface ProjectFile {
  document: ProjectDocument;
  /** Null where none was made, or the file does not say. */
  motion: SavedMotion | null;
  /** A sentence for each thing that had to be repaired. */
  repairs: string[];
  /** The song's original bytes, where they are inside. Nobody has checked yet that they are the document's song. */
  song: Uint8Array | null;
}

/**
 * Writes a project as a file.
 *
 * @param song - The song's original bytes, to be put inside; they are stored as they are, for music does not get smaller.
 * @param motion - The dance on stage, where there is one.
 * @returns JSON text without a song, a zip with one.
 */
export function writeProject(
  document: ProjectDocument,
  song?: Uint8Array | null,
  motion?: SavedMotion | null,
): Uint8Array<ArrayBuffer> {
  const json = new TextEncoder().encode(JSON.stringify(motion ? { ...document, motion } : document));
  if (!song) return json;
  const extension = /\.[a-z0-9]{1,5}$/i.exec(document.song?.name ?? '')?.[0].toLowerCase() ?? '';
  return zipSync({
    [DOCUMENT_ENTRY]: [json, { level: 6, mtime: SAVED_AT }],
    [`song${extension}`]: [song, { level: 0, mtime: SAVED_AT }],
  });
}

/**
 * Reads a project file of any version, from anybody.
 *
 * @param bytes - The whole file.
 * @throws Error with a sentence for the visitor when it is no project, damaged, too large or of a newer version.
 */
export function readProject(bytes: Uint8Array): ProjectFile {
  if (!isZip(bytes)) return { ...readDocument(bytes), song: null };
  const entries = zipEntries(bytes);
  const documents = entries.filter((entry) => entry.name === DOCUMENT_ENTRY);
  const songs = entries.filter((entry) => SONG_ENTRY.test(entry.name));
  if (documents.length === 0) throw new Error('This zip holds no Posebeat project: choose a file that Posebeat saved.');
  if (documents.length > 1 || songs.length > 1) {
    throw new Error('The file holds two projects in one: it was not made by Posebeat.');
  }
  // The document first: what is wrong with it is worth more words than a damaged song.
  const parsed = readDocument(documents[0].read(MAX_DOCUMENT_BYTES));
  return { ...parsed, song: songs[0]?.read(MAX_SONG_BYTES) ?? null };
}

function readDocument(bytes: Uint8Array): Omit<ProjectFile, 'song'> {
  const json = parseJson(bytes);
  const parsed = parseDocument(json);
  const motion = v.safeParse(savedMotion, (json as { motion?: unknown }).motion);
  return { ...parsed, motion: motion.success ? motion.output : null };
}

function parseJson(bytes: Uint8Array): unknown {
  if (bytes.length === 0) throw new Error('The file is empty: choose another one.');
  if (bytes.length > MAX_DOCUMENT_BYTES) throw new Error('This file is too large for a Posebeat project.');
  try {
    return JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes));
  } catch {
    throw new Error('This file is no Posebeat project: it is damaged or of another kind.');
  }
}
