import { useComputed, useSignal } from '@preact/signals';
import { useEffect, useId } from 'preact/hooks';
import { intervalInHand } from '../../app/actions/curves';
import { allTracks } from '../../core/curves';
import { findEdit, NO_EDITS, SHAPE_NAMES } from '../../core/curves-edit';
import { meanShape } from '../../core/curves-view';
import { Icon, type IconName } from '../Icon';
import { tip } from '../shortcuts';
import { useStore } from '../store-context';
import { AXES, hiddenAxes, shownCurves, trackLabel } from './curve-space';

/** A stretch is zoomed to this share of the timeline's width. */
const ZOOM_SHARE = 0.5;

/** What the three handles of a curve do, in plain words. */
const HANDLES = {
  tension: { label: 'Tension', low: 'loose', high: 'tight', hint: 'How sharply the curve turns at its knots.' },
  continuity: {
    label: 'Continuity',
    low: 'corner',
    high: 'overshoot',
    hint: 'Whether the curve runs on through its knots, or breaks.',
  },
  bias: {
    label: 'Bias',
    low: 'early',
    high: 'late',
    hint: 'Whether the curve leans to the way before a knot, or after it.',
  },
} as const;

/** Tools of the curve view: which joint, which curves, the shape of the stretch at the playhead. */
export function CurveTools() {
  const store = useStore();
  const { state } = store;
  const shown = shownCurves(store);
  const interval = useComputed(() => intervalInHand(state));
  const curves = shown.value;
  const track = state.curveTrack.value;
  const edits = state.document.value.curveEdits ?? NO_EDITS;
  const edited = curves !== null && findEdit(edits, curves.shown, interval.value, track) !== undefined;

  const tool = (icon: IconName, label: string, run: () => void, disabled = false, title = label) => (
    <button type="button" class="tool bar-tool" aria-label={label} title={title} disabled={disabled} onClick={run}>
      <Icon name={icon} size={18} />
    </button>
  );
  const zoom = () => {
    if (!curves) return;
    const [from, to] = [0, 1].map((n) => curves.shown.times[interval.value + n]);
    const width = state.viewWidth.value;
    const scale = (width * ZOOM_SHARE) / (to - from);
    store.setView((from + to) / 2 - width / scale / 2, scale);
  };
  return (
    <div class="curve-tools" role="toolbar" aria-label="Curve tools">
      <label class="curve-joint">
        <span class="visually-hidden">Joint of the curves</span>
        <select
          value={String(track)}
          onChange={(event) => {
            const { value } = event.currentTarget;
            store.showCurvesOf(value === 'root' ? 'root' : Number(value));
          }}
        >
          {allTracks().map((each) => (
            <option key={each} value={String(each)}>
              {trackLabel(each)}
            </option>
          ))}
        </select>
      </label>
      <div class="bar-group" role="group" aria-label="Curves shown">
        {AXES.map(({ name, colour }, axis) => (
          <button
            key={name}
            type="button"
            class={`tool bar-tool curve-axis axis-${name.toLowerCase()}`}
            style={{ '--knot': colour }}
            aria-pressed={!hiddenAxes.value.has(axis)}
            aria-label={`Curve ${name}`}
            title={track === 'root' ? WAYS[axis] : `Turn about the joint’s ${name} axis`}
            onClick={() => {
              const next = new Set(hiddenAxes.value);
              if (!next.delete(axis)) next.add(axis);
              hiddenAxes.value = next;
            }}
          >
            {name}
          </button>
        ))}
      </div>
      {curves && (
        <>
          <div class="bar-group" role="group" aria-label="Stretch between two key poses">
            {tool('chevronLeft', 'Previous stretch', () => store.stepCurveInterval(-1), interval.value <= 0)}
            {tool(
              'chevronRight',
              'Next stretch',
              () => store.stepCurveInterval(1),
              interval.value >= curves.shown.times.length - 2,
            )}
            {tool('maximize', 'Zoom to the stretch', zoom)}
            {tool(
              'reset',
              'Set the stretch back',
              () => store.resetCurve(track, interval.value),
              !edited,
              'Set this joint’s curve in this stretch back to what was generated',
            )}
          </div>
          {SHAPE_NAMES.map((name, which) => (
            <ShapeSlider
              key={name}
              name={name}
              value={meanShape(curves.shown, interval.value, track, which as 0 | 1 | 2)}
              interval={interval.value}
            />
          ))}
          <div class="bar-group" role="group" aria-label="Save the curves">
            <button
              type="button"
              class="quiet"
              title="The curves as documented JSON"
              onClick={() => store.saveCurves('json')}
            >
              Save JSON
            </button>
            <button
              type="button"
              class="quiet"
              title="The skeleton with editable curves, for Blender, Unity or Unreal"
              onClick={() => store.saveCurves('glb')}
            >
              Save GLB
            </button>
          </div>
        </>
      )}
      {tool(
        'close',
        'Hide the curves',
        () => store.toggleCurveView(false),
        false,
        tip('joint-curves', 'Hide the curves'),
      )}
    </div>
  );
}

const WAYS = ['To the left and right', 'Up and down', 'Forwards and back'];

/** One handle of the stretch at the playhead; a drag is one step of undo, Escape takes it back. */
function ShapeSlider(props: { name: keyof typeof HANDLES; value: number; interval: number }) {
  const { name, value, interval } = props;
  const store = useStore();
  const id = useId();
  const dragging = useSignal(false);
  const { label, low, high, hint } = HANDLES[name];
  const track = store.state.curveTrack.value;
  const percent = Math.round(value * 100);

  // A drag that the mouse ends elsewhere, or that never ends because the lane closes, must not stay open.
  useEffect(() => () => store.discardCurveDrag(), [store]);

  return (
    <div class="curve-handle" title={`${hint} −100 is ${low}, 100 is ${high}.`}>
      <label for={id}>{label}</label>
      <input
        id={id}
        type="range"
        min={-100}
        max={100}
        step={5}
        value={percent}
        style={{ '--fill': `${(percent + 100) / 2}%` }}
        aria-valuetext={`${percent}, between ${low} and ${high}`}
        onInput={(event) => {
          if (!dragging.value) {
            dragging.value = true;
            store.beginCurveDrag();
          }
          store.previewCurve(interval, track, { [name]: Number(event.currentTarget.value) / 100 });
        }}
        onChange={() => {
          if (!dragging.value) return;
          dragging.value = false;
          store.commitCurveDrag(`Set ${name}`);
        }}
        onKeyDown={(event) => {
          if (event.key !== 'Escape' || !dragging.value) return;
          event.preventDefault();
          event.stopPropagation();
          dragging.value = false;
          store.discardCurveDrag();
        }}
      />
      <output for={id}>{percent}</output>
    </div>
  );
}
