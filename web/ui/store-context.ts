import { createContext } from 'preact';
import { useContext } from 'preact/hooks';
import type { Store } from '../app/store';

/** The store, for every component. */
export const StoreContext = createContext<Store | null>(null);

/** The store of the page. */
export function useStore(): Store {
  const store = useContext(StoreContext);
  if (!store) throw new Error('useStore needs a StoreContext above it.');
  return store;
}
