/** RIFF/WAVE files: PCM of 8, 16, 24, 32 bits and 32/64-bit float. */

/** Decoded sound. */
export interface Pcm {
  sampleRate: number;
  /** One array per channel, samples in -1..1. */
  channels: Float32Array[];
}

const FORMAT_PCM = 1;
const FORMAT_FLOAT = 3;
const FORMAT_EXTENSIBLE = 0xfffe;

/**
 * @param bytes a whole wav file; a data chunk cut short gives the samples that are there
 * @throws Error when the bytes are no wav file, or one of an unknown sample format
 */
export function decodeWav(bytes: Uint8Array): Pcm {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const tag = (at: number): string => String.fromCharCode(...bytes.subarray(at, at + 4));
  if (bytes.length < 12 || tag(0) !== 'RIFF' || tag(8) !== 'WAVE') throw new Error('Not a wav file.');
  let format = 0;
  let channelCount = 0;
  let sampleRate = 0;
  let bits = 0;
  for (let at = 12; at + 8 <= bytes.length;) {
    const size = view.getUint32(at + 4, true);
    const body = at + 8;
    if (tag(at) === 'fmt ' && body + 16 <= bytes.length) {
      format = view.getUint16(body, true);
      channelCount = view.getUint16(body + 2, true);
      sampleRate = view.getUint32(body + 4, true);
      bits = view.getUint16(body + 14, true);
      if (format === FORMAT_EXTENSIBLE && body + 26 <= bytes.length) format = view.getUint16(body + 24, true);
    } else if (tag(at) === 'data') {
      const read = sampleReader(view, format, bits);
      if (!read || channelCount === 0 || sampleRate === 0) {
        throw new Error(`Wav sample format ${format} with ${bits} bits is not supported.`);
      }
      const width = bits / 8;
      const available = Math.min(size, bytes.length - body);
      const frames = Math.floor(available / (width * channelCount));
      const channels = Array.from({ length: channelCount }, (_, c) =>
        Float32Array.from({ length: frames }, (_, i) => read(body + (i * channelCount + c) * width)),
      );
      return { sampleRate, channels };
    }
    at = body + size + (size & 1);
  }
  throw new Error('The wav file has no sound data.');
}

function sampleReader(view: DataView, format: number, bits: number): ((at: number) => number) | null {
  if (format === FORMAT_PCM) {
    if (bits === 8) return (at) => (view.getUint8(at) - 128) / 128;
    if (bits === 16) return (at) => view.getInt16(at, true) / 32768;
    if (bits === 24) return (at) => (view.getInt16(at + 1, true) * 256 + view.getUint8(at)) / 8388608;
    if (bits === 32) return (at) => view.getInt32(at, true) / 2147483648;
  }
  if (format === FORMAT_FLOAT) {
    if (bits === 32) return (at) => view.getFloat32(at, true);
    if (bits === 64) return (at) => view.getFloat64(at, true);
  }
  return null;
}

/**
 * @param channels samples of each channel, equally long
 * @returns the mean of the channels; the channel itself where there is one only
 */
export function mixToMono(channels: readonly Float32Array[]): Float32Array {
  if (channels.length === 1) return channels[0];
  const mono = new Float32Array(channels[0]?.length ?? 0);
  for (const channel of channels) for (let i = 0; i < mono.length; i++) mono[i] += channel[i] / channels.length;
  return mono;
}
