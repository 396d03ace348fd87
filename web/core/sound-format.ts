/** What a sound file says about itself in its first bytes: kind, sample rate, protection, and whether its end is missing. */

/** Kinds of files that browsers decode. */
export type SoundKind = 'wav' | 'mp3' | 'flac' | 'ogg' | 'm4a' | 'aac' | 'webm' | 'aiff';

/** Findings about a file. */
export interface SoundFormat {
  /** Null when this is no kind of sound file that we know. */
  kind: SoundKind | null;
  /** What it is instead, for the message: "a picture", "a MIDI file". */
  other?: string;
  /** Samples per second, where the header tells. */
  sampleRate?: number;
  /** Seconds, where the header tells. */
  duration?: number;
  /** Copy protection (DRM). */
  isProtected: boolean;
  /** The file ends before its header says so. */
  isTruncated: boolean;
}

/** A reader that gives zeros past the end, so that a file cut anywhere is no special case. */
class Bytes {
  constructor(readonly data: Uint8Array) {}
  get length(): number {
    return this.data.length;
  }
  tag(at: number, length = 4): string {
    return String.fromCharCode(...this.data.subarray(at, at + length));
  }
  u8(at: number): number {
    return this.data[at] ?? 0;
  }
  be16(at: number): number {
    return this.u8(at) * 256 + this.u8(at + 1);
  }
  be32(at: number): number {
    return this.be16(at) * 65536 + this.be16(at + 2);
  }
  le32(at: number): number {
    return this.u8(at) + this.u8(at + 1) * 256 + this.u8(at + 2) * 65536 + this.u8(at + 3) * 16777216;
  }
  find(text: string, from = 0, to = this.length): number {
    const first = text.charCodeAt(0);
    for (let at = this.data.indexOf(first, from); at >= 0 && at < to; at = this.data.indexOf(first, at + 1)) {
      if (this.tag(at, text.length) === text) return at;
    }
    return -1;
  }
}

/** Starts of files that people drop by mistake. */
const OTHERS: [start: string, name: string][] = [
  ['\x89PNG', 'a picture'],
  ['\xff\xd8\xff', 'a picture'],
  ['GIF8', 'a picture'],
  ['%PDF', 'a PDF document'],
  ['PK\x03\x04', 'a zip archive'],
  ['MThd', 'a MIDI file, which holds notes and no sound'],
  ['\x30\x26\xb2\x75', 'a Windows Media file, which browsers cannot decode'],
  ['#!AMR', 'an AMR voice recording, which browsers cannot decode'],
  ['<!DO', 'a web page'],
  ['<htm', 'a web page'],
];

const plain = (kind: SoundKind | null): SoundFormat => ({ kind, isProtected: false, isTruncated: false });

/** @param data the whole file */
export function sniffSound(data: Uint8Array): SoundFormat {
  const bytes = new Bytes(data);
  const start = bytes.tag(0);
  if (start === 'RIFF' && bytes.tag(8) === 'WAVE') return sniffWav(bytes);
  if (start === 'fLaC') return sniffFlac(bytes);
  if (start === 'OggS') return sniffOgg(bytes);
  if (bytes.tag(4) === 'ftyp') return sniffMp4(bytes);
  if (bytes.be32(0) === 0x1a45dfa3) return plain('webm');
  if (start === 'FORM' && bytes.tag(8, 3) === 'AIF') return plain('aiff');
  const other = OTHERS.find(([text]) => bytes.tag(0, text.length) === text);
  if (other) return { ...plain(null), other: other[1] };
  return sniffMpeg(bytes);
}

function sniffWav(bytes: Bytes): SoundFormat {
  const format = plain('wav');
  let byteRate = 0;
  for (let at = 12; at + 8 <= bytes.length;) {
    const size = bytes.le32(at + 4);
    if (bytes.tag(at) === 'fmt ') {
      format.sampleRate = bytes.le32(at + 12);
      byteRate = bytes.le32(at + 16);
    } else if (bytes.tag(at) === 'data') {
      // Recorders that were not stopped properly leave 0 or all ones: then the size says nothing.
      const isStated = size > 0 && size < 0xfffffff0;
      format.isTruncated = isStated && size > bytes.length - at - 8;
      if (byteRate > 0) format.duration = (isStated ? size : bytes.length - at - 8) / byteRate;
      return format;
    }
    at += 8 + size + (size & 1);
  }
  return { ...format, isTruncated: true };
}

