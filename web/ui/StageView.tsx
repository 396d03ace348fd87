import { useEffect, useRef } from 'preact/hooks';
import { useSignal, type Signal } from '@preact/signals';
import type { JointHover, Stage } from '../scene/stage';
import { AvatarChip } from './avatar/AvatarChip';
import { CompareBadge } from './CompareBadge';
import { Icon } from './Icon';
import { chooseFile } from './files';
import { onStageKey } from './pose/stage-keys';
import { ToolStrip } from './pose/ToolStrip';
import { PoseBar } from './PoseBar';
import { WantedSong } from './share/WantedSong';
import { tip } from './shortcuts';
import { OverlayTools } from './stage/OverlayTools';
import { startStage } from './stage/start';
import { SoundChip, WorkChip } from './stage/StageChips';
import { useStore } from './store-context';
import { ToolButton } from './ToolButton';

/** The stage and what lies over it. */
export function StageView() {
  const store = useStore();
  const container = useRef<HTMLDivElement>(null);
  const stage = useRef<Stage | null>(null);
  const hover = useSignal<JointHover | null>(null);

  useEffect(() => {
    let stop: () => void = () => undefined;
    let gone = false;
    void startStage(container.current!, store, (opened) => {
      stage.current = opened;
      opened.onHover((joint) => (hover.value = joint));
    }).then((dispose) => {
      if (gone) dispose();
      else stop = dispose;
    });
    return () => {
      gone = true;
      stop();
    };
  }, [store, hover]);

  const { draft, song } = store.state;
  return (
    <main class={`stage ${draft.value ? 'posing' : ''}`} aria-label="Stage">
      <div
        class="stage-canvas"
        ref={container}
        {...(draft.value && {
          role: 'application',
          'aria-label': 'Figure',
          'aria-describedby': 'figure-keys',
          tabIndex: 0,
          onKeyDown: (event: KeyboardEvent) => {
            if (stage.current && onStageKey(event, stage.current, store)) event.preventDefault();
          },
        })}
      />
      {draft.value ? <Posing hover={hover} /> : (!song.value || song.value.demo) && <Welcome />}
      <SoundChip />
      <WorkChip />
      <AvatarChip />
      <CompareBadge />
      <div class="stage-tools">
        <OverlayTools />
        <CameraTools />
      </div>
    </main>
  );
}

/** What lies over the stage while a pose is edited. */
function Posing({ hover }: { hover: Signal<JointHover | null> }) {
  const over = hover.value;
  return (
    <>
      <PoseBar />
      <ToolStrip />
      <p id="figure-keys" class="visually-hidden">
        Arrow keys and Page Up and Down turn or move the chosen joint, further with Shift. With Control they go from
        joint to joint.
      </p>
      {over && (
        <span class="joint-tip" aria-hidden="true" style={{ left: `${over.x}px`, top: `${over.y}px` }}>
          {over.label}
        </span>
      )}
    </>
  );
}

/** One line of what this is, one target of what to do. */
function Welcome() {
  const store = useStore();
  if (store.state.wanted.value) return <WantedSong />;
  const busy = store.state.songJob.value !== null;
  return (
    <div class="welcome">
      <h1>
        Your song, your poses, <em>a dance.</em>
      </h1>
      <p>Drop a song, place a few poses on its beats, and a figure dances through them.</p>
      {!busy && (
        <button type="button" class="drop-target" onClick={() => chooseFile(store)}>
          <Icon name="music" size={28} />
          <span>
            <strong>Drop a song</strong>
            <small>or choose a file. It never leaves your device.</small>
          </span>
        </button>
      )}
    </div>
  );
}

function CameraTools() {
  const store = useStore();
  const follows = store.state.cameraFollows.value;
  return (
    <div class="camera-tools" role="group" aria-label="Camera">
      <ToolButton
        icon="follow"
        label="Camera follows the dancer"
        pressed={follows}
        onClick={() => store.toggleCamera()}
      />
      <ToolButton icon="frame" label="Show the whole figure" title={tip('frame')} onClick={() => store.frameFigure()} />
    </div>
  );
}
