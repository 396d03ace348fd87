import { useComputed } from '@preact/signals';
import { SPEED_RANGE } from '../audio/player';
import { barAndBeat, clockTime } from '../app/snapping';
import { GenerateButton } from './GenerateButton';
import { Icon } from './Icon';
import { tip } from './shortcuts';
import { useStore } from './store-context';
import { ToolButton } from './ToolButton';

const SPEEDS = [0.25, 0.5, 0.75, 1, 1.25, 1.5].filter((speed) => speed >= SPEED_RANGE.min && speed <= SPEED_RANGE.max);

/** Play, time, loop, speed, volume, zoom, Generate. */
export function Transport() {
  const store = useStore();
  const { playing, loop, speed, volume, muted, duration, curvesShown, followPlayhead } = store.state;
  const off = duration.value === 0;
  return (
    <section class="transport" aria-label="Transport">
      <ToolButton
        icon="skipBack"
        label="Previous key pose"
        title={tip('key-back')}
        disabled={off}
        class="tool wide"
        onClick={() => store.stepKey(-1)}
      />
      <button
        type="button"
        class="play"
        disabled={off}
        aria-label={playing.value ? 'Pause' : 'Play'}
        title={tip('play', playing.value ? 'Pause' : 'Play')}
        onClick={() => store.togglePlay()}
      >
        <Icon name={playing.value ? 'pause' : 'play'} size={24} />
      </button>
      <ToolButton
        icon="skipForward"
        label="Next key pose"
        title={tip('key-on')}
        disabled={off}
        class="tool wide"
        onClick={() => store.stepKey(1)}
      />
      <Readout />
      <ToolButton
        icon="repeat"
        label="Loop"
        title={tip('loop', 'Loop four bars, or drag in the ruler')}
        pressed={loop.value !== null}
        disabled={off}
        onClick={() => store.toggleLoop()}
      />
      <label class="speed wide" title="Speed">
        <span class="visually-hidden">Speed</span>
        <select value={String(speed.value)} onChange={(event) => store.setSpeed(Number(event.currentTarget.value))}>
          {SPEEDS.map((each) => (
            <option key={each} value={String(each)}>
              {each}×
            </option>
          ))}
        </select>
      </label>
      <ToolButton
        icon={muted.value ? 'volumeOff' : 'volume'}
        label={muted.value ? 'Sound on' : 'Mute'}
        pressed={muted.value}
        onClick={() => store.toggleMute()}
      />
      <input
        class="volume wide"
        type="range"
        min={0}
        max={1}
        step={0.01}
        value={muted.value ? 0 : volume.value}
        style={{ '--fill': `${Math.round((muted.value ? 0 : volume.value) * 100)}%` }}
        aria-label="Volume"
        onInput={(event) => store.setVolume(Number(event.currentTarget.value))}
      />
      <span class="spring" />
      <ToolButton
        icon="activity"
        label="Motion against music"
        title={tip('curves', 'Motion against music')}
        pressed={curvesShown.value}
        disabled={off}
        class="tool wide"
        onClick={() => store.toggleCurves()}
      />
      <ToolButton
        icon="locate"
        label="Follow the playhead"
        title={tip('follow', followPlayhead.value ? 'The timeline follows the playhead' : 'Follow the playhead')}
        pressed={followPlayhead.value}
        disabled={off}
        class="tool wide"
        onClick={() => store.toggleFollow()}
      />
      <div class="zoom-tools wide" role="group" aria-label="Zoom">
        <ToolButton icon="zoomOut" label="Zoom out" title={tip('zoom-out')} onClick={() => store.zoom(1 / 1.5)} />
        <ToolButton icon="maximize" label="Show the whole song" title={tip('fit')} onClick={() => store.fit()} />
        <ToolButton icon="zoomIn" label="Zoom in" title={tip('zoom-in')} onClick={() => store.zoom(1.5)} />
      </div>
      <GenerateButton />
    </section>
  );
}

function Readout() {
  const { time, duration, grid } = useStore().state;
  const shown = useComputed(() => clockTime(time.value));
  const place = useComputed(() => {
    const at = barAndBeat(grid.value, time.value);
    return at ? `${at.bar}.${at.beat}` : '–';
  });
  return (
    <div class="readout">
      <span class="readout-time">
        {shown}
        <small> / {clockTime(duration.value)}</small>
      </span>
      <span class="readout-bar" title="Bar and beat">
        {place}
      </span>
    </div>
  );
}