function sniffFlac(bytes: Bytes): SoundFormat {
  const rate = Math.floor(bytes.be32(18) / 4096);
  const samples = (bytes.u8(21) & 15) * 2 ** 32 + bytes.be32(22);
  if (rate === 0) return { ...plain('flac'), isTruncated: true };
  return { ...plain('flac'), sampleRate: rate, duration: samples > 0 ? samples / rate : undefined };
}

function sniffOgg(bytes: Bytes): SoundFormat {
  const format = plain('ogg');
  const body = 27 + bytes.u8(26);
  if (bytes.tag(body + 1, 6) === 'vorbis') format.sampleRate = bytes.le32(body + 12);
  else if (bytes.tag(body, 8) === 'OpusHead') format.sampleRate = 48000;
  let at = 0;
  while (at < bytes.length) {
    if (bytes.tag(at) !== 'OggS') return format;
    const segments = bytes.u8(at + 26);
    let size = 27 + segments;
    for (let i = 0; i < segments; i++) size += bytes.u8(at + 27 + i);
    at += size;
  }
  // The last page reaches past the end of the file.
  format.isTruncated = at > bytes.length;
  return format;
}

function sniffMp4(bytes: Bytes): SoundFormat {
  const format = plain('m4a');
  const brand = bytes.tag(8);
  let movie = -1;
  for (let at = 0; at < bytes.length;) {
    const small = bytes.be32(at);
    const size =
      small === 1 ? bytes.be32(at + 8) * 2 ** 32 + bytes.be32(at + 12) : small === 0 ? bytes.length - at : small;
    if (size < 8 || at + size > bytes.length) {
      format.isTruncated = true;
      break;
    }
    if (bytes.tag(at + 4) === 'moov') {
      movie = at;
      const end = at + size;
      const entry = bytes.find('mp4a', at, end);
      if (entry > 0 && bytes.be16(entry + 28) >= 8000) format.sampleRate = bytes.be16(entry + 28);
      format.isProtected = ['drms', 'enca', 'drmi'].some((box) => bytes.find(box, at, end) > 0);
      if (bytes.find('soun', at, end) < 0) return { ...plain(null), other: 'a video without sound' };
    }
    at += size;
  }
  if (movie < 0) format.isTruncated = true;
  if (['M4P ', 'aax ', 'aaxc'].includes(brand)) format.isProtected = true;
  return format;
}

const MPEG_RATES = [44100, 48000, 32000];

/** MPEG audio layers and AAC in ADTS frames, with or without an ID3 tag before. */
function sniffMpeg(bytes: Bytes): SoundFormat {
  let at = 0;
  const isTagged = bytes.tag(0, 3) === 'ID3';
  if (isTagged) {
    // The tag's size has seven bits a byte.
    at = 10 + [6, 7, 8, 9].reduce((sum, i) => sum * 128 + (bytes.u8(i) & 127), 0);
    if (at >= bytes.length) return { ...plain('mp3'), isTruncated: true };
    while (at < bytes.length && bytes.u8(at) === 0) at++;
  }
  if (bytes.u8(at) !== 0xff || (bytes.u8(at + 1) & 0xe0) !== 0xe0) return plain(isTagged ? 'mp3' : null);
  const version = (bytes.u8(at + 1) >> 3) & 3;
  const layer = (bytes.u8(at + 1) >> 1) & 3;
  if (layer === 0) return (bytes.u8(at + 1) & 0xf0) === 0xf0 ? plain('aac') : plain(null);
  const rateIndex = (bytes.u8(at + 2) >> 2) & 3;
  const bitRate = bytes.u8(at + 2) >> 4;
  if (version === 1 || rateIndex === 3 || bitRate === 15) return plain(null);
  const format = plain('mp3');
  format.sampleRate = MPEG_RATES[rateIndex] / (version === 3 ? 1 : version === 2 ? 2 : 4);
  const info = Math.max(bytes.find('Xing', at, at + 200), bytes.find('Info', at, at + 200));
  if (info > 0) {
    const flags = bytes.be32(info + 4);
    const stated = (flags & 2) !== 0 ? bytes.be32(info + ((flags & 1) !== 0 ? 12 : 8)) : 0;
    // Tags at the end may be missing; sound may not.
    format.isTruncated = stated > 1.01 * (bytes.length - at) + 512;
    if ((flags & 1) !== 0) format.duration = (bytes.be32(info + 8) * (version === 3 ? 1152 : 576)) / format.sampleRate;
  }
  return format;
}
