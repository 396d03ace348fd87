import { useEffect, useRef } from 'preact/hooks';
import { effect, useSignal, type Signal } from '@preact/signals';
import { framePose, type MutableFramePose } from '../core/motion';
import type { Motion } from '../core/types';
import type { JointHover, Stage } from '../scene/stage';
import type { Store } from '../app/store';
import { rangeName } from '../app/range-name';
import { CompareBadge } from './CompareBadge';
import { Icon } from './Icon';
import { chooseFile } from './files';
import { onStageKey } from './pose/stage-keys';
import { ToolStrip } from './pose/ToolStrip';
import { PoseBar } from './PoseBar';
import { bindCamera } from './stage-camera';
import { tip } from './shortcuts';
import { motionAt } from './stage/motion-at';
import { bindOverlays } from './stage/overlays';
import { OverlayTools } from './stage/OverlayTools';
import { useStore } from './store-context';

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

function SoundChip() {
  const store = useStore();
  const { muted, playing } = store.state;
  if (!muted.value || !playing.value) return null;
  return (
    <button type="button" class="chip sound-chip" onClick={() => store.toggleMute()}>
      <Icon name="volumeOff" />
      Tap for sound
    </button>
  );
}

function CameraTools() {
  const store = useStore();
  const follows = store.state.cameraFollows.value;
  return (
    <div class="camera-tools" role="group" aria-label="Camera">
      <button
        type="button"
        class="tool"
        aria-pressed={follows}
        aria-label="Camera follows the dancer"
        title="Camera follows the dancer"
        onClick={() => store.toggleCamera()}
      >
        <Icon name="follow" />
      </button>
      <button
        type="button"
        class="tool"
        aria-label="Show the whole figure"
        title={tip('frame')}
        onClick={() => store.frameFigure()}
      >
        <Icon name="frame" />
      </button>
    </div>
  );
}

/** What is being worked on, with the way to stop it. */
function WorkChip() {
  const store = useStore();
  const { songJob, generation } = store.state;
  const job = songJob.value;
  const made = generation.value;
  if (job) {
    const text = { reading: 'Reading', decoding: 'Decoding', analysing: 'Finding the beats of' }[job.stage];
    return (
      <Work text={`${text} “${job.name}”`} fraction={job.fraction} tone="music" onCancel={() => store.cancelSong()} />
    );
  }
  if (made.status === 'idle') return null;
  if (made.status === 'loading') {
    const size = made.totalBytes > 0 && !made.cached ? ` (${(made.totalBytes / 1e6).toFixed(0)} MB, only once)` : '';
    return (
      <Work
        text={`Getting the dancer ready${size}`}
        fraction={made.fraction}
        tone="motion"
        onCancel={() => store.cancel()}
      />
    );
  }
  const what = made.range ? rangeName(store.state.grid.value, made.range) : 'the dance';
  return <Work text={`Making ${what}`} fraction={made.fraction} tone="motion" onCancel={() => store.cancel()} />;
}

function Work(props: { text: string; fraction: number; tone: 'music' | 'motion'; onCancel: () => void }) {
  const percent = Math.round(props.fraction * 100);
  return (
    <div class={`chip work-chip tone-${props.tone}`}>
      <span class="work-text">{props.text}</span>
      <span class="work-percent">{percent}%</span>
      <div
        class="bar"
        role="progressbar"
        aria-label={props.text}
        aria-valuemin={0}
        aria-valuemax={100}
        aria-valuenow={percent}
      >
        <div style={{ width: `${percent}%` }} />
      </div>
      <button type="button" class="quiet" onClick={props.onCancel}>
        Cancel
      </button>
    </div>
  );
}

/** Ties the stage to the store: the clock moves the figure, the editor's draft is on the gizmo. */
async function startStage(container: HTMLElement, store: Store, onOpen: (stage: Stage) => void): Promise<() => void> {
  const { state } = store;
  const pose: MutableFramePose = { root: new Float32Array(3), quaternions: new Float32Array(96) };
  let stage: Stage | null = null;
  let lastBeat = -1;
  let shownTime = -1;
  let shownMotion: Motion | null = null;

  const onFrame = () => {
    const time = store.tick();
    store.followTime(time);
    const motion = motionAt(state, time);
    // A dance that stands still is not drawn again: the graphics card may rest.
    if (stage && motion && (motion !== shownMotion || time !== shownTime)) {
      stage.show(framePose(motion, time, pose));
      shownMotion = motion;
      shownTime = time;
    }
    const beat = state.playing.value ? beatIndex(store, time) : -1;
    if (beat >= 0 && beat !== lastBeat) stage?.pulse(isDownbeat(store, beat) ? 0.9 : 0.45);
    lastBeat = beat;
  };

  try {
    const { createStage } = await import('../scene/stage');
    stage = createStage(container);
    await stage.ready;
  } catch (error) {
    store.notify('error', error instanceof Error ? error.message : 'The 3D stage could not start.');
  }
  if (!stage) return frameLoop(onFrame); // no picture, but the sound and the timeline go on

  const opened = stage;
  onOpen(opened);
  const undo: (() => void)[] = [opened.beforeFrame(onFrame)];
  let own: readonly number[] | null = null;
  undo.push(
    opened.onPoseChange((rotations, phase) => {
      own = rotations;
      store.changePose(rotations, phase);
    }),
    opened.onSelect((joint) => store.selectJoint(joint)),
    effect(() => {
      opened.follow = state.cameraFollows.value;
    }),
    bindCamera(opened, store),
    effect(() => {
      if (state.frameRequests.value > 0) opened.frameFigure();
    }),
    effect(() => {
      const draft = state.draft.value;
      opened.setMode(draft ? 'pose' : 'dance');
      if (!draft) {
        own = null;
        return;
      }
      // What the gizmo itself just did must not be loaded back under its drag.
      if (!own || !sameNumbers(own, draft.rotations)) {
        own = draft.rotations;
        opened.editPose(draft.rotations);
      }
      opened.selectJoint(draft.joint);
    }),
    effect(() => opened.setPoseTools(state.poseTools.value)),
    bindOverlays(opened, store),
  );
  return () => {
    for (const stop of undo) stop();
    opened.dispose();
  };
}

function beatIndex(store: Store, time: number): number {
  const beats = store.state.grid.value?.beats ?? [];
  let low = 0;
  let high = beats.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (beats[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

function isDownbeat(store: Store, beat: number): boolean {
  const grid = store.state.grid.value!;
  return grid.downbeats.includes(grid.beats[beat]);
}

function sameNumbers(a: readonly number[], b: readonly number[]): boolean {
  return a.length === b.length && a.every((value, i) => value === b[i]);
}

function frameLoop(callback: () => void): () => void {
  let request = requestAnimationFrame(function again() {
    request = requestAnimationFrame(again);
    callback();
  });
  return () => cancelAnimationFrame(request);
}
