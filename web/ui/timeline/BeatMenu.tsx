import type { ComponentChildren, RefObject } from 'preact';
import { useRef } from 'preact/hooks';
import { tip } from '../shortcuts';
import { leaveByEscape, closeMenu, placeMenu } from '../popover';
import { useStore } from '../store-context';

/** Id of the menu's element, for the button that opens it. */
export const MENU_ID = 'beat-menu';
/** What else can be done to the beats: a popover of the browser's own. */
export function BeatMenu({ opener }: { opener: RefObject<HTMLButtonElement | null> }) {
  const store = useStore();
  const { grid, document: project, ripple, metronome, loop } = store.state;
  const menu = useRef<HTMLDivElement>(null);
  const meter = grid.value?.beatsPerBar;

  return (
    <div
      id={MENU_ID}
      ref={menu}
      class="beat-menu"
      popover="auto"
      role="dialog"
      aria-label="Beats"
      onToggle={(event) => {
        if (event.newState !== 'open') return;
        placeMenu(menu.current!, opener.current!);
        menu.current?.querySelector<HTMLElement>('button:not(:disabled)')?.focus();
      }}
      // The taps first, then this menu.
      onKeyDown={(event) =>
        leaveByEscape(event, () =>
          store.state.tapping.value ? store.cancelTaps() : closeMenu(menu.current, opener.current),
        )
      }
    >
      <Row label="Tempo">
        <Do run={() => store.halveBeats()} title="Every second beat only">
          ÷ 2
        </Do>
        <Do run={() => store.doubleBeats()} title="A beat more between every two">
          × 2
        </Do>
      </Row>
      <Row label="Shift">
        <Do run={() => store.nudgeBeats(-1, 'frame')} title={tip('beats-frame-earlier')}>
          − frame
        </Do>
        <Do run={() => store.nudgeBeats(-1, 'fine')} title={tip('beats-earlier')}>
          −10 ms
        </Do>
        <Do run={() => store.nudgeBeats(1, 'fine')} title={tip('beats-later')}>
          +10 ms
        </Do>
        <Do run={() => store.nudgeBeats(1, 'frame')} title={tip('beats-frame-later')}>
          + frame
        </Do>
      </Row>
      <Row label="Bars">
        {([3, 4] as const).map((each) => (
          <Do key={each} pressed={meter === each} run={() => store.setMeter(each)} title={`${each} beats in a bar`}>
            {each}/4
          </Do>
        ))}
        <Do run={() => store.setBarOne()} title="A bar begins on the beat nearest to the playhead">
          Bar 1 at playhead
        </Do>
      </Row>
      <Row label="Beat">
        <Do run={() => store.insertBeat()} title="A beat that was missed, at the playhead">
          Add at playhead
        </Do>
      </Row>
      <Row label="Dance to">
        <Do
          run={() => store.trimToLoop()}
          disabled={loop.value === null}
          title={loop.value ? 'Only the looped stretch of the song' : 'Drag in the ruler first, to loop a stretch'}
        >
          Looped part
        </Do>
        <Do run={() => store.setTrim(null)} disabled={project.value.trim === null} title="All of the song">
          Whole song
        </Do>
      </Row>
      <label class="beat-check">
        <input type="checkbox" checked={ripple.value} onChange={() => store.toggleRipple()} />
        Key poses go along with their beats
      </label>
      <label class="beat-check" title={tip('metronome')}>
        <input type="checkbox" checked={metronome.value} onChange={() => store.toggleMetronome()} />
        Click on every beat <kbd>K</kbd>
      </label>
      <button
        type="button"
        class="secondary full"
        disabled={project.value.grid === null}
        title="Takes all changes of the beats back"
        onClick={() => store.resetBeats()}
      >
        Beats as analysed
      </button>
    </div>
  );
}

function Row({ label, children }: { label: string; children: ComponentChildren }) {
  return (
    <div class="beat-row" role="group" aria-label={label}>
      <span aria-hidden="true">{label}</span>
      {children}
    </div>
  );
}

interface DoProps {
  run: () => void;
  title: string;
  pressed?: boolean;
  disabled?: boolean;
  children: ComponentChildren;
}

function Do({ run, title, pressed, disabled, children }: DoProps) {
  return (
    <button
      type="button"
      class="bar-button framed"
      title={title}
      aria-pressed={pressed}
      disabled={disabled}
      onClick={run}
    >
      {children}
    </button>
  );
}
