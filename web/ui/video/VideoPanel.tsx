import type { VideoTab } from '../../app/actions/video';
import { Dialog } from '../Dialog';
import { Segments } from '../export/Segments';
import { KeysPanel } from '../picture/KeysPanel';
import { PicturePanel } from '../picture/PicturePanel';
import { useStore } from '../store-context';
import { NoVideo } from './NoVideo';
import { VideoForm } from './VideoForm';
import { VideoProgress } from './VideoProgress';

const TABS: readonly { value: VideoTab; label: string }[] = [
  { value: 'video', label: 'Video' },
  { value: 'picture', label: 'Picture' },
  { value: 'keys', label: 'Key poses' },
];
const TITLES: Readonly<Record<VideoTab, string>> = {
  video: 'Save as a video',
  picture: 'Save a picture',
  keys: 'Key poses as a picture',
};

/** The dance as a video with the song, or as a picture. */
export function VideoPanel() {
  const store = useStore();
  const open = store.state.videoOpen.value;
  const tab = store.state.videoTab.value;
  return (
    <>
      <Dialog
        open={open}
        onClose={() => store.toggleVideo(false)}
        title={TITLES[tab]}
        titleId="video-title"
        kind="export-panel video-panel"
        bodyClass="export-body"
        keepsKeys
      >
        {() => (
          <>
            <Segments
              legend="What is saved"
              name="video-tab"
              value={tab}
              options={TABS}
              onChange={(value) => store.toggleVideo(true, value)}
            />
            {tab === 'keys' ? <KeysPanel /> : <Contents tab={tab} />}
          </>
        )}
      </Dialog>
      {!open && <VideoProgress chip />}
    </>
  );
}

/** What needs a dance. */
function Contents({ tab }: { tab: 'video' | 'picture' }) {
  const dance = useStore().state.onStage.value;
  if (!dance || dance.kind === 'preview')
    return <NoVideo text="There is no dance yet: drop a song and press Generate." />;
  return tab === 'picture' ? <PicturePanel /> : <VideoForm />;
}
