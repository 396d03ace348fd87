/** Pictures in the making: each goes on while its panel is closed, and can be stopped. */
import { signal, useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { PictureHooks } from '../../app/actions/stills';
import { messageOf } from '../../app/context';
import type { Store } from '../../app/store';
import { saveFile } from '../files';

/** What is being saved. */
export type Making = 'picture' | 'keys' | 'loop';

/** How far each is, 0..1; null when it is not being made. */
export const making = {
  picture: signal<number | null>(null),
  keys: signal<number | null>(null),
  loop: signal<number | null>(null),
};
const running = new Map<Making, AbortController>();

/** Makes a picture and offers it as a download; what is wrong becomes a notice. */
export async function savePicture(
  store: Store,
  what: Making,
  name: string,
  make: (hooks: PictureHooks) => Promise<Blob>,
): Promise<void> {
  running.get(what)?.abort();
  const own = new AbortController();
  running.set(what, own);
  making[what].value = 0;
  try {
    const blob = await make({
      signal: own.signal,
      onProgress: (done) => running.get(what) === own && (making[what].value = done),
    });
    saveFile(blob, name);
    store.notify('info', `${name} is saved.`);
  } catch (error) {
    if (!own.signal.aborted) store.notify('error', messageOf(error));
  } finally {
    if (running.get(what) === own) {
      running.delete(what);
      making[what].value = null;
    }
  }
}

/** Stops what is being made. */
export function cancelMaking(what: Making): void {
  running.get(what)?.abort(new DOMException('Cancelled.', 'AbortError'));
}

/** Somebody who turns options quickly waits for the last picture only, milliseconds. */
const REST = 250;

/** A small picture of what would be saved, made again when `key` changes: its address, what is wrong, or nothing yet. */
export function usePreview(key: string, make: (hooks: PictureHooks) => Promise<Blob>) {
  const shown = useSignal<{ url: string } | { problem: string } | null>(null);
  useEffect(() => {
    const own = new AbortController();
    const wait = setTimeout(() => {
      make({ signal: own.signal }).then(
        (blob) => {
          if (own.signal.aborted) return;
          drop(shown.peek());
          shown.value = { url: URL.createObjectURL(blob) };
        },
        (error: Error) => {
          if (!own.signal.aborted) shown.value = { problem: error.message };
        },
      );
    }, REST);
    return () => {
      clearTimeout(wait);
      own.abort(new DOMException('Another picture is wanted.', 'AbortError'));
    };
    // The key says all that the picture depends on.
  }, [key]);
  useEffect(() => () => drop(shown.peek()), [shown]);
  return shown.value;
}

function drop(shown: { url: string } | { problem: string } | null): void {
  if (shown && 'url' in shown) URL.revokeObjectURL(shown.url);
}
