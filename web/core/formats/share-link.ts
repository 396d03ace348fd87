/**
 * A project as the end of an address: `#d=`, a version, a full stop, and base64url (RFC 4648, without padding) of
 *
 * - the CRC-32 of all that follows, 4 bytes, little-endian: a link that was not copied whole is told from another dance;
 * - raw deflate (RFC 1951) of the parts in `share-parts.ts`.
 *
 * Version 2 has parts that version 1 has no place for; a project without them is written as version 1, which every page reads.
 *
 * What comes after `#` never reaches a server. Key poses and starting clips are rounded to 8 bits a number ({@link POSE_STEP}), beats
 * that a person played to a millisecond; all else is exact. Left out are the camera, a starting clip that is not chosen, and the address
 * of the song: a link must not make a page fetch anything from its author's address.
 */
import { deflateSync } from 'fflate';
import type { ProjectDocument } from '../document';
import { parseDocument } from '../document-read';
import { ByteReader, ByteWriter, DamagedBytes } from './byte-pack';
import { inflateWithin } from './inflate';
import { furtherParts, readParts, writeParts } from './share-parts';
import { POSE_STEP } from './share-pose';
import { crc32 } from './zip-read';

export { POSE_STEP };

/** Newest version of the form; it stands in the link itself. */
const VERSION = 2;
const LINK = /^#?d=(\d{1,6})\.([A-Za-z0-9_-]*)/;
/** Longer links are refused before anything is unpacked, characters. */
const MAX_READ = 100_000;
/** Most that a link may unpack to, bytes: the largest project that fits MAX_READ is far below. */
const MAX_BYTES = 1 << 20;
const ALPHABET = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_';

/** A project that came by a link. */
export interface SharedProject {
  document: ProjectDocument;
  /** Name of the model that made the dance, as its author's page said; empty where none was made. */
  model: string;
  /** A sentence for each thing that had to be repaired. */
  repairs: string[];
}

const damaged = () => new Error('This link is damaged or was not copied completely: copy it again, whole.');

/** True when the part of an address from `#` on is a link to a dance, whole or not. */
export function isLink(hash: string): boolean {
  return /^#?d=/.test(hash);
}

/** True for a link that only a newer page can read. */
export function isNewerLink(hash: string): boolean {
  return Number(LINK.exec(hash)?.[1] ?? 0) > VERSION;
}

/**
 * Writes a project as the end of an address, `#` included.
 *
 * @param model - Name of the model that made the dance, at most 200 characters; empty for none.
 */
export function writeLink(document: ProjectDocument, model = ''): string {
  let shortest: Uint8Array | null = null;
  const further = furtherParts(document);
  // Which order of the poses packs better depends on the poses.
  for (const byJoint of [false, true]) {
    const writer = new ByteWriter();
    writeParts(writer, document, model.slice(0, 200), byJoint, further);
    const packed = deflateSync(Uint8Array.from(writer.bytes), { level: 9, mem: 8 });
    if (!shortest || packed.length < shortest.length) shortest = packed;
  }
  const bytes = new Uint8Array(4 + shortest!.length);
  new DataView(bytes.buffer).setUint32(0, crc32(shortest!), true);
  bytes.set(shortest!, 4);
  return `#d=${further.length > 0 ? 2 : 1}.${toBase64Url(bytes)}`;
}

/**
 * Reads a link from anybody. Marks that a message put after it (a full stop, a bracket) do not matter.
 *
 * @param hash - The part of the address from `#` on.
 * @throws Error with a sentence for the visitor when it is damaged, too long, or of a newer version.
 */
export function readLink(hash: string): SharedProject {
  const found = LINK.exec(hash.length > MAX_READ ? '' : hash);
  if (hash.length > MAX_READ) {
    throw new Error('This link is too long to be a dance: ask for the project as a .posebeat file.');
  }
  if (!found) throw damaged();
  const version = Number(found[1]);
  if (isNewerLink(hash)) {
    throw new Error('This link was made by a newer Posebeat: reload the page to get the newest version.');
  }
  if (version < 1) throw damaged();
  const bytes = fromBase64Url(found[2]);
  if (!bytes || bytes.length < 5) throw damaged();
  const packed = bytes.subarray(4);
  if (crc32(packed) !== new DataView(bytes.buffer).getUint32(0, true)) throw damaged();
  const parts = inflateWithin(packed, MAX_BYTES);
  if (!parts) throw damaged();
  try {
    const { document, model, unknown } = readParts(new ByteReader(parts), version);
    const parsed = parseDocument(document);
    if (unknown)
      parsed.repairs.push('A newer Posebeat made it, and something of it is not known here: reload the page.');
    return { ...parsed, model };
  } catch (error) {
    if (error instanceof DamagedBytes) throw damaged();
    throw error;
  }
}

/** Three bytes as four characters; what is left over as two or three. */
function toBase64Url(bytes: Uint8Array): string {
  let text = '';
  for (let at = 0; at < bytes.length; at += 3) {
    const group = (bytes[at] << 16) | ((bytes[at + 1] ?? 0) << 8) | (bytes[at + 2] ?? 0);
    const size = Math.min(3, bytes.length - at) + 1;
    for (let i = 0; i < size; i += 1) text += ALPHABET[(group >> (18 - 6 * i)) & 63];
  }
  return text;
}

/** Null for text that no writer makes: every link has one form only. */
function fromBase64Url(text: string): Uint8Array | null {
  if (text.length % 4 === 1) return null;
  const bytes = new Uint8Array(Math.floor((text.length * 3) / 4));
  let bits = 0;
  let held = 0;
  let at = 0;
  for (const character of text) {
    held = ((held << 6) | ALPHABET.indexOf(character)) & 0xffff;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes[at++] = (held >> bits) & 255;
  }
  return (held & ((1 << bits) - 1)) === 0 ? bytes : null;
}
