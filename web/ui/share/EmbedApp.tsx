import type { Store } from '../../app/store';
import { Notices } from '../Notices';
import { StageView } from '../StageView';
import { StoreContext } from '../store-context';
import { Transport } from '../Transport';
import { WantedNotice } from './WantedSong';

/** The page inside another one: figure and transport, and the way to the whole page. */
export function EmbedApp({ store }: { store: Store }) {
  // What is danced now, or the bare page where that makes no link.
  const whole = () => {
    try {
      return store.shareLink(location.href);
    } catch {
      return location.origin + location.pathname;
    }
  };
  return (
    <StoreContext.Provider value={store}>
      <div class="app embed">
        <StageView />
        <a
          class="embed-brand"
          href="./"
          target="_blank"
          rel="noopener"
          onPointerDown={(event) => (event.currentTarget.href = whole())}
          onFocus={(event) => (event.currentTarget.href = whole())}
        >
          <svg viewBox="0 0 24 24" width="16" height="16" aria-hidden="true">
            <path d="M12 3l6 6-6 6-6-6z" fill="var(--key)" />
            <path d="M4 20h16" stroke="var(--music)" stroke-width="2.5" stroke-linecap="round" />
          </svg>
          Open in Posebeat
        </a>
        <Transport />
        <Notices />
        <WantedNotice />
      </div>
    </StoreContext.Provider>
  );
}
