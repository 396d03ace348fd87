import { useComputed } from '@preact/signals';
import { SPEED_RANGE } from '../audio/player';
import { barAndBeat, clockTime } from '../app/snapping';
import { GenerateButton } from './GenerateButton';
import { Icon } from './Icon';
import { tip } from './shortcuts';
import { useStore } from './store-context';

const SPEEDS = [0.25, 0.5, 0.75, 1, 1.25, 1.5].filter((speed) => speed >= SPEED_RANGE.min && speed <= SPEED_RANGE.max);

/** Play, time, loop, speed, volume, zoom, Generate. */
export function Transport() {
  const store = useStore();
  const { playing, loop, speed, volume, muted, duration, curvesShown, followPlayhead } = store.state;
  const off = duration.value === 0;
  return (
    <section class="transport" aria-label="Transport">
      <button
        type="button"
        class="tool wide"
        disabled={off}
        aria-label="Previous key pose"
        title={tip('key-back')}
        onClick={() => store.stepKey(-1)}
      >
        <Icon name="skipBack" />
      </button>
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
      <button
        type="button"
        class="tool wide"
        disabled={off}
        aria-label="Next key pose"
        title={tip('key-on')}
        onClick={() => store.stepKey(1)}
      >
        <Icon name="skipForward" />
      </button>
      <Readout />
      <button
        type="button"
        class="tool"
        disabled={off}
        aria-pressed={loop.value !== null}
        aria-label="Loop"
        title={tip('loop', 'Loop four bars, or drag in the ruler')}
        onClick={() => store.toggleLoop()}
      >
        <Icon name="repeat" />
      </button>
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
      <button
        type="button"
        class="tool"
        aria-pressed={muted.value}
        aria-label={muted.value ? 'Sound on' : 'Mute'}
        title={muted.value ? 'Sound on' : 'Mute'}
        onClick={() => store.toggleMute()}
      >
        <Icon name={muted.value ? 'volumeOff' : 'volume'} />
      </button>
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
      <button
        type="button"
        class="tool wide"
        disabled={off}
        aria-pressed={curvesShown.value}
        aria-label="Motion against music"
        title={tip('curves', 'Motion against music')}
        onClick={() => store.toggleCurves()}
      >
        <Icon name="activity" />
      </button>
      <button
        type="button"
        class="tool wide"
        disabled={off}
        aria-pressed={followPlayhead.value}
        aria-label="Follow the playhead"
        title={tip('follow', followPlayhead.value ? 'The timeline follows the playhead' : 'Follow the playhead')}
        onClick={() => store.toggleFollow()}
      >
        <Icon name="locate" />
      </button>
      <div class="zoom-tools wide" role="group" aria-label="Zoom">
        <button
          type="button"
          class="tool"
          aria-label="Zoom out"
          title={tip('zoom-out')}
          onClick={() => store.zoom(1 / 1.5)}
        >
          <Icon name="zoomOut" />
        </button>
        <button
          type="button"
          class="tool"
          aria-label="Show the whole song"
          title={tip('fit')}
          onClick={() => store.fit()}
        >
          <Icon name="maximize" />
        </button>
        <button type="button" class="tool" aria-label="Zoom in" title={tip('zoom-in')} onClick={() => store.zoom(1.5)}>
          <Icon name="zoomIn" />
        </button>
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
