/**
 * The page inside another one: `?embed=1` shows the figure and the transport only and keeps nothing of anybody's work.
 *
 * The surrounding page drives it by messages, under the same names as `window.posebeat`:
 *
 *     frame.contentWindow.postMessage({ posebeat: 1, id: 7, method: 'generate', arguments: [{ seed: 3 }] }, frameOrigin);
 *     // answer: { posebeat: 1, id: 7, result: {...} } or { posebeat: 1, id: 7, error: 'what is wrong and what to do' }
 *     // once, when it can be driven: { posebeat: 1, event: 'ready' }
 *
 * Files, blobs and arrays travel as they are (structured clone).
 *
 * Who is listened to: only the window that the frame is in. With `?embed=1&origin=https://example.org` only while that window is of this
 * origin, and nothing is sent to any other; without it any page that holds the frame may drive it, for there is nothing in it that is
 * not the page's own or a link's. Answers go to the origin that asked.
 */
import type { PosebeatApi } from './api';
import type { Storage } from './ports';

/** Of the message form; a later one has another number. */
const VERSION = 1;

/** How the page was asked to show itself. */
export interface EmbedWish {
  /** Figure and transport only. */
  embedded: boolean;
  /** The only origin that may drive it; null = the page around, whoever it is. */
  origin: string | null;
}

/**
 * Reads `?embed=1&origin=`.
 * @throws Error when the origin is none: better no frame than one that listens to everybody by mistake
 */
export function embedWish(search: string): EmbedWish {
  const asked = new URLSearchParams(search);
  const embedded = asked.get('embed') === '1';
  const origin = asked.get('origin');
  if (!embedded || origin === null) return { embedded, origin: null };
  let url: URL | null = null;
  try {
    url = new URL(origin);
  } catch {
    // said below
  }
  if (!url || url.origin === 'null' || url.origin !== origin.replace(/\/$/, '')) {
    throw new Error(
      `“${origin}” is no origin: give ?embed=1&origin= the scheme and host of the page around, like https://example.org.`,
    );
  }
  return { embedded, origin: url.origin };
}

/** The iframe to copy into another page. `link` is an address of this page, with or without a dance. */
export function embedSnippet(link: string): string {
  const url = new URL(link);
  url.search = '?embed=1';
  const escaped = url.href.replace(/&/g, '&amp;').replace(/"/g, '&quot;');
  return `<iframe src="${escaped}" width="480" height="640" style="border: 0; border-radius: 12px" allow="autoplay; cross-origin-isolated" title="A dance made with Posebeat"></iframe>`;
}

/** Keeps nothing: a frame in somebody's page must not touch what the visitor made elsewhere. */
export function noStorage(): Storage {
  return {
    saveDocument: () => Promise.resolve(),
    saveDance: () => Promise.resolve(),
    saveSong: () => Promise.resolve(),
    loadSong: () => Promise.resolve(null),
    load: () => Promise.resolve(null),
  };
}

/** What the answers go through. */
interface Around {
  postMessage(message: unknown, targetOrigin: string): void;
}

/** The window of the frame, as far as it is needed. */
export interface Frame {
  parent: Around;
  addEventListener(type: 'message', listener: (event: MessageEvent) => void): void;
}

/**
 * Lets the page around drive this one. Does nothing where there is none.
 * @param origin - The only one that is listened to; null = whichever the page around has.
 */
export function answerMessages(api: PosebeatApi, frame: Frame, origin: string | null): void {
  const { parent } = frame;
  if (parent === (frame as unknown)) return;
  const methods = Object.entries(api).flatMap(([name, member]) =>
    typeof member === 'function' ? [[name, member as (...list: unknown[]) => unknown] as const] : [],
  );
  const known = new Map(methods);

  async function answer(data: Record<string, unknown>): Promise<unknown> {
    const { method, arguments: list = [] } = data;
    if (data.posebeat !== VERSION) {
      throw new Error(
        `There is no message form ${String(data.posebeat)}: send {posebeat: ${VERSION}, id, method, arguments}.`,
      );
    }
    const run = typeof method === 'string' ? known.get(method) : undefined;
    if (!run) throw new Error(`There is no method “${String(method)}”: use one of ${[...known.keys()].join(', ')}.`);
    if (!Array.isArray(list)) throw new Error('The arguments must be a list.');
    await api.ready;
    return run(...(list as unknown[]));
  }

  frame.addEventListener('message', (event) => {
    if (event.source !== (parent as unknown) || (origin !== null && event.origin !== origin)) return;
    const data: unknown = event.data;
    if (typeof data !== 'object' || data === null || !('posebeat' in data) || !('method' in data)) return;
    const { id } = data as { id?: unknown };
    // A page from a file or a sandbox has the origin "null", which cannot be named.
    const to = event.origin === 'null' ? '*' : event.origin;
    const send = (part: { result: unknown } | { error: string }) =>
      parent.postMessage({ posebeat: VERSION, id, ...part }, to);
    answer(data as Record<string, unknown>)
      .then((result) => send({ result }))
      .catch((error: unknown) => send({ error: error instanceof Error ? error.message : String(error) }));
  });
  void api.ready.then(() => parent.postMessage({ posebeat: VERSION, event: 'ready' }, origin ?? '*'));
}
