import { useComputed } from '@preact/signals';
import type { Store } from '../app/store';
import { BonesDialog } from './avatar/BonesDialog';
import { CharacterQuestion } from './avatar/CharacterQuestion';
import { DropOverlay } from './DropOverlay';
import { ExportPanel } from './export/ExportPanel';
import { HelpOverlay } from './HelpOverlay';
import { Inspector } from './inspector/Inspector';
import { Notices } from './Notices';
import { StageView } from './StageView';
import { StoreContext } from './store-context';
import { ThumbnailsContext, type Thumbnails } from './thumbs';
import { Timeline } from './timeline/Timeline';
import { TopBar } from './TopBar';
import { Tour } from './tour/Tour';
import { VideoPanel } from './video/VideoPanel';
import { Transport } from './Transport';

/** The whole page: one stage, one timeline, one inspector. */
export function App({ store, thumbnails }: { store: Store; thumbnails: Thumbnails }) {
  const { draft, sheetOpen } = store.state;
  // Bound as a signal: the page itself is not drawn anew with every change of the edited pose.
  const kind = useComputed(() => `app ${draft.value ? 'posing' : ''} ${sheetOpen.value ? '' : 'sheet-closed'}`);
  return (
    <StoreContext.Provider value={store}>
      <ThumbnailsContext.Provider value={thumbnails}>
        <div class={kind}>
          <TopBar />
          <StageView />
          <Transport />
          <section class="timeline" aria-label="Timeline">
            <Timeline />
          </section>
          <Inspector />
          <Notices />
          <HelpOverlay />
          <ExportPanel />
          <VideoPanel />
          <BonesDialog />
          <CharacterQuestion />
          <Tour />
          <DropOverlay />
        </div>
      </ThumbnailsContext.Provider>
    </StoreContext.Provider>
  );
}
