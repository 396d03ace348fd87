import type { TargetedKeyboardEvent } from 'preact';
import { jointLabel } from '../../scene/pose-edit';
import { Icon, type IconName } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';

/** How the editor works on the figure: a slim strip at the stage's edge. */
export function ToolStrip() {
  const store = useStore();
  const { mode, space, limits, mirror, pins, balance } = store.state.poseTools.value;
  const joint = store.state.draft.value?.joint ?? null;
  const pinned = joint !== null && pins.has(joint);
  return (
    <div class="tool-strip" role="toolbar" aria-label="Posing tools" aria-orientation="vertical" onKeyDown={onKeyDown}>
      <div class="tool-strip-group" role="group" aria-label="What dragging does">
        <Tool
          icon="rotate3d"
          label="Turn joints"
          title={tip('pose-rotate')}
          on={mode === 'rotate'}
          onPress={() => store.setPoseMode('rotate')}
        />
        <Tool
          icon="move3d"
          label="Move joints"
          title={tip('pose-move')}
          on={mode === 'move'}
          onPress={() => store.setPoseMode('move')}
        />
      </div>
      <Tool
        icon="globe"
        label="World axes"
        title={tip('pose-space', space === 'world' ? 'World axes; press for the joint’s own' : 'World axes')}
        on={space === 'world'}
        onPress={() => store.toggleSpace()}
      />
      <Tool
        icon="bone"
        label="Limits of the joints"
        title={tip('pose-limits', 'Joints stay within what a body can do')}
        on={limits}
        onPress={() => store.toggleLimits()}
      />
      <Tool
        icon="bothSides"
        label="Both sides"
        title={tip('pose-mirror')}
        on={mirror}
        onPress={() => store.toggleMirrorEdit()}
      />
      <Tool
        icon="pushpin"
        label={joint === null ? 'Pin' : `Pin ${jointLabel(joint).toLowerCase()}`}
        title={tip('pose-pin')}
        on={pinned}
        disabled={joint === null}
        badge={pins.size}
        onPress={() => store.togglePin()}
      />
      <Tool
        icon="balance"
        label="Balance"
        title={tip('pose-balance')}
        on={balance}
        onPress={() => store.toggleBalance()}
      />
    </div>
  );
}

function Tool(props: {
  icon: IconName;
  label: string;
  title: string;
  on: boolean;
  disabled?: boolean;
  badge?: number;
  onPress: () => void;
}) {
  return (
    <button
      type="button"
      class="strip-tool"
      aria-pressed={props.on}
      aria-label={props.label}
      title={props.title}
      // Not `disabled`: the arrow keys must not lose their place when a joint is let go.
      aria-disabled={props.disabled ? 'true' : undefined}
      onClick={() => props.onPress()}
    >
      <Icon name={props.icon} size={22} />
      {props.badge ? <span class="strip-badge">{props.badge}</span> : null}
    </button>
  );
}

/** Arrow keys go along the strip. */
function onKeyDown(event: TargetedKeyboardEvent<HTMLDivElement>): void {
  const steps: Record<string, number> = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 };
  const step = steps[event.key];
  if (!step) return;
  const tools = [...event.currentTarget.querySelectorAll<HTMLElement>('button')];
  const now = tools.indexOf(document.activeElement as HTMLElement);
  tools[(now + step + tools.length) % tools.length]?.focus();
  event.preventDefault();
}
