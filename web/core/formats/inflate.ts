/** Unpacks deflated bytes that nobody vouches for. */
import { Inflate } from 'fflate';

/** Compressed bytes fed at a time: deflate makes at most 1032 times as much of them. */
const PIECE = 4096;

/**
 * Inflates raw deflate data (RFC 1951), stopping as soon as there is more than allowed.
 *
 * @param limit - Bytes that may come out at most.
 * @returns null when the data is damaged, cut off, or gives more.
 */
export function inflateWithin(data: Uint8Array, limit: number): Uint8Array | null {
  const parts: Uint8Array[] = [];
  let length = 0;
  let ended = false;
  const inflate = new Inflate((chunk, final) => {
    length += chunk.length;
    if (length > limit) throw new RangeError('Too much.');
    parts.push(chunk);
    ended ||= final;
  });
  try {
    for (let at = 0; at < data.length; at += PIECE) {
      inflate.push(data.subarray(at, at + PIECE), at + PIECE >= data.length);
    }
  } catch {
    return null;
  }
  if (!ended) return null;
  const out = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
