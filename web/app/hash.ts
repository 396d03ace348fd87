/** Fingerprints of songs and dances. */
import { quantisedMotion } from '../core/formats/motion-quantised';
import type { Motion } from '../core/types';

/**
 * Identity of a song's bytes.
 *
 * @returns SHA-256 in hex; on a page without a secure context, where the browser hides SHA-256, a 64-bit FNV-1a with the length.
 */
export async function hashBytes(bytes: ArrayBuffer): Promise<string> {
  const subtle = globalThis.crypto?.subtle as SubtleCrypto | undefined;
  if (subtle) {
    const digest = new Uint8Array(await subtle.digest('SHA-256', bytes));
    return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
  }
  return fnv(bytes);
}

/**
 * Identity of a dance, for telling whether two pages made the same one: {@link hashBytes} of `quantisedMotion`. The same document, model
 * and number of WASM threads give the same one; other backends come near, which is not the same.
 */
export function motionHash(motion: Motion): Promise<string> {
  return hashBytes(quantisedMotion(motion).buffer);
}

/** True when `hash` is of these bytes, whichever of the two kinds it is. */
export async function isHashOf(hash: string, bytes: ArrayBuffer): Promise<boolean> {
  return hash === (hash.startsWith('fnv-') ? fnv(bytes) : await hashBytes(bytes));
}

/** FNV-1a from both ends, with the length. */
function fnv(bytes: ArrayBuffer): string {
  const view = new Uint8Array(bytes);
  let low = 0x811c9dc5;
  let high = 0xcbf29ce4;
  for (let i = 0; i < view.length; i += 1) {
    low = Math.imul(low ^ view[i], 0x01000193);
    high = Math.imul(high ^ view[view.length - 1 - i], 0x01000193);
  }
  const hex = (value: number) => (value >>> 0).toString(16).padStart(8, '0');
  return `fnv-${hex(high)}${hex(low)}-${view.length}`;
}
