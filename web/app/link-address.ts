/** The page's own address, where it is a link to a dance. */
import { effect } from '@preact/signals';
import { isLink, isNewerLink } from '../core/formats/share-link';
import type { Store } from './store';

/**
 * Opens links that come while the page is open, and takes the link out of the address as soon as it is no longer what the page shows:
 * a reload then brings the visitor's own changes back. A link that only a newer page can read stays: reloading is what its message asks for.
 */
export function followAddress(store: Store, page: Window): void {
  const clear = () => {
    const { hash, pathname, search } = page.location;
    if (isLink(hash) && !isNewerLink(hash)) page.history.replaceState(page.history.state, '', pathname + search);
  };
  page.addEventListener('hashchange', () => {
    const { hash } = page.location;
    if (isLink(hash)) void store.openLink(hash).then((opened) => !opened && clear());
  });
  effect(() => {
    if (store.state.ready.value && !store.isGuest.value) clear();
  });
}
