/** Reads single files out of a zip that nobody vouches for (PKWARE APPNOTE 6.3.10): nothing is inflated beyond what the caller allows. */
import { inflateWithin } from './inflate';

const END_SIGNATURE = 0x06054b50;
const ENTRY_SIGNATURE = 0x02014b50;
const LOCAL_SIGNATURE = 0x04034b50;
const END_SIZE = 22;
const ENTRY_SIZE = 46;
const LOCAL_SIZE = 30;
/** The end record may be followed by a comment of this many bytes. */
const MAX_COMMENT = 0xffff;
/** More files than this are in no zip of ours. */
const MAX_ENTRIES = 1000;
const STORED = 0;
const DEFLATED = 8;

/** A file in a zip, not yet unpacked. */
export interface ZipEntry {
  name: string;
  /** Bytes after unpacking, as the zip claims. */
  size: number;
  /**
   * Unpacks the file.
   * @param limit - Bytes that it may have at most.
   * @throws Error when it has more, is damaged, or is packed in an unknown way.
   */
  read(limit: number): Uint8Array;
}

const damaged = () => new Error('The file is damaged or was not copied completely: get it again.');

/** True when the bytes begin like a zip. */
export function isZip(bytes: Uint8Array): boolean {
  return bytes.length >= 4 && bytes[0] === 0x50 && bytes[1] === 0x4b && (bytes[2] === 3 || bytes[2] === 5);
}

/**
 * Lists the files of a zip.
 *
 * @param bytes - The whole zip.
 * @throws Error when it is cut off, damaged, or holds more files than any of ours.
 */
export function zipEntries(bytes: Uint8Array): ZipEntry[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const end = endRecord(view);
  const count = view.getUint16(end + 10, true);
  if (count > MAX_ENTRIES) throw new Error(`The file holds ${count} parts: a Posebeat project has two at most.`);
  const entries: ZipEntry[] = [];
  let at = view.getUint32(end + 16, true);
  for (let i = 0; i < count; i += 1) {
    if (at + ENTRY_SIZE > end || view.getUint32(at, true) !== ENTRY_SIGNATURE) throw damaged();
    const nameLength = view.getUint16(at + 28, true);
    const next = at + ENTRY_SIZE + nameLength + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
    if (next > end) throw damaged();
    const header: Header = {
      method: view.getUint16(at + 10, true),
      check: view.getUint32(at + 16, true),
      packed: view.getUint32(at + 20, true),
      size: view.getUint32(at + 24, true),
      local: view.getUint32(at + 42, true),
    };
    const name = new TextDecoder().decode(bytes.subarray(at + ENTRY_SIZE, at + ENTRY_SIZE + nameLength));
    entries.push({ name, size: header.size, read: (limit) => unpack(bytes, view, header, limit) });
    at = next;
  }
  return entries;
}

interface Header {
  method: number;
  /** CRC-32 of the unpacked bytes. */
  check: number;
  packed: number;
  size: number;
  local: number;
}

function endRecord(view: DataView): number {
  const last = view.byteLength - END_SIZE;
  for (let at = last; at >= Math.max(0, last - MAX_COMMENT); at -= 1) {
    if (view.getUint32(at, true) === END_SIGNATURE) return at;
  }
  throw damaged();
}

function unpack(bytes: Uint8Array, view: DataView, header: Header, limit: number): Uint8Array {
  const { local, packed, size } = header;
  if (size > limit) throw tooLarge(limit);
  if (local + LOCAL_SIZE > bytes.length || view.getUint32(local, true) !== LOCAL_SIGNATURE) throw damaged();
  const start = local + LOCAL_SIZE + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
  if (start + packed > bytes.length) throw damaged();
  const data = bytes.subarray(start, start + packed);
  let out: Uint8Array | null;
  if (header.method === STORED) out = data;
  // What the header claims is not believed: inflating stops as soon as there is more than that.
  else if (header.method === DEFLATED) out = inflateWithin(data, size);
  else throw new Error('The file is packed in a way that Posebeat does not know: pack it as a plain zip.');
  if (out?.length !== size || crc32(out) !== header.check) throw damaged();
  return out;
}

const tooLarge = (limit: number) =>
  new Error(`A part of the file is larger than ${Math.round(limit / 1e6)} MB: that is no Posebeat project.`);

let table: Uint32Array | null = null;

/** CRC-32 as zip uses it (ISO 3309, reflected polynomial 0xedb88320). */
export function crc32(bytes: Uint8Array): number {
  table ??= Uint32Array.from({ length: 256 }, (_, byte) => {
    let value = byte;
    for (let bit = 0; bit < 8; bit += 1) value = value & 1 ? (value >>> 1) ^ 0xedb88320 : value >>> 1;
    return value;
  });
  let sum = 0xffffffff;
  for (let i = 0; i < bytes.length; i += 1) sum = table[(sum ^ bytes[i]) & 0xff] ^ (sum >>> 8);
  return (sum ^ 0xffffffff) >>> 0;
}
