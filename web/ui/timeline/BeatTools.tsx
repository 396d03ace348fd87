import { useRef } from 'preact/hooks';
import { GRID_TEMPO } from '../../core/grid-edit';
import { MIN_TAPS } from '../../core/grid-tap';
import { Icon } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { BeatMenu, MENU_ID } from './BeatMenu';

/** Tools of the beat grid in the timeline's bar: tempo, tapping, and the rest in a menu. */
export function BeatTools() {
  const store = useStore();
  const button = useRef<HTMLButtonElement>(null);
  const off = !store.state.song.value?.complete;
  return (
    <div class="bar-group beat-tools" role="group" aria-label="Beats">
      <TempoField off={off} />
      <TapButton off={off} />
      <button
        type="button"
        class="bar-button"
        ref={button}
        disabled={off}
        popovertarget={MENU_ID}
        aria-haspopup="dialog"
        title="Change the beats: shift, halve, double, bars, trim"
      >
        Beats
        <Icon name="chevronDown" size={14} />
      </button>
      <BeatMenu opener={button} />
    </div>
  );
}

function TempoField({ off }: { off: boolean }) {
  const store = useStore();
  const tempo = store.state.grid.value?.tempo;
  const shown = tempo === undefined ? '' : String(Math.round(tempo * 10) / 10);
  return (
    <label class="tempo-field" title="Tempo: type another one for even beats; bar 1 stays">
      <input
        type="number"
        inputMode="decimal"
        step="any"
        min={GRID_TEMPO.min}
        max={GRID_TEMPO.max}
        disabled={off}
        aria-label="Tempo, beats per minute"
        value={shown}
        onChange={(event) => {
          const field = event.currentTarget;
          const typed = field.valueAsNumber;
          if (typed > 0 && field.value !== shown) store.setTempo(typed);
          const now = store.state.grid.value?.tempo;
          field.value = now === undefined ? '' : String(Math.round(now * 10) / 10);
        }}
        onKeyDown={(event) => {
          if (event.key === 'Enter') event.currentTarget.blur();
          if (event.key !== 'Escape') return;
          event.stopPropagation();
          event.currentTarget.value = shown;
          event.currentTarget.blur();
        }}
      />
      <abbr title="beats per minute">BPM</abbr>
    </label>
  );
}

function TapButton({ off }: { off: boolean }) {
  const store = useStore();
  const tapping = store.state.tapping.value;
  const count = tapping?.times.length ?? 0;
  const text = () => {
    if (!tapping) return 'Tap';
    if (count === 0) return 'On the beat';
    if (count < MIN_TAPS) return `${MIN_TAPS - count} more tap${MIN_TAPS - count === 1 ? '' : 's'}`;
    return tapping.tempo === null ? 'Keep tapping' : `${tapping.tempo.toFixed(1)} BPM`;
  };
  return (
    <button
      type="button"
      class={`bar-button tap ${tapping ? 'tapping' : ''}`}
      disabled={off}
      title={tip('tap')}
      // Pressed, not released: the press is the tap.
      onPointerDown={(event) => {
        if (event.button === 0) store.tapTempo(event.timeStamp);
      }}
      onClick={(event) => {
        if (event.detail === 0) store.tapTempo(event.timeStamp);
      }}
    >
      <span key={count} class={count > 0 ? 'tap-flash' : undefined} aria-hidden="true" />
      <span class="tap-text">{text()}</span>
    </button>
  );
}
