/**
 * Work without a network: a service worker keeps the page's own files, and asks before a newer page takes the place of an open one.
 * It begins once the page has opened, so that the first picture waits for nothing.
 */
import { effect } from '@preact/signals';
import { runtimeFiles } from '../workers/runtime-files';
import type { Store } from './store';

/** How often a page that stays open looks for a newer one, milliseconds. */
const LOOK_AGAIN = 3_600_000;

/** The parts of a browser that this needs. */
export interface OfflineBrowser {
  serviceWorker: ServiceWorkerContainer;
  /** Address that everything of the page is relative to. */
  base: string;
  /** Addresses of what the page has loaded so far. */
  loaded(): string[];
  reload(): void;
}

/** The browser at hand; null where it keeps no pages (an insecure address, a private window of some). */
export function offlineBrowser(page: Window): OfflineBrowser | null {
  const serviceWorker = page.navigator.serviceWorker as ServiceWorkerContainer | undefined;
  if (!serviceWorker || !page.isSecureContext) return null;
  return {
    serviceWorker,
    // Without the question and the link.
    base: new URL('.', page.document.baseURI).href,
    loaded: () => page.performance.getEntriesByType('resource').map(({ name }) => name),
    reload: () => page.location.reload(),
  };
}

/**
 * Starts keeping the page. Never rejects: without it everything works as long as there is a network.
 * @returns when the worker is registered, or could not be
 */
export async function keepOffline(store: Store, browser: OfflineBrowser): Promise<void> {
  const { serviceWorker, base } = browser;
  let asked = false;

  const offer = (waiting: ServiceWorker) => {
    store.offerUpdate(async () => {
      asked = true;
      waiting.postMessage({ type: 'SKIP_WAITING' });
    });
  };

  /** Files that were here before the worker was: it fetches them once more, which the browser's own cache answers. */
  const remember = (urls: string[]) => {
    const own = urls.filter((url) => url.startsWith(base) && !url.startsWith(new URL('models/', base).href));
    if (own.length > 0) serviceWorker.controller?.postMessage({ type: 'CACHE_URLS', payload: { urlsToCache: own } });
  };

  let controlled = serviceWorker.controller !== null;
  serviceWorker.addEventListener('controllerchange', () => {
    if (asked) browser.reload();
    // Another tab let a newer page in: what this one has not loaded yet is gone.
    else if (controlled) store.offerUpdate(() => Promise.resolve(browser.reload()));
    else remember(browser.loaded());
    controlled = true;
  });

  try {
    const registration = await serviceWorker.register(new URL('sw.js', base), { updateViaCache: 'none' });
    if (registration.waiting && controlled) offer(registration.waiting);
    registration.addEventListener('updatefound', () => {
      const { installing } = registration;
      installing?.addEventListener('statechange', () => {
        if (installing.state === 'installed' && controlled) offer(installing);
      });
    });
    setInterval(() => void registration.update().catch(() => undefined), LOOK_AGAIN);
  } catch {
    return; // refused by the browser, or a host that has no sw.js
  }

  // Workers may have loaded theirs before the page was controlled.
  effect(() => {
    const model = store.state.model.value;
    if (!model) return;
    void serviceWorker.ready
      .then(() => runtimeFiles(model.backend))
      .then((files) => remember(Object.values(files).map((file) => new URL(file, base).href)));
  });
}
