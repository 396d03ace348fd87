import { useComputed, useSignalEffect } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { documentOnStage } from '../../app/on-stage';
import { tradeOffAt } from '../../core/report-curves';
import { REAL_DANCE } from '../../app/report-reference';
import { useStore } from '../store-context';
import { axesOf, place, PLOT, strengthNear } from './trade-off-shape';
import { errorText } from './verdicts';

/** Arrow keys move the strength by this much, with Shift or Page keys by ten times. */
const STEP = 0.01;

/** Consistency against smoothness of the dance on stage, over all key strengths; the dial's own place is marked and can be dragged. */
export function TradeOffPlot() {
  const store = useStore();
  const { state } = store;
  const picture = useRef<SVGSVGElement>(null);

  useSignalEffect(() => {
    void state.onStage.value?.uncorrected;
    void state.onStage.value?.inputs?.keyPoses;
    if (state.generation.value.status === 'idle') void store.plotTradeOff();
  });
  const hasKeys = useComputed(() => (state.onStage.value?.inputs?.keyPoses.length ?? 0) > 0);
  const shown = state.tradeOff.value;
  const tunable = state.onStage.value?.uncorrected !== undefined;
  if (!hasKeys.value || !tunable) {
    return (
      <p class="hint">
        {tunable
          ? 'With key poses on the timeline, this is where closeness to them is weighed against smoothness.'
          : 'Generate a dance of your own, and this dial moves it while you watch.'}
      </p>
    );
  }
  const points = shown?.points ?? [];
  if (points.length < 2) return <div class="trade-off waiting">Trying all key strengths …</div>;

  const strength = state.strengthDraft.value ?? documentOnStage(state).dials.keyStrength;
  const axes = axesOf(points);
  const now = tradeOffAt(points, strength)!;
  const at = place(now, axes);
  const [calm, wild] = REAL_DANCE.jerk;
  const [top, bottom] = [
    Math.max(PLOT.top, place({ error: 0, jerk: wild }, axes).y),
    Math.min(PLOT.height - PLOT.bottom, place({ error: 0, jerk: calm }, axes).y),
  ];
  const curve = points.map((point) => place(point, axes));

  const pick = (event: PointerEvent) => {
    const box = picture.current!.getBoundingClientRect();
    const scale = PLOT.width / box.width;
    return strengthNear(points, axes, (event.clientX - box.left) * scale, (event.clientY - box.top) * scale);
  };
  const onPointerDown = (event: PointerEvent) => {
    if (event.button !== 0) return;
    event.preventDefault();
    const svg = picture.current!;
    svg.querySelector<SVGElement>('[role=slider]')?.focus({ preventScroll: true });
    svg.setPointerCapture(event.pointerId);
    store.previewStrength(pick(event));
    const move = (next: PointerEvent) => store.previewStrength(pick(next));
    svg.addEventListener('pointermove', move);
    const end = (next: PointerEvent) => {
      svg.removeEventListener('pointermove', move);
      svg.removeEventListener('pointerup', end);
      svg.removeEventListener('pointercancel', end);
      store.commitStrength(
        next.type === 'pointerup' ? (state.strengthDraft.value ?? strength) : state.document.value.dials.keyStrength,
      );
    };
    svg.addEventListener('pointerup', end);
    svg.addEventListener('pointercancel', end);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const far = event.shiftKey ? 10 : 1;
    const targets: Record<string, number> = {
      ArrowRight: strength + STEP * far,
      ArrowUp: strength + STEP * far,
      ArrowLeft: strength - STEP * far,
      ArrowDown: strength - STEP * far,
      PageUp: strength + STEP * 10,
      PageDown: strength - STEP * 10,
      Home: 0,
      End: 1,
    };
    const target = targets[event.key];
    if (target === undefined) return;
    event.preventDefault();
    store.commitStrength(Math.min(1, Math.max(0, Math.round(target * 100) / 100)));
  };

  return (
    <figure class="trade-off">
      <svg ref={picture} viewBox={`0 0 ${PLOT.width} ${PLOT.height}`} onPointerDown={onPointerDown}>
        {bottom > top && (
          <g>
            <rect
              class="plot-band"
              x={PLOT.left}
              width={PLOT.width - PLOT.left - PLOT.right}
              y={top}
              height={bottom - top}
            />
            {bottom - top > 18 && (
              <text
                class="plot-text band"
                x={(PLOT.left + PLOT.width - PLOT.right) / 2}
                y={top + 14}
                text-anchor="middle"
              >
                as lively as real dance
              </text>
            )}
          </g>
        )}
        <path
          class="plot-axis"
          d={`M${PLOT.left} ${PLOT.top}V${PLOT.height - PLOT.bottom}H${PLOT.width - PLOT.right}`}
        />
        <path
          class={`trade-off-curve ${shown?.complete ? '' : 'growing'}`}
          d={curve.map(({ x, y }, i) => `${i ? 'L' : 'M'}${x} ${y}`).join('')}
        />
        {curve.map(({ x, y }, i) => (
          <circle key={i} class="trade-off-dot" cx={x} cy={y} r={2.5} />
        ))}
        <text class="plot-text" x={PLOT.left} y={PLOT.height - 4}>
          ← closer to your poses
        </text>
        <text class="plot-text" x={PLOT.width - PLOT.right} y={PLOT.height - 4} text-anchor="end">
          freer →
        </text>
        <text class="plot-text" x={PLOT.width - PLOT.right - 4} y={PLOT.top + 14} text-anchor="end">
          rougher ↑
        </text>
        <text class="plot-text" x={PLOT.width - PLOT.right - 4} y={PLOT.height - PLOT.bottom - 8} text-anchor="end">
          smoother ↓
        </text>
        <g
          role="slider"
          tabIndex={0}
          class="trade-off-handle"
          aria-label="Key strength on the plot"
          aria-valuemin={0}
          aria-valuemax={100}
          aria-valuenow={Math.round(strength * 100)}
          aria-valuetext={`${Math.round(strength * 100)}%: distance ${errorText(now.error)}, jerk ${now.jerk.toFixed(0)} metres per second cubed`}
          transform={`translate(${at.x} ${at.y})`}
          onKeyDown={onKeyDown}
        >
          <circle class="trade-off-grip" r={20} />
          <path class="trade-off-mark" d="M0-8L8 0L0 8L-8 0Z" />
        </g>
      </svg>
      <p class="trade-off-values" aria-hidden="true">
        <span>
          Off your poses <strong>{now.error < 1e-6 ? 'not at all' : errorText(now.error)}</strong>
        </span>
        <span>
          Jerk <strong>{now.jerk.toFixed(0)}</strong> m/s³
        </span>
      </p>
    </figure>
  );
}
